// Loads and branches.
//
// f_ext(a) = static loads + a · (sum of the branch's loads). What is per unit of a follows from what a is:
//
//   branch with a force      a [N]                        force [-], moment [length -> m]
//   branch of moments only   a [force·length -> N·m]      moment [-]
//
// One entry of `loads` may serve both kinds, so only the branch knows its unit.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <variant>

#include "models/reader/look_up.hpp"
#include "models/reader/sections.hpp"
#include "models/reader/words.hpp"

namespace elastocheck::reader {
namespace {

constexpr int most_steps = 1'000'000;

// As written, in declared units.
Load read_load(const std::string& name, const Cursor& at, const Definitions& defs) {
    at.only_keys({"on", "at", "force", "moment"});
    const BodyId on = moving_body(at.require("on"), defs, "a load");
    const auto force = at.optional("force"), moment = at.optional("moment");
    if (force && moment) moment->fail("given together with force; allowed: one of the two");
    if (force)
        return {name, DeadForce{point_of(on, hardpoint(at.require("at"), defs), defs), vector(*force)}};
    if (!moment) at.fail("no load; allowed: force with at, or moment");
    if (const auto point = at.optional("at"))
        point->fail("a moment has no point of application; leave it out");
    return {name, DeadMoment{on, vector(*moment)}};
}

bool is_moment(const Load& load) { return std::holds_alternative<DeadMoment>(load.kind); }

bool is_zero(const Load& load) {
    if (const auto* moment = std::get_if<DeadMoment>(&load.kind)) return moment->m.isZero(0);
    return std::get<DeadForce>(load.kind).f.isZero(0);
}

// A moment from force·length to N·m, or from length to m: the same division.
void convert_moment(Load& load, const Units& units) {
    if (auto* moment = std::get_if<DeadMoment>(&load.kind))
        moment->m = moment->m.unaryExpr([&](double x) { return units.moment_si(x); }).eval();
}

// A name or a list of names.
std::vector<Load> chosen_loads(const Cursor& at, const std::map<std::string, Load>& loads) {
    const auto cursors = at.is_list() ? at.items() : std::vector<Cursor>{at};
    if (cursors.empty()) at.fail("an empty list; at least one load is needed");
    std::vector<Load> chosen;
    for (const Cursor& cursor : cursors) {
        const Load& load = look_up(cursor, "load", loads);
        if (std::any_of(chosen.begin(), chosen.end(), [&](const Load& l) { return l.name == load.name; }))
            cursor.fail(fmt::format("{} is listed twice", quote(load.name)));
        chosen.push_back(load);
    }
    return chosen;
}

Branch read_branch(const std::string& name, const Cursor& at, const Definitions& defs,
                   const std::map<std::string, Load>& loads) {
    at.only_keys({"load", "to", "steps"});
    Branch branch;
    branch.name = name;
    std::vector<Load> chosen = chosen_loads(at.require("load"), loads);
    if (std::all_of(chosen.begin(), chosen.end(), is_zero))
        at.require("load").fail("zero in every component; a branch needs a load");
    const Cursor to = at.require("to");
    branch.to = to.number();
    if (branch.to == 0) to.fail("zero leads nowhere; allowed: any other load factor");
    branch.steps = at.require("steps").whole_number(1, most_steps);
    if (std::all_of(chosen.begin(), chosen.end(), is_moment)) {
        branch.unit = ParameterUnit::newton_metre;
        branch.to = defs.units.moment_si(branch.to);
    } else {
        for (Load& load : chosen) convert_moment(load, defs.units);
    }
    for (const Load& load : chosen) branch.drivers.push_back({.what = load, .start = 0, .rate = 1});
    return branch;
}

}  // namespace

void read_loads(const Cursor& scene, const Definitions& defs, std::vector<Load>& static_loads,
                std::vector<Branch>& branches) {
    if (const auto section = scene.optional("static_loads"))
        for (const auto& [name, at] : section->entries()) {
            static_loads.push_back(read_load(name, at, defs));
            convert_moment(static_loads.back(), defs.units);
        }
    std::map<std::string, Load> loads;
    const Cursor load_section = scene.require("loads"), branch_section = scene.require("branches");
    for (const auto& [name, at] : load_section.entries()) loads.emplace(name, read_load(name, at, defs));
    for (const auto& [name, at] : branch_section.entries())
        branches.push_back(read_branch(name, at, defs, loads));
    if (branches.empty()) branch_section.fail("empty; at least one branch is needed");
}

}  // namespace elastocheck::reader
