// Reads a trim: adjustments, conditions, and loads.
#include <fmt/format.h>

#include "models/kinds.hpp"
#include "models/reader/definitions/look_up.hpp"
#include "models/reader/definitions/terms.hpp"
#include "models/reader/elements/sections.hpp"

namespace elastocheck::reader {
namespace {

// ---- Adjustments.

// Whether the quantity exists only on the branches that drive it: of a jack, of the drive of a joint that
// is not held, of a tyre.
bool is_active_only_where_driven(const Drivable& quantity, const Scene& scene) {
    const int element = driven_element(quantity.what);
    return quantity.joint.has_value() ||
           (element >= 0 &&
            scene.elastics[static_cast<std::size_t>(element)].active_only_where_driven);
}

Trim::Adjustment read_adjustment(const Term& term, const Loads& loads, Drivables& drivables,
                                 Scene& scene) {
    if (loads.contains(term.name) && !drivables.table.contains(term.name))
        term.at.fail(
            fmt::format("{} is a load, which cannot be adjusted; allowed: preloads, free lengths "
                        "and offsets, named as in drive",
                        quote(term.name)));
    if (const auto found = drivables.table.find(term.name);
        found != drivables.table.end() && is_active_only_where_driven(found->second, scene))
        term.at.fail(
            fmt::format("{} is active only on the branches that drive it; allowed: elements and "
                        "joints that are active on all branches",
                        quote(term.name)));
    const Drivable& quantity = drivable(term.at, term.name, drivables, scene);
    return {.name = term.name,
            .what = quantity.what,
            .per_unit = quantity.factor,
            .unit = quantity.kind};
}

std::vector<Trim::Adjustment> read_adjustments(const Cursor& field, const Loads& loads,
                                               Drivables& drivables, Scene& scene) {
    if (field.value->kind == Value::Kind::map)
        field.fail(
            "expected a name or a list of names, found a map; adjusted quantities have no values "
            "before the trim");
    std::vector<Trim::Adjustment> adjustments;
    for (const Term& term : terms(field, "an adjusted quantity")) {
        const auto adjustment = read_adjustment(term, loads, drivables, scene);
        for (const auto& other : adjustments)
            if (is_same(other.what, adjustment.what))
                term.at.fail(fmt::format("{} adjusts the same quantity as {}; allowed: once",
                                         quote(term.name), quote(other.name)));
        adjustments.push_back(adjustment);
    }
    return adjustments;
}

// ---- Conditions.

struct Output {
    ConditionKind what;
    Unit unit;
};

std::map<std::string, Output> outputs(const Scene& scene, const Units& units) {
    std::map<std::string, Output> table;
    for (int k = 0; k < static_cast<int>(scene.wheels.size()); ++k) {
        const std::string& name = scene.wheels[static_cast<std::size_t>(k)].name;
        const std::string of_wheel = name.empty() ? "" : name + ".";
        table[of_wheel + "travel"] = {WheelTravel{k}, units.length};
        table[of_wheel + "toe"] = {WheelToe{k}, units.angle};
        table[of_wheel + "camber"] = {WheelCamber{k}, units.angle};
    }
    for (int k = 0; k < static_cast<int>(scene.probes.size()); ++k)
        for (int axis = 0; axis < 3; ++axis)
            table[fmt::format("{}.{}", scene.probes[static_cast<std::size_t>(k)].name,
                              "xyz"[axis])] = {ProbeCoordinate{k, axis}, units.length};
    return table;
}

std::vector<Trim::Condition> read_conditions(const Cursor& field, const Scene& scene,
                                             const Units& units) {
    const auto table = outputs(scene, units);
    std::vector<Trim::Condition> conditions;
    for (const Term& term : terms(field, "an output")) {
        const auto found = table.find(term.name);
        if (found == table.end())
            term.at.fail(fmt::format("{} cannot be a condition of a trim{}", quote(term.name),
                                     did_you_mean(term.name, names_of(table), "allowed")));
        const auto& [what, unit] = found->second;
        const auto value =
            term.has_number ? std::optional(unit.si(term.number(unit.name))) : std::nullopt;
        conditions.push_back({.name = term.name, .what = what, .value = value});
    }
    return conditions;
}

void require_as_many(const Cursor& field, const Trim& trim) {
    const std::size_t adjusted = trim.adjust.size(), conditions = trim.until.size();
    if (adjusted == conditions) return;
    const bool few = conditions < adjusted;
    const std::size_t missing = few ? adjusted - conditions : conditions - adjusted;
    field.fail(fmt::format("{} adjusted, {} {}: {} more {} needed", adjusted, conditions,
                           conditions == 1 ? "condition" : "conditions",
                           missing == 1 ? "one" : std::to_string(missing),
                           few ? (missing == 1 ? "condition is" : "conditions are")
                               : (missing == 1 ? "adjustment is" : "adjustments are")));
}

}  // namespace

void read_trim(const Cursor& scene, const Units& units, const Loads& loads, Drivables& drivables,
               Scene& result) {
    const auto section = scene.optional("trim");
    if (!section) return;
    section->only_keys({"adjust", "until", "under", "bushings"});
    Trim trim;
    if (const auto bushings = section->optional("bushings"))
        trim.bushings = bushings->one_of("a kind of trim", {"unloaded", "balanced"}) == 0
                            ? Trim::Bushings::unloaded
                            : Trim::Bushings::balanced;
    trim.line = section->value->line;
    trim.adjust = read_adjustments(section->require("adjust"), loads, drivables, result);
    trim.until = read_conditions(section->require("until"), result, units);
    require_as_many(*section, trim);
    if (const auto under = section->optional("under"))
        for (const Term& term : terms(*under, "a load")) {
            Load& load = result.static_loads.emplace_back(look_up_load(term, loads));
            load_vector(load.kind) *= held_value(term, load, units);
        }
    result.trim = trim;
}

}  // namespace elastocheck::reader
