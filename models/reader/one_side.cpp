#include "models/reader/one_side.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "models/kinds.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/settings.hpp"

namespace elastocheck {
namespace reader {
namespace {

constexpr std::array<std::string_view, 14> mirrored_sections{
    "points", "bodies", "joints",       "springs", "stops",  "torsion_springs", "bushings",
    "beams",  "tyres",  "static_loads", "loads",   "wheels", "probes",          "dampers"};

// The path before "@", and the side behind it; empty for a number of both sides.
std::pair<std::string, std::string> path_and_side(std::string_view path) {
    const auto at = path.rfind('@');
    if (at == path.npos) return {std::string(path), ""};
    return {std::string(path.substr(0, at)), std::string(path.substr(at + 1))};
}

std::optional<Mirror> mirror_of(const Value& tree, const std::string& file) {
    const Value* mirror = entry(tree, "mirror");
    std::vector<Number> ignored;
    if (mirror == nullptr) return std::nullopt;
    return read_mirror({mirror, "mirror", &file, &ignored}, {&tree, "", &file, &ignored});
}

// Applies a setting of one side alone to the tree of that side.
void apply_to_side(const Setting& setting, const std::optional<Mirror>& mirror,
                   const std::string& file, Trees& trees, std::vector<Value*>* places) {
    const auto [path, side] = path_and_side(setting.path);
    if (!mirror)
        fail(file, 0, setting.path, "the scene has no mirror; allowed: the path without '@'");
    if (side != mirror->from && side != mirror->to)
        fail(file, 0, setting.path,
             fmt::format("{} is not a side; allowed: {}, {}", quote(side), mirror->from,
                         mirror->to));
    if (!mirror_of_number(&*mirror, path))
        fail(file, 0, setting.path,
             fmt::format("both sides share it, since no name in it has the word {}; allowed: {}",
                         quote(mirror->from), path));
    Value& tree = side == mirror->from ? trees.written : trees.twins.front();
    Value& value = apply({path, setting.value}, tree, file, Repeated::allowed);
    if (places != nullptr) places->push_back(&value);
}

template <class T>
void replace_twins(const Mirror& mirror, const std::vector<T>& from, std::vector<T>& to) {
    if (from.size() != to.size())
        throw SceneError(
            "a number of one side alone decides which parts the scene has; allowed: of "
            "both sides");
    for (std::size_t k = 0; k < to.size(); ++k)
        if (is_twin(mirror, to[k].name)) to[k] = from[k];
}

}  // namespace

const Mirror* mirror_of_number(const Mirror* mirror, const std::string& path) {
    const bool mirrored = mirror != nullptr &&
                          std::ranges::find(mirrored_sections, path.substr(0, path.find('.'))) !=
                              mirrored_sections.end() &&
                          mirrored_name(*mirror, path);
    return mirrored ? mirror : nullptr;
}

Trees with_settings(const Value& tree, std::span<const Setting> settings, const std::string& file,
                    std::vector<std::vector<Value*>>* places) {
    Trees trees{.written = tree};
    std::vector<Setting> in_file;  // the section one_side
    if (const Value* section = entry(tree, "one_side"))
        for (std::size_t k = 0; k < section->keys.size(); ++k) {
            in_file.push_back({section->keys[k], section->items[k].text});
            if (section->keys[k].find('@') == std::string::npos)
                fail(file, section->items[k].line, "one_side",
                     quote(section->keys[k]) + " has no side; allowed: PATH@SIDE: VALUE");
        }
    const auto is_of_one_side = [](const Setting& setting) {
        return setting.path.find('@') != std::string::npos;
    };
    if (!in_file.empty() || std::ranges::any_of(settings, is_of_one_side)) trees.twins = {tree};
    const std::optional<Mirror> mirror = trees.twins.empty() ? std::nullopt : mirror_of(tree, file);
    std::vector<std::vector<Value*>> replaced(settings.size());
    for (std::size_t k = 0; k < settings.size(); ++k) {  // first those of both sides
        if (is_of_one_side(settings[k])) continue;
        replaced[k].push_back(&apply(settings[k], trees.written, file));
        for (Value& twins : trees.twins) replaced[k].push_back(&apply(settings[k], twins, file));
    }
    for (const Setting& setting : in_file) apply_to_side(setting, mirror, file, trees, nullptr);
    for (std::size_t k = 0; k < settings.size(); ++k)
        if (is_of_one_side(settings[k]))
            apply_to_side(settings[k], mirror, file, trees, &replaced[k]);
    if (places != nullptr) *places = std::move(replaced);
    return trees;
}

void take_twins(const Mirror& mirror, const Scene& from, Scene& to) {
    replace_twins(mirror, from.joints, to.joints);
    replace_twins(mirror, from.elastics, to.elastics);
    replace_twins(mirror, from.static_loads, to.static_loads);
    replace_twins(mirror, from.wheels, to.wheels);
    replace_twins(mirror, from.probes, to.probes);
    replace_twins(mirror, from.dampers, to.dampers);
    const auto is_of_twin = [&](const Driven& what) {
        const auto element = driven_element(what), joint = driven_joint(what);
        const Load* load = driven_load(what);
        return is_twin(mirror, load         ? load->name
                               : joint >= 0 ? to.joints[static_cast<std::size_t>(joint)].name
                                            : to.elastics[static_cast<std::size_t>(element)].name);
    };
    for (std::size_t b = 0; b < to.branches.size(); ++b)
        for (std::size_t d = 0; d < to.branches[b].drivers.size(); ++d)
            if (Driver& driver = to.branches[b].drivers[d]; is_of_twin(driver.what))
                driver = from.branches[b].drivers[d];
    for (std::size_t k = 0; to.trim && k < to.trim->adjust.size(); ++k)
        if (auto& adjusted = to.trim->adjust[k]; is_of_twin(adjusted.what))
            adjusted = from.trim->adjust[k];
}

}  // namespace reader

std::optional<Number> find_number(const Scene& scene, std::string_view path) {
    const auto [both, side] = reader::path_and_side(path);
    const auto found = std::ranges::find(scene.numbers, both, &Number::path);
    if (found == scene.numbers.end()) return std::nullopt;
    if (side.empty()) return *found;
    for (const auto& [name, value] : found->sides)
        if (name == side) return Number{std::string(path), value, found->unit, {}};
    return std::nullopt;
}

}  // namespace elastocheck
