#include "elastocheck/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "models/decimal.hpp"
#include "models/kinds.hpp"
#include "models/reader/definitions/beams.hpp"
#include "models/reader/definitions/mirror.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/text_file.hpp"
#include "models/reader/document/yaml.hpp"
#include "models/reader/elements/driven.hpp"
#include "models/reader/elements/sections.hpp"
#include "models/reader/parsed_scene.hpp"
#include "models/reader/plausibility.hpp"
#include "models/reader/settings.hpp"

namespace elastocheck {
namespace reader {
namespace {

constexpr int format_version = 1;

void check_version(const Cursor& scene) {
    const Cursor version = scene.require("elastocheck");
    if (version.text("the version of the format") != std::to_string(format_version))
        version.fail(fmt::format("{} is not a supported version of the format; allowed: {}",
                                 version.found(), format_version));
}

void check_all_held(const Cursor& scene, const Scene& result) {
    std::vector<bool> held(result.bodies.size(), false);
    const auto hold = [&](BodyId body) {
        if (body != ground) held[static_cast<std::size_t>(body)] = true;
    };
    for (const Joint& joint : result.joints) each_body(joint.kind, hold);
    for (const Elastic& elastic : result.elastics) each_body(elastic.kind, hold);
    const Cursor bodies = scene.require("bodies");
    for (std::size_t b = 0; b < held.size(); ++b)
        if (!held[b])
            bodies.require(result.bodies[b].name)
                .fail(
                    "no joint or element is attached to it; a joint, spring or bushing is needed");
}

// The twin of an entry, still with the name of the entry: of a joint, element or load by its kind.
template <class T>
T mirrored(T entry, const Definitions& defs) {
    entry.kind = twin(entry.kind, defs);
    return entry;
}
Probe mirrored(Probe probe, const Definitions& defs) {
    probe.at = twin(probe.at, defs);
    return probe;
}
Damper mirrored(Damper damper, const Definitions& defs) {
    damper.i = twin(damper.i, defs);
    damper.j = twin(damper.j, defs);
    return damper;
}
Wheel mirrored(Wheel wheel, const Definitions& defs) { return twin(wheel, defs); }

// Whether shared entries of a section must be attached to both sides or neither, or to any.
enum class Sides { both, any };

template <class T>
void append(std::vector<T>& list, T entry) {
    list.push_back(std::move(entry));
}
template <class T>
void append(std::vector<T>& list, std::vector<T> entries) {
    std::ranges::move(entries, std::back_inserter(list));
}

// Reads the entries of a section and appends their twins.
template <class T, class Read>
void read_section(const Cursor& scene, const char* key, const Definitions& defs, Sides sides,
                  std::vector<T>& list, Read read) {
    const auto section = scene.optional(key);
    if (!section) return;
    if (sides == Sides::both) require_both_sides(*section, defs);
    const std::size_t begin = list.size();
    for (const auto& [name, field] : section->entries()) append(list, read(name, field, defs));
    const std::size_t end = list.size();
    for (std::size_t k = begin; defs.mirror && k < end; ++k)
        if (const auto name = twin_name(*defs.mirror, list[k].name, *section)) {
            T twin_entry = mirrored(list[k], defs);
            twin_entry.name = *name;
            list.push_back(twin_entry);
        }
}

// Reads a section of elements and notes in `named` those to which a branch may refer; the stops of a
// spring, elements of their own, are not among them.
template <class Read>
void read_elements(const Cursor& scene, const char* key, const Definitions& defs,
                   std::vector<Elastic>& elastics, NamedElements& named, Read read) {
    const std::size_t begin = elastics.size();
    read_section(scene, key, defs, Sides::both, elastics, read);
    const auto section = scene.optional(key);
    if (!section) return;
    std::unordered_map<std::string, bool> is_written;  // false for a twin created by the mirror
    for (const std::string& name : section->value->keys) {
        is_written[name] = true;
        if (const auto twin = defs.mirror ? mirrored_name(*defs.mirror, name) : std::nullopt)
            is_written.emplace(*twin, false);
    }
    for (std::size_t k = begin; k < elastics.size(); ++k)
        if (const auto found = is_written.find(elastics[k].name); found != is_written.end())
            named[static_cast<int>(k)] = {std::string(key) + "." + elastics[k].name,
                                          !found->second};
}

// `wheel` is the short form for a single wheel without name.
void read_wheels(const Cursor& scene, Definitions& defs, std::vector<Wheel>& wheels) {
    const auto one = scene.optional("wheel");
    if (one && scene.optional("wheels"))
        one->fail("given together with wheels; allowed: one of the two");
    if (one && defs.mirror)
        one->fail(
            fmt::format("a scene with a mirror needs wheels with names; give wheels: {{{}: ...}}",
                        defs.mirror->from));
    if (one) wheels.push_back(read_wheel("", *one, defs));
    read_section(scene, "wheels", defs, Sides::both, wheels,
                 [&](const std::string& name, const Cursor& field, const Definitions&) {
                     return read_wheel(name, field, defs);
                 });
}

// Adds the drives of held joints, active on every branch. Returns joint -> drive, by position.
std::map<int, int> add_held(const Cursor& scene, const Definitions& defs, Scene& result) {
    std::map<int, int> drives;
    const auto section = scene.optional("joints");
    if (!section) return drives;
    std::unordered_map<std::string, int> positions;
    for (std::size_t k = 0; k < result.joints.size(); ++k)
        positions.emplace(result.joints[k].name, static_cast<int>(k));
    const auto hold = [&](const Cursor& field, const std::string& name) {
        const int position = positions.at(name);
        const Joint drive = *drive_of(result.joints[static_cast<std::size_t>(position)]);
        drives[position] = add_joint(field, drive, result);
    };
    for (const auto& [name, field] : section->entries()) {
        if (!is_held(field)) continue;
        hold(field, name);
        if (defs.mirror)
            if (const auto twin = mirrored_name(*defs.mirror, name)) hold(field, *twin);
    }
    return drives;
}

// Adds the angle of the hand wheel as a drivable quantity: a turn displaces the joint with `per_turn` by
// that length.
void add_hand_wheel(const Cursor& scene, const Units& units, Drivables& drivables) {
    const auto section = scene.optional("joints");
    if (!section) return;
    for (const auto& [name, field] : section->entries())
        if (const auto per_turn = field.optional("per_turn")) {
            const double length = units.length.si(per_turn->number(units.length.name));
            if (length == 0)
                per_turn->fail("zero: the hand wheel would not steer; allowed: a length");
            const Drivable angle{ParameterUnit::radian,           units.angle,  Motion{-1},
                                 length / (2 * std::numbers::pi), std::nullopt, "joints." + name};
            if (!drivables.table.emplace("hand_wheel", angle).second)
                per_turn->fail("a second joint of the hand wheel; allowed: one with per_turn");
        }
}

// The names that the reader gives to stops must be unused.
void require_free_stop_names(const Cursor& scene, const Definitions& defs,
                             const std::vector<Elastic>& elastics) {
    std::unordered_map<std::string, int> uses;
    for (const Elastic& elastic : elastics) ++uses[elastic.name];
    for (const char* key : {"springs", "stops"}) {
        const auto section = scene.optional(key);
        if (!section) continue;
        for (const auto& [owner, entry] : section->entries())
            for (const char* field : {"bump_stop", "rebound_stop", "bump", "rebound"}) {
                const auto stop = entry.optional(field);
                if (!stop) continue;
                const std::string name = owner + "." + field;
                const auto twin = defs.mirror ? mirrored_name(*defs.mirror, name) : std::nullopt;
                for (const std::string& stop_name : {name, twin.value_or(name)})
                    if (uses[stop_name] > 1)
                        stop->fail(
                            fmt::format("the element name {} is reserved for its stop, but already "
                                        "in use; rename the other element",
                                        quote(stop_name)));
            }
    }
}

// A spring and a damper each have an output NAME.compression, so that their names must differ.
void require_different_outputs(const Cursor& scene, const Scene& result) {
    for (const Damper& damper : result.dampers)
        for (const Elastic& elastic : result.elastics) {
            if (elastic.name != damper.name || elastic.written_as != WrittenAs::itself ||
                driven_number(elastic.kind) == nullptr)
                continue;
            const Cursor section = scene.require("dampers");
            section.optional(damper.name)
                .value_or(section)
                .fail(fmt::format("a spring has the same name {}, and each has an output of that "
                                  "name; rename one of the two",
                                  quote(damper.name)));
        }
}

// Removes repeated records of a number that is read twice.
void keep_each_once(std::vector<Number>& numbers) {
    std::set<std::string> seen;
    std::erase_if(numbers, [&](const Number& number) { return !seen.insert(number.path).second; });
}

// Whether a trim or a branch may refer to a joint or an element.
bool drives_parts(const Cursor& scene) {
    if (scene.optional("trim") || scene.optional("tyres")) return true;
    return std::ranges::any_of(scene.require("branches").entries(), [](const auto& branch) {
        return branch.at.optional("drive") || branch.at.optional("hold");
    });
}

// Results of read_tree() other than the scene.
struct TreeResults {
    std::vector<std::string>* warnings = nullptr;  // null: no plausibility checks
    Definitions defs = {};
    Model model = {};  // the scene compiled
};

// `twins`: definitions with the numbers of the twins' side, or null.
Scene read_tree(const Cursor& scene, const Folder& folder, const Definitions* twins,
                TreeResults& results) {
    if (scene.value->kind == Value::Kind::empty)
        scene.fail("empty; a scene begins with `elastocheck: 1`");
    scene.only_keys({"elastocheck",     "name",     "units",    "mirror",      "gravity",
                     "points",          "bodies",   "joints",   "springs",     "stops",
                     "torsion_springs", "bushings", "beams",    "tyres",       "static_loads",
                     "loads",           "trim",     "branches", "wheel",       "wheels",
                     "probes",          "dampers",  "vehicle",  "definitions", "one_side"});
    if (scene.first_reading) {
        check_version(scene);
        (void)requested_definitions(scene);
    }
    Scene result;
    result.source = *scene.file;
    result.name = scene.require("name").text("the name of the scene");
    Definitions defs = read_definitions(scene, twins);
    defs.folder = folder;
    read_wheels(scene, defs, result.wheels);
    add_bodies_of_bars(scene, result.wheels, defs);
    if (twins != nullptr) take_twin_bodies(*twins, defs);
    result.bodies = defs.bodies;
    for (const auto& [name, position] : defs.points) result.hardpoints.push_back({name, position});

    read_section(scene, "joints", defs, Sides::both, result.joints, read_joint);
    NamedElements named;
    const auto with_wheels = [&](auto read) {
        return [read, &result](const std::string& name, const Cursor& field, const Definitions& d) {
            return read(name, field, d, result.wheels);
        };
    };
    read_elements(scene, "springs", defs, result.elastics, named, with_wheels(read_spring));
    read_elements(scene, "bushings", defs, result.elastics, named, read_bushing);
    read_section(scene, "stops", defs, Sides::both, result.elastics, read_stops);
    read_elements(scene, "torsion_springs", defs, result.elastics, named, read_torsion_spring);
    if (scene.first_reading) require_free_stop_names(scene, defs, result.elastics);
    read_section(scene, "static_loads", defs, Sides::both, result.static_loads,
                 with_wheels(read_static_load));
    read_gravity(scene, defs, result);
    std::vector<Load> loads;
    read_section(scene, "loads", defs, Sides::any, loads, with_wheels(read_load));
    read_section(scene, "probes", defs, Sides::any, result.probes, read_probe);
    read_section(scene, "dampers", defs, Sides::both, result.dampers, read_damper);
    if (scene.first_reading) require_different_outputs(scene, result);
    if (const auto vehicle = scene.optional("vehicle"))
        result.vehicle = read_vehicle(*vehicle, defs);
    if (result.wheels.empty() && result.probes.empty())
        scene.fail("no outputs; a wheel or a probe is needed");

    std::map<std::string, Load> by_name;
    for (const Load& load : loads) by_name.emplace(load.name, load);
    const auto drives = add_held(scene, defs, result);
    Drivables drivable = scene.first_reading || drives_parts(scene)
                             ? drivables(result, defs.units, drives, named)
                             : Drivables{};
    add_hand_wheel(scene, defs.units, drivable);
    add_rolling_joints(scene, result);
    add_joints_of_bars(scene, defs, result);
    read_beams(scene, defs, result.elastics);
    read_tyres(scene, defs, drivable, result);
    if (scene.first_reading) check_all_held(scene, result);
    read_trim(scene, defs.units, by_name, drivable, result);
    results.model = read_branches(scene, defs.units, by_name, drivable, result);
    if (results.warnings) *results.warnings = implausible(scene, defs.units, result);
    results.defs = std::move(defs);
    return result;
}

// `model` receives the compiled scene, unless a trim or another side is still to change it.
Scene read_trees(const Trees& trees, const std::string& name, const Folder& folder,
                 bool first_reading, std::vector<std::string>* warnings,
                 std::optional<Model>* model = nullptr) {
    std::vector<Number> numbers, twin_numbers;
    const auto cursor = [&](const Value& tree, std::vector<Number>& list) {
        return Cursor{.value = &tree,
                      .path = "",
                      .file = &name,
                      .numbers = &list,
                      .first_reading = first_reading};
    };
    TreeResults twin_results, results{.warnings = warnings};
    std::optional<Scene> twins;
    if (!trees.twins.empty())
        twins = read_tree(cursor(trees.twins.front(), twin_numbers), folder, nullptr, twin_results);
    Scene scene = read_tree(cursor(trees.written, numbers), folder,
                            twins ? &twin_results.defs : nullptr, results);
    if (twins) take_twins(*results.defs.mirror, *twins, scene);
    if (model != nullptr && !twins && !scene.trim) *model = std::move(results.model);
    if (!first_reading) return scene;
    keep_each_once(numbers);
    keep_each_once(twin_numbers);
    const Mirror* mirror = results.defs.mirror ? &*results.defs.mirror : nullptr;
    for (std::size_t k = 0; k < numbers.size(); ++k)
        if (mirror_of_number(mirror, numbers[k].path))
            numbers[k].sides = {{mirror->from, numbers[k].value},
                                {mirror->to, twins ? twin_numbers[k].value : numbers[k].value}};
    scene.numbers = std::move(numbers);
    return scene;
}

std::string text_of(const std::filesystem::path& file) {
    TextFile read = read_text(file, Pipes::allowed);
    if (!read.trouble.empty()) fail(file.string(), 0, "", read.trouble);
    return std::move(read.text);
}

}  // namespace

ParsedScene::ParsedScene(std::string_view text, std::string name, Folder folder)
    : tree_(parse_yaml(text, name)), name_(std::move(name)), folder_(std::move(folder)) {}

ParsedScene::ParsedScene(const std::filesystem::path& file)
    : ParsedScene(text_of(file), file.string(), file.parent_path()) {}

Scene ParsedScene::read(std::span<const Setting> settings,
                        std::vector<std::string>* warnings) const {
    return read_trees(with_settings(tree_, settings, name_), name_, folder_, true, warnings);
}

namespace {
// Converts scalars that are numbers from text, once for all readings of the tree.
void convert_numbers(Value& value) {
    for (Value& item : value.items) convert_numbers(item);
    const char *const begin = value.text.data(), *const end = begin + value.text.size();
    double x = 0;
    if (value.kind != Value::Kind::scalar || value.is_string || value.number) return;
    if (const auto read = read_decimal(begin, end, x); read.ec == std::errc() && read.ptr == end)
        value.number = x;
}
}  // namespace

VariedScene::VariedScene(const ParsedScene& scene, std::vector<std::string> paths,
                         std::vector<Setting> settings)
    : scene_(scene), settings_(std::move(settings)) {
    const auto fixed = std::ssize(settings_);
    for (std::string& path : paths) settings_.push_back(setting(std::move(path), 0));
    trees_ = with_settings(scene.tree_, settings_, scene.name_, &places_);
    places_.erase(places_.begin(), places_.begin() + fixed);
    convert_numbers(trees_.written);
    for (Value& twins : trees_.twins) convert_numbers(twins);
}

Scene VariedScene::read(std::span<const double> values, std::optional<Model>* model) {
    for (std::size_t k = 0; k < places_.size(); ++k)
        for (Value* place : places_[k]) place->number = values[k];
    try {
        return read_trees(trees_, scene_.name_, scene_.folder_, false, nullptr, model);
    } catch (const SceneError&) {  // read as text for an error with path and line
        std::vector<Setting> settings = settings_;
        for (std::size_t k = 0; k < places_.size(); ++k) {
            Setting& varied = settings[settings.size() - places_.size() + k];
            varied = setting(varied.path, values[k]);
        }
        return scene_.read(settings);
    }
}

std::vector<RequestedDefinition> ParsedScene::definitions(std::span<const Setting> settings) const {
    const Value tree = with_settings(tree_, settings, name_).written;
    std::vector<Number> numbers;
    return requested_definitions({&tree, "", &name_, &numbers});
}

SceneAndWarnings parse_scene_with_warnings(std::string_view text, const std::string& name,
                                           std::span<const Setting> settings,
                                           const Folder& folder) {
    SceneAndWarnings read;
    const ParsedScene parsed(text, name, folder);
    read.scene = parsed.read(settings, &read.warnings);
    read.definitions = parsed.definitions(settings);
    return read;
}

std::vector<RequestedDefinition> requested_definitions(const Cursor& scene) {
    std::vector<RequestedDefinition> list;
    const auto section = scene.optional("definitions");
    if (!section) return list;
    const auto add = [&](const std::string& figure, const Cursor& field) {
        const std::vector<Cursor> names = field.is_list() ? field.items() : std::vector{field};
        if (names.empty()) field.fail("an empty list; a name is needed");
        for (const Cursor& name : names)
            list.push_back({figure,
                            name.text(figure.empty() ? "the name of a set of definitions"
                                                     : "the name of a definition"),
                            name.value->line, name.path});
    };
    if (section->value->kind == Value::Kind::map)
        for (const auto& [figure, field] : section->entries()) add(figure, field);
    else
        add("", *section);
    return list;
}

SceneAndWarnings read_scene_with_warnings(const std::filesystem::path& file,
                                          std::span<const Setting> settings) {
    return parse_scene_with_warnings(text_of(file), file.string(), settings, file.parent_path());
}

}  // namespace reader

Scene parse_scene(std::string_view text, const std::string& name,
                  std::span<const Setting> settings) {
    return reader::parse_scene_with_warnings(text, name, settings, std::nullopt).scene;
}

Scene read_scene(const std::filesystem::path& file, std::span<const Setting> settings) {
    return reader::read_scene_with_warnings(file, settings).scene;
}

}  // namespace elastocheck
