#include "reports/command/grammar/documentation.hpp"

#include <filesystem>

namespace elastocheck::reports {

std::string documentation(const std::string& name) {
    namespace fs = std::filesystem;
    std::error_code failed;
    for (fs::path file = fs::read_symlink("/proc/self/exe", failed), folder = file.parent_path();
         !failed && folder != file; file = folder, folder = folder.parent_path())
        for (const fs::path& place : {folder / "share/doc/elastocheck" / name, folder / name})
            if (std::error_code unseen; fs::is_regular_file(place, unseen)) return place.string();
    return name;
}

}  // namespace elastocheck::reports
