// Reads loads (forces and moments) of a scene.
// The unit of a moment in `loads` depends on the branch that uses it (branches.cpp). Bodies start
// parallel to ground, so that a follower has the same components in the axes of its body.
//
// A force at the contact patch of a wheel that rolls acts on the wheel. If it has a component along
// x, its torque about the spin axis is taken by the brake: on the carrier, or with `torque: ground`
// by a brake or differential on the car, through a half shaft.

#include <algorithm>

#include "models/reader/elements/sections.hpp"

namespace elastocheck::reader {
namespace {

Load load_in(const std::string& name, const Cursor& field, const Definitions& defs,
             const std::vector<Wheel>& wheels, const Unit& force_unit, const Unit& moment_unit) {
    field.only_keys({"on", "at", "force", "moment", "follows", "torque"});
    const BodyId on = moving_body(field.require("on"), defs, "a load");
    const auto force = field.optional("force"), moment = field.optional("moment");
    if (force && moment) moment->fail("given together with force; allowed: one of the two");
    const auto follows = field.optional("follows");
    const bool is_follower = follows && follows->yes_or_no();
    const auto torque = field.optional("torque");
    if (force) {
        const Vector3 p = hardpoint(field.require("at"), defs);
        Point point = point_of(on, p, defs);
        const Vector3 f = vector(*force, force_unit);
        const auto wheel = std::ranges::find_if(wheels, [&](const Wheel& w) {
            return w.rolls() && w.body == on &&
                   (point_of(w.contact.body, p, defs).s_local - w.contact.s_local).norm() <
                       coincident;
        });
        if (wheel != wheels.end()) {
            point = wheel->contact;
            const bool on_car = torque && torque->one_of("a holder", {"carrier", "ground"}) == 1;
            if (f.x() != 0 && !on_car && !is_follower) return {name, BrakeForce{point, on, f}};
        } else if (torque) {
            torque->fail("allowed for a force at the contact patch of a wheel that rolls");
        }
        return {name,
                is_follower ? LoadKind(FollowerForce{point, f}) : LoadKind(DeadForce{point, f})};
    }
    if (torque) torque->fail("allowed for a force at the contact patch of a wheel that rolls");
    if (!moment) field.fail("no load; required: force with at, or moment");
    if (const auto point = field.optional("at"))
        point->fail("a moment has no point of application; remove this field");
    const Vector3 m = vector(*moment, moment_unit);
    return {name, is_follower ? LoadKind(FollowerMoment{on, m}) : LoadKind(DeadMoment{on, m})};
}

}  // namespace

Load read_load(const std::string& name, const Cursor& field, const Definitions& defs,
               const std::vector<Wheel>& wheels) {
    return load_in(name, field, defs, wheels, {}, {});
}

Load read_static_load(const std::string& name, const Cursor& field, const Definitions& defs,
                      const std::vector<Wheel>& wheels) {
    return load_in(name, field, defs, wheels, defs.units.force, defs.units.moment);
}

}  // namespace elastocheck::reader
