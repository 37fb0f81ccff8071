// Loads, as written: what a moment is per unit of depends on the branch that uses it (branches.cpp).
#include <fmt/format.h>

#include "models/reader/sections.hpp"

namespace elastocheck::reader {
namespace {

Load load_in(const std::string& name, const Cursor& at, const Definitions& defs, const Unit& force_unit,
             const Unit& moment_unit) {
    at.only_keys({"on", "at", "force", "moment"});
    const BodyId on = moving_body(at.require("on"), defs, "a load");
    const auto force = at.optional("force"), moment = at.optional("moment");
    if (force && moment) moment->fail("given together with force; allowed: one of the two");
    if (force)
        return {name,
                DeadForce{point_of(on, hardpoint(at.require("at"), defs), defs), vector(*force, force_unit)}};
    if (!moment) at.fail("no load; allowed: force with at, or moment");
    if (const auto point = at.optional("at"))
        point->fail("a moment has no point of application; leave it out");
    return {name, DeadMoment{on, vector(*moment, moment_unit)}};
}

}  // namespace

Load read_load(const std::string& name, const Cursor& at, const Definitions& defs) {
    return load_in(name, at, defs, {}, {});
}

Load read_static_load(const std::string& name, const Cursor& at, const Definitions& defs) {
    return load_in(name, at, defs, defs.units.force, defs.units.moment);
}

}  // namespace elastocheck::reader
