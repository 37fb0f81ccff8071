#include "reports/command/live/live_page.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "elastocheck/read_scene.hpp"
#include "models/reader/document/text_file.hpp"
#include "models/reader/document/yaml.hpp"
#include "models/reader/parsed_scene.hpp"
#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view scene_goes_here = "@SCENE@";
constexpr std::size_t largest_page = 16u << 20;

// The page without a scene, that `./dev live` builds: PREFIX/share/elastocheck/live.html of an installed program, or
// build/live/live.html for a program in its build tree. Throws std::invalid_argument where it is not built.
std::string built_page() {
    if (const auto file = beside_program({"share/elastocheck/live.html", "live/live.html"});
        !file.empty())
        return read_whole(file, largest_page);
    throw std::invalid_argument(
        "live: this program was built without the component 'live' (WebAssembly); ./dev live in "
        "the source tree builds it");
}

// As JSON within a script element, which ends at the first "</script" and knows comments "<!--".
std::string in_markup(const nlohmann::ordered_json& value) {
    std::string text = value.dump(-1, ' ', true);
    for (std::size_t at = 0; (at = text.find('<', at)) != text.npos;)
        text.replace(at, 1, "\\u003c");
    return text;
}

// The tables that a valid scene refers to, by their names in it: what stands at a key `file`.
void add_files(const reader::Value& value, const fs::path& folder, nlohmann::ordered_json& files) {
    for (std::size_t k = 0; k < value.items.size(); ++k) {
        const reader::Value& item = value.items[k];
        if (k < value.keys.size() && value.keys[k] == "file" &&
            item.kind == reader::Value::Kind::scalar)
            files[item.text] = reader::read_text(folder / item.text, reader::Pipes::refused).text;
        add_files(item, folder, files);
    }
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
    const fs::path folder = fs::path(scene).parent_path();
    (void)reader::ParsedScene(text, scene, folder).read({});
    nlohmann::ordered_json data = {{"name", fs::path(scene).filename().string()}, {"text", text}},
                           files = nlohmann::ordered_json::object();
    add_files(reader::parse_yaml(text, scene), folder, files);
    if (!files.empty()) data["files"] = std::move(files);
    page.replace(place, scene_goes_here.size(), in_markup(data));
    return page;
}

}  // namespace elastocheck::reports
