#include "reports/command/live/live_page.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "models/reader/document/text_file.hpp"
#include "models/reader/document/yaml.hpp"
#include "models/reader/parsed_scene.hpp"
#include "reports/files/files.hpp"
#include "reports/live/engine.hpp"
#include "reports/text/escape.hpp"

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

// Adds the tables that a valid scene refers to by a key `file`, by their names there.
void add_files(const reader::Value& value, const fs::path& folder, nlohmann::ordered_json& files) {
    for (std::size_t k = 0; k < value.items.size(); ++k) {
        const reader::Value& item = value.items[k];
        if (k < value.keys.size() && value.keys[k] == "file" &&
            item.kind == reader::Value::Kind::scalar)
            files[item.text] = reader::read_text(folder / item.text, reader::Pipes::refused).text;
        add_files(item, folder, files);
    }
}

// Compressed (RFC 1950), in base64 (RFC 4648).
std::string packed(const std::string& text) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uLongf size = compressBound(text.size());
    std::vector<Bytef> bytes(size);
    compress2(bytes.data(), &size, reinterpret_cast<const Bytef*>(text.data()), text.size(), 9);
    bytes.resize(size);
    std::string coded;
    for (std::size_t k = 0; k < size; k += 3) {
        unsigned block = 0;
        for (std::size_t i = k; i < k + 3; ++i) block = block << 8 | (i < size ? bytes[i] : 0u);
        for (std::size_t i = 0; i < 4; ++i)
            coded += k + i <= size ? digits[block >> (18 - 6 * i) & 63] : '=';
    }
    return coded;
}

// Answers of the page's solver to the opened scene and its first branch, packed, so that the page has a
// picture before its solver has started: all numbers at the start of the branch, and at the other points
// those that are drawn; the rest is NaN. Null where there is no branch or no solution.
nlohmann::ordered_json first_answer(const std::string& text, const std::string& name,
                                    const fs::path& folder) {
    live::Session session;
    const nlohmann::ordered_json open = live::open(session, text, name, folder);
    if (open["branches"].empty()) return nullptr;
    live::Request request;
    request.only = open["branches"][0]["name"];
    live::Answer answer = live::solve(session, request);
    if (answer.head.contains("trouble")) return nullptr;
    const auto& branch = answer.head["branches"][0];
    const auto& usual = open["branches"][0]["usual"];
    const std::size_t points = branch["points"], start = branch["start"];
    const std::size_t columns = points == 0 ? 0 : answer.numbers.size() / points;
    for (std::size_t c = 1; c < columns; ++c) {
        if (c <= open["channels"].size()) {
            const auto& channel = open["channels"][c - 1];
            if (channel["main"] == true || std::ranges::count(usual, channel["figure"]) > 0 ||
                channel["name"].get<std::string>().find("stop.") != std::string::npos)
                continue;
        }
        for (std::size_t k = 0; k < points; ++k)
            if (k != start) answer.numbers[k * columns + c] = NAN;
    }
    const nlohmann::ordered_json first = {
        {"open", open}, {"head", answer.head}, {"numbers", answer.numbers}};
    return packed(first.dump());
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
    (void)reader::ParsedScene(text, scene, folder)
        .read({});  // throws for a scene that is not valid
    const std::string name = fs::path(scene).filename().string();
    nlohmann::ordered_json data = {{"name", name},
                                   {"text", text},
                                   {"first", first_answer(text, name, folder)}},
                           files = nlohmann::ordered_json::object();
    add_files(reader::parse_yaml(text, scene), folder, files);
    if (!files.empty()) data["files"] = std::move(files);
    page.replace(place, scene_goes_here.size(), for_script(data.dump(-1, ' ', true)));
    return page;
}

}  // namespace elastocheck::reports
