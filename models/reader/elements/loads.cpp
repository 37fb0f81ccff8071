// Reads loads (forces and moments) of a scene.
// The unit of a moment depends on the branch that uses it (branches.cpp). Bodies start parallel to
// ground, so that a follower has the same components in the axes of its body.
#include <fmt/format.h>

#include "models/reader/elements/sections.hpp"

namespace elastocheck::reader {
namespace {

Load load_in(const std::string& name, const Cursor& at, const Definitions& defs,
             const Unit& force_unit, const Unit& moment_unit) {
    at.only_keys({"on", "at", "force", "moment", "follows"});
    const BodyId on = moving_body(at.require("on"), defs, "a load");
    const auto force = at.optional("force"), moment = at.optional("moment");
    if (force && moment) moment->fail("given together with force; allowed: one of the two");
    const auto follows = at.optional("follows");
    const bool is_follower = follows && follows->yes_or_no();
    if (force) {
        const Point point = point_of(on, hardpoint(at.require("at"), defs), defs);
        const Vector3 f = vector(*force, force_unit);
        return {name,
                is_follower ? LoadKind(FollowerForce{point, f}) : LoadKind(DeadForce{point, f})};
    }
    if (!moment) at.fail("no load; required: force with at, or moment");
    if (const auto point = at.optional("at"))
        point->fail("a moment has no point of application; remove this field");
    const Vector3 m = vector(*moment, moment_unit);
    return {name, is_follower ? LoadKind(FollowerMoment{on, m}) : LoadKind(DeadMoment{on, m})};
}

}  // namespace

Load read_load(const std::string& name, const Cursor& at, const Definitions& defs) {
    return load_in(name, at, defs, {}, {});
}

Load read_static_load(const std::string& name, const Cursor& at, const Definitions& defs) {
    return load_in(name, at, defs, defs.units.force, defs.units.moment);
}

}  // namespace elastocheck::reader
