// Reads outputs of a scene: wheels, probes, dampers, and the vehicle data.
#include <fmt/format.h>

#include "models/reader/elements/sections.hpp"

namespace elastocheck::reader {
namespace {

struct Place {
    Vector3 position;
    Point point;
};

// An end of a steering axis: a hardpoint fixed to the wheel's body, or one on another body.
Place end_of_axis(const Cursor& field, BodyId wheel, const Definitions& defs) {
    const bool elsewhere = field.value->kind == Value::Kind::map;
    if (elsewhere) field.only_keys({"on", "at"});
    const BodyId on = elsewhere ? body(field.require("on"), defs) : wheel;
    const Vector3 position = hardpoint(elsewhere ? field.require("at") : field, defs);
    return {position, point_of(on, position, defs)};
}

SteeringAxis read_steering_axis(const Cursor& field, BodyId wheel, const Definitions& defs) {
    const auto ends = field.list(2, "ends, the lower and the upper");
    const Place lower = end_of_axis(ends[0], wheel, defs),
                upper = end_of_axis(ends[1], wheel, defs);
    if (!((upper.position - lower.position).norm() > coincident))
        field.fail("both ends are at the same position; an axis needs two different ones");
    return {lower.point, upper.point};
}

double share(const Cursor& field) {
    const double x = field.number();
    if (!(x >= 0 && x <= 1))
        field.fail(fmt::format("{} is not a share; allowed: 0 to 1", field.found()));
    return x;
}

// Whether the patch, at `arm` from the wheel centre, is within 10 deg (cos = 0.985) of the lowest point
// of the wheel's disc: then the wheel rolls unless the file says otherwise. A rolling wheel keeps the
// distance between the drawn patch and the lowest point.
bool is_near_lowest_point(const Vector3& arm, const Vector3& spin) {
    const Vector3 down = spin.z() * spin - Vector3::UnitZ();  // -z projected onto the disc
    return arm.z() < 0 && arm.dot(down.normalized()) > 0.985 * arm.norm();
}

// Adds the body of a rolling wheel (scene.hpp), at its centre, and that of its twin.
BodyId add_rolling_wheel(const std::string& name, const Vector3& centre, Definitions& defs) {
    const std::string of_wheel = name.empty() ? "" : name + ".";
    const auto add = [&](const std::string& of, const Vector3& r) {
        defs.bodies.push_back({of + "rolling_wheel", {.r = r, .p = Quaternion::Identity()}});
        defs.twin_of.push_back(static_cast<BodyId>(defs.bodies.size()) - 1);
        return defs.twin_of.back();
    };
    const BodyId wheel = add(of_wheel, centre);
    if (const auto twin = defs.mirror ? mirrored_name(*defs.mirror, of_wheel) : std::nullopt) {
        // before taking references to twin_of, which add() may move
        const BodyId other = add(*twin, reflected(centre));
        std::swap(defs.twin_of[static_cast<std::size_t>(wheel)],
                  defs.twin_of[static_cast<std::size_t>(other)]);
    }
    return wheel;
}

}  // namespace

Wheel read_wheel(const std::string& name, const Cursor& entry, Definitions& defs) {
    entry.only_keys(
        {"body", "centre", "contact_patch", "contact", "spin_axis", "side", "steering_axis"});
    const BodyId body = moving_body(entry.require("body"), defs, "a wheel");
    const auto contact = entry.optional("contact_patch");
    const Cursor centre = entry.require("centre"), spin_axis = entry.require("spin_axis");
    const auto local = [&](const Cursor& field) {
        return point_of(body, hardpoint(field, defs), defs).s_local;
    };
    const Cursor side = entry.require("side");
    Wheel wheel{.name = name,
                .body = body,
                .centre_local = local(centre),
                .contact = {body, local(contact ? *contact : centre)},
                .spin_axis_local = direction(spin_axis, defs),
                .side = side.one_of("a side", {"left", "right"}) == 0 ? +1 : -1};
    if (const double y = hardpoint(centre, defs).y(); wheel.side * y < 0)
        side.fail(
            fmt::format("a {} wheel with its centre at y = {:.6g} {}; y points left from the "
                        "middle of the car: "
                        "allowed: {}, or points with y to the left and x forward",
                        wheel.side > 0 ? "left" : "right", defs.units.length.written(y),
                        defs.units.length.name, wheel.side > 0 ? "right" : "left"));
    if (!(wheel.side * wheel.spin_axis_local.y() > 0))
        spin_axis.fail(fmt::format("does not point outboard, which is {}y for a {} wheel",
                                   wheel.side > 0 ? '+' : '-', wheel.side > 0 ? "left" : "right"));
    if (const auto axis = entry.optional("steering_axis"))
        wheel.steering_axis = read_steering_axis(*axis, body, defs);
    const Vector3 arm = wheel.contact.s_local - wheel.centre_local;
    const auto kind = entry.optional("contact");
    const bool rolls = kind ? kind->one_of("a contact", {"carrier", "rolling"}) == 1
                            : is_near_lowest_point(arm, wheel.spin_axis_local);
    if (rolls && kind && !(arm.z() < 0))
        kind->fail("the contact patch is not below the wheel centre; allowed: carrier");
    if (rolls) wheel.contact = {add_rolling_wheel(name, hardpoint(centre, defs), defs), arm};
    return wheel;
}

void add_rolling_joints(const Cursor& scene, Scene& result) {
    for (const Wheel& wheel : result.wheels) {
        if (!wheel.rolls()) continue;
        const std::string of_wheel = wheel.name.empty() ? "" : wheel.name + ".";
        const Direction spin{wheel.body, wheel.spin_axis_local}, road{ground, Vector3::UnitZ()};
        const BodyId on = wheel.contact.body;
        add_joint(scene,
                  {of_wheel + "bearing", Revolute{{on, Vector3::Zero()},
                                                  {wheel.body, wheel.centre_local},
                                                  {on, spin.u_local},
                                                  spin}},
                  result);
        const Direction across{on, spin.u_local.cross(road.u_local).normalized()};
        add_joint(scene, {of_wheel + "spin", Perpendicular{across, road}}, result);
    }
}

Probe read_probe(const std::string& name, const Cursor& field, const Definitions& defs) {
    field.only_keys({"on", "at"});
    const BodyId on = moving_body(field.require("on"), defs, "a probe");
    return {name, point_of(on, hardpoint(field.require("at"), defs), defs)};
}

Damper read_damper(const std::string& name, const Cursor& field, const Definitions& defs) {
    field.only_keys({"bodies", "from", "to"});
    const auto [i, j, length] = between(field, defs, "a damper");
    return {name, i, j};
}

Vehicle read_vehicle(const Cursor& field, const Definitions& defs) {
    field.only_keys({"wheelbase", "cg_height", "axle", "brake_share", "drive_share"});
    const Unit& length = defs.units.length;
    const auto drive = field.optional("drive_share");
    return {.wheelbase = above_zero(field.require("wheelbase"), "not a wheelbase", length),
            .cg_height = above_zero(field.require("cg_height"), "not a height", length),
            .axle = field.require("axle").one_of("an axle", {"front", "rear"}) == 0 ? Axle::front
                                                                                    : Axle::rear,
            .brake_share = share(field.require("brake_share")),
            .drive_share = drive ? share(*drive) : 0};
}

}  // namespace elastocheck::reader
