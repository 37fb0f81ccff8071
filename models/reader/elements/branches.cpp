// Reads branches: drivers, range, and values held constant.
//
// Each driver is start + rate · a in the declared units, a in the unit of the branch:
//
//   load, at least one force   a [force]         force [-], moment [moment/force]
//   load, moments only         a [moment]        moment [-]
//   drive                      a [unit of the first quantity driven], rates per unit of a
//   static_loads, hold         rate 0
//
// An entry of `loads` may be used in all these ways, so its unit depends on the branch.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "elastocheck/compile.hpp"
#include "models/branch.hpp"
#include "models/kinds.hpp"
#include "models/reader/definitions/terms.hpp"
#include "models/reader/document/limits.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/elements/sections.hpp"
#include "models/vanishing_length.hpp"

namespace elastocheck::reader {
namespace {

struct Parameter {
    ParameterUnit kind;
    Unit unit;
};

// The rate of a driver; SceneError at the term if it is zero, with the clause `objection`.
double nonzero_rate(const Term& term, const char* objection) {
    const double rate = term.number();
    if (rate == 0) term.at.fail(fmt::format("zero, which {}; remove it", objection));
    return rate;
}

// Converts a moment per unit force from the declared unit of moment/force to metres.
void convert_moment_to_per_force(Load& load, const Unit& arm) {
    if (!is_moment(load.kind)) return;
    Vector3& m = load_vector(load.kind);
    m = m.unaryExpr([&](double x) { return arm.si(x); }).eval();
}

Parameter read_loads_moved(const Cursor& field, const Units& units, const Loads& loads,
                           Branch& branch) {
    std::vector<Load> chosen;
    for (const Term& term : terms(field, "a load")) {
        chosen.push_back(look_up_load(term, loads));
        branch.drivers.push_back(
            {.what = Load{}, .start = 0, .rate = nonzero_rate(term, "loads nothing")});
    }
    const auto zero = [](const Load& load) { return load_vector(load.kind).isZero(0); };
    const auto moment = [](const Load& load) { return is_moment(load.kind); };
    if (std::ranges::all_of(chosen, zero))
        field.fail("zero in every component; a branch needs a nonzero load");
    const bool only_moments = std::ranges::all_of(chosen, moment);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        if (!only_moments) convert_moment_to_per_force(chosen[k], units.arm);
        branch.drivers[k].what = chosen[k];
    }
    return only_moments ? Parameter{ParameterUnit::newton_metre, units.moment}
                        : Parameter{ParameterUnit::newton, units.force};
}

Parameter read_driven(const Cursor& field, Drivables& drivables, Scene& scene, Branch& branch) {
    std::optional<Parameter> parameter;
    for (const Term& term : terms(field, "a driven quantity")) {
        const Drivable& quantity = drivable(term.at, term.name, drivables, scene);
        if (!parameter) parameter = Parameter{quantity.kind, quantity.unit};
        const double rate =
            nonzero_rate(term, "rate zero drives nothing; a constant value belongs in hold");
        if (term.name == "hand_wheel" && (rate != 1 || !branch.drivers.empty()))
            term.at.fail("the parameter of the branch is its angle; allowed: first, with rate 1");
        // SI unit of the quantity per SI unit of a. Equal units need no conversion, so that the rate
        // stays exact.
        const double si_rate = quantity.unit.name == parameter->unit.name
                                   ? rate
                                   : quantity.unit.si(rate) / parameter->unit.si(1);
        branch.drivers.push_back(
            {.what = quantity.what, .start = 0, .rate = si_rate * quantity.factor});
    }
    return *parameter;
}

void read_static_loads(const Cursor& field, const Units& units, const Loads& loads,
                       Branch& branch) {
    for (const Term& term : terms(field, "a load")) {
        const Load& load = look_up_load(term, loads);
        branch.drivers.push_back({.what = load, .start = held_value(term, load, units), .rate = 0});
    }
}

void read_hold(const Cursor& field, Drivables& drivables, Scene& scene, Branch& branch) {
    if (field.value->kind != Value::Kind::map)
        field.fail(
            fmt::format("expected a map from held quantities to values, found {}", field.found()));
    for (const Term& term : terms(field, "a held quantity")) {
        const Drivable& quantity = drivable(term.at, term.name, drivables, scene);
        const double value = quantity.unit.si(term.number(quantity.unit.name));
        branch.drivers.push_back(
            {.what = quantity.what, .start = value * quantity.factor, .rate = 0});
    }
}

void require_different(const Cursor& branch, const std::vector<Driver>& drivers) {
    for (std::size_t k = 0; k < drivers.size(); ++k)
        for (std::size_t l = 0; l < k; ++l) {
            if (!is_same(drivers[k].what, drivers[l].what)) continue;
            const bool both = drivers[k].rate != 0 && drivers[l].rate != 0;
            const bool neither = drivers[k].rate == 0 && drivers[l].rate == 0;
            branch.fail(fmt::format("{} the same quantity twice; allowed: once",
                                    both      ? "drives"
                                    : neither ? "holds"
                                              : "drives and holds"));
        }
}

void read_range(const Cursor& field, const Parameter& parameter, std::size_t bodies,
                Branch& branch) {
    const Cursor to = field.require("to");
    const auto from = field.optional("from");
    const std::string& unit = parameter.unit.name;
    branch.unit = parameter.kind;
    branch.from = from ? parameter.unit.si(from->number(unit)) : 0;
    branch.to = parameter.unit.si(to.number(unit));
    if (branch.to == 0) to.fail("zero: the branch would have no length; allowed: any other value");
    if (branch.from * branch.to > 0)
        from->fail(
            fmt::format("{} and `to` are on the same side of 0, the start of the branch; allowed: "
                        "the other side, or 0",
                        from->found()));
    const Cursor steps = field.require("steps");
    // at least one per side
    branch.steps = steps.whole_number(branch.from == 0 ? 1 : 2, max_steps);
    if (branch.steps * static_cast<double>(bodies) > max_poses)
        steps.fail(fmt::format(
            "{} steps of {} bodies are too many positions to store; allowed: {:.0f} steps",
            branch.steps, bodies, std::floor(max_poses / static_cast<double>(bodies))));
}

Branch read_branch(const std::string& name, const Cursor& field, const Units& units,
                   const Loads& loads, Drivables& drivables, Scene& scene) {
    field.only_keys({"load", "drive", "from", "to", "steps", "static_loads", "hold"});
    const auto load = field.optional("load"), drive = field.optional("drive");
    if (load && drive)
        drive->fail(
            "given together with load; allowed: one of the two (a constant load belongs in "
            "static_loads)");
    if (!load && !drive) field.fail("the branch drives nothing; required: load or drive");
    Branch branch;
    branch.name = name;
    const Parameter parameter = load ? read_loads_moved(*load, units, loads, branch)
                                     : read_driven(*drive, drivables, scene, branch);
    if (const auto held = field.optional("static_loads"))
        read_static_loads(*held, units, loads, branch);
    if (const auto held = field.optional("hold")) read_hold(*held, drivables, scene, branch);
    require_different(field, branch.drivers);
    read_range(field, parameter, scene.bodies.size(), branch);
    return branch;
}

// ---- Checks that the drivers of a branch survive compilation.

// The reason for which compile() left out a part.
std::string reason(const Model& model, const std::string& what) {
    for (const Omission& omission : model.omitted)
        if (omission.what == what) return omission.why;
    return "";
}

// "load 'push' acts on body 'arm', which is left out: no output is connected to it"
std::string why_driver_is_omitted(const Driver& driver, const Scene& scene, const Model& model) {
    const auto part = [&](const std::string& what) {
        return fmt::format("{} is left out: {}", what, reason(model, what));
    };
    if (const int k = driven_joint(driver.what); k >= 0)
        return part("joint '" + scene.joints[static_cast<std::size_t>(k)].name + "'");
    if (const int k = driven_element(driver.what); k >= 0)
        return part("element '" + scene.elastics[static_cast<std::size_t>(k)].name + "'");
    const Load& load = *driven_load(driver.what);
    if (load_vector(load.kind).isZero(0)) return fmt::format("load '{}' is zero", load.name);
    const std::string body =
        "body '" + scene.bodies[static_cast<std::size_t>(body_of(load.kind))].name + "'";
    return fmt::format("load '{}' acts on {}, which is left out: {}", load.name, body,
                       reason(model, body));
}

// Rejects a branch that drives a length to zero. The error is rethrown as LengthVanishes, which a study
// counts as a result of the variant and not as a mistake in the scene.
void require_lengths(const Cursor& branch, const Model& model, std::size_t b) {
    for (const Branch& side : branch_sides(model.branches[b])) {
        const auto vanishing = vanishing_length(model, side);
        if (!vanishing) continue;
        const Cursor place = vanishing->parameter == 0
                                 ? branch.require("hold")
                                 : branch.require(side.to == model.branches[b].to ? "to" : "from");
        const std::string& name = model.joints[static_cast<std::size_t>(vanishing->joint)].name;
        try {
            place.fail(
                vanishing->parameter == 0
                    ? fmt::format("leaves joint {} no length", quote(name))
                    : fmt::format("{} would leave joint {} a length of {:.6g} mm; allowed: short "
                                  "of {:.6g}, where its length is zero",
                                  place.found(), quote(name), 1e3 * vanishing->length,
                                  place.number("") * vanishing->parameter / side.to));
        } catch (const SceneError& error) {
            throw LengthVanishes(error.what());
        }
    }
}

// Compiles the scene and requires that every branch keeps a driver that moves something.
Model compile_and_require_motion(const Cursor& section, const Scene& scene) {
    Model model = compile(scene);
    const auto moves = [](const Driver& driver) { return driver.rate != 0; };
    for (std::size_t b = 0; b < scene.branches.size(); ++b) {
        require_lengths(section.require(scene.branches[b].name), model, b);
        if (std::ranges::any_of(model.branches[b].drivers, moves)) continue;
        std::string why;
        for (const Driver& driver : scene.branches[b].drivers)
            if (moves(driver))
                why += (why.empty() ? "" : "; ") + why_driver_is_omitted(driver, scene, model);
        section.require(scene.branches[b].name)
            .fail("changes nothing that an output depends on: " + why);
    }
    return model;
}

void note_unused_loads(const Cursor& file, const Cursor& section, const Loads& loads,
                       Scene& scene) {
    std::set<std::string> used;
    if (const auto trim = file.optional("trim"))
        if (const auto under = trim->optional("under"))
            for (const Term& term : terms(*under, "a load")) used.insert(term.name);
    for (const Branch& branch : scene.branches)
        for (const Driver& driver : branch.drivers)
            if (const Load* load = driven_load(driver.what)) used.insert(load->name);
    for (const std::string& name : section.value->keys)
        if (loads.contains(name) && !used.contains(name))
            scene.omitted.push_back({"load '" + name + "'", "no branch uses it"});
}

}  // namespace

Model read_branches(const Cursor& file, const Units& units,
                    const std::map<std::string, Load>& loads, Drivables& drivables, Scene& scene) {
    const Cursor section = file.require("branches");
    for (const auto& [name, field] : section.entries())
        scene.branches.push_back(read_branch(name, field, units, loads, drivables, scene));
    if (scene.branches.empty()) section.fail("empty; at least one branch is needed");
    Model model = compile_and_require_motion(section, scene);
    if (const auto load_section = file.optional("loads"); load_section)
        note_unused_loads(file, *load_section, loads, scene);
    return model;
}

}  // namespace elastocheck::reader
