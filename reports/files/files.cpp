#include "reports/files/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace elastocheck::reports {

void write_whole(const std::filesystem::path& file, std::string_view content) {
    std::error_code failed;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), failed);
    if (failed)
        throw FileError(fmt::format("{}: cannot make its folder: {}", file.string(), failed.message()));

    const std::string temporary = fmt::format("{}.{}.tmp", file.string(), ::getpid());
    const int out = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (out < 0)
        throw FileError(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
    bool good = true;
    for (std::string_view rest = content; good && !rest.empty();) {
        const ssize_t written = ::write(out, rest.data(), rest.size());
        good = written > 0;
        if (good) rest.remove_prefix(static_cast<std::size_t>(written));
    }
    good = good && ::fsync(out) == 0;
    int error = errno;
    good = ::close(out) == 0 && good;
    if (good && ::rename(temporary.c_str(), file.c_str()) == 0) return;
    if (good) error = errno;
    ::unlink(temporary.c_str());
    throw FileError(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(error)));
}

std::string read_whole(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    if (in) text << in.rdbuf();
    if (!in || in.bad() || std::filesystem::is_directory(file))
        throw FileError(fmt::format("{}: cannot be read", file.string()));
    return text.str();
}

}  // namespace elastocheck::reports
