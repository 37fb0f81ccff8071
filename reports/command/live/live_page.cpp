#include "reports/command/live/live_page.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "elastocheck/read_scene.hpp"
#include "models/reader/document/text_file.hpp"
#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view scene_goes_here = "@SCENE@";
constexpr std::size_t largest_page = 16u << 20;

// The page without a scene, that `./dev live` builds: PREFIX/share/elastocheck/live.html of an installed program, or
// build/live/live.html for a program in its build tree. Throws std::invalid_argument where it is not built.
std::string built_page() {
    std::error_code failed;
    for (fs::path file = fs::read_symlink("/proc/self/exe", failed), folder = file.parent_path();
         !failed && folder != file; file = folder, folder = folder.parent_path())
        for (const char* place : {"share/elastocheck/live.html", "live/live.html"})
            if (std::error_code unseen; fs::is_regular_file(folder / place, unseen))
                return read_whole(folder / place, largest_page);
    throw std::invalid_argument(
        "live: this program was built without the component 'live' (WebAssembly); ./dev live in "
        "the "
        "source tree builds it");
}

// As JSON within a script element, which ends at the first "</script" and knows comments "<!--".
std::string in_markup(const nlohmann::ordered_json& value) {
    std::string text = value.dump(-1, ' ', true);
    for (std::size_t at = 0; (at = text.find('<', at)) != text.npos;)
        text.replace(at, 1, "\\u003c");
    return text;
}

}  // namespace

std::string live_page(const std::string& scene, const Settings& settings) {
    std::string page = built_page();
    const std::size_t place = page.find(scene_goes_here);
    if (place == page.npos || page.find(scene_goes_here, place + 1) != page.npos)
        throw std::logic_error("the built page has no single place for a scene");
    const reader::TextFile read = reader::read_text(scene, reader::Pipes::allowed);
    if (!read.trouble.empty()) throw SceneError(fmt::format("{}: {}", scene, read.trouble));
    const std::string text =
        settings.empty() ? read.text : rewrite_scene(read.text, scene, settings);
    // The page has no folder of files that a scene may refer to.
    parse_scene(text, scene);
    page.replace(place, scene_goes_here.size(),
                 in_markup({{"name", fs::path(scene).filename().string()}, {"text", text}}));
    return page;
}

}  // namespace elastocheck::reports
