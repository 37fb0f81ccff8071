// Reads springs given at the wheel: a rate of the vertical travel of one wheel, or, of an anti-roll bar,
// of the difference of the travels of two.
//
// The element is a bushing from ground (i) to the wheel centre (j), both markers at that centre in the
// design position, in ground axes, so that d_z is the travel of the wheel centre:
//
//   u(d_z) = ½ k d_z² + P d_z,   P the force that pushes the wheel down at the design position
//
// A bar [first, second] adds a body that slides along z and follows the height of the first wheel's
// centre. The bushing from this body to the second wheel's centre has the difference of the travels.
#include <fmt/format.h>

#include <map>

#include "models/reader/definitions/look_up.hpp"
#include "models/reader/elements/sections.hpp"

namespace elastocheck::reader {
namespace {

std::optional<Cursor> wheels_of_bar(const Cursor& spring) {
    const auto at = spring.optional("at_wheel");
    return at && at->is_list() ? at : std::nullopt;
}

const Wheel& wheel_called(const Cursor& at, const std::vector<Wheel>& wheels) {
    if (wheels.empty()) at.fail("the scene has no wheel; give wheel or wheels");
    if (wheels.size() == 1 && at.value->text == "true") return wheels.front();
    std::map<std::string, const Wheel*> names;
    for (const Wheel& wheel : wheels) names.emplace(wheel.name, &wheel);
    return *look_up(at, "wheel", names);
}

std::array<const Wheel*, 2> ends_of_bar(const Cursor& at, const std::vector<Wheel>& wheels) {
    const auto names = at.list(2, "wheels");
    const std::array ends{&wheel_called(names[0], wheels), &wheel_called(names[1], wheels)};
    if (ends[0] == ends[1]) at.fail("the same wheel twice; allowed: two different ones");
    return ends;
}

Vector3 centre_of(const Wheel& wheel, const std::vector<Body>& bodies) {
    return bodies[static_cast<std::size_t>(wheel.body)].design.r + wheel.centre_local;
}

}  // namespace

std::optional<Elastic> read_at_wheel(const std::string& name, const Cursor& cursor,
                                     const Definitions& defs, const std::vector<Wheel>& wheels) {
    const auto given = cursor.optional("at_wheel");
    if (!given) return std::nullopt;
    cursor.only_keys({"at_wheel", "rate", "preload"});
    const bool is_bar = given->is_list();
    const Wheel& wheel = is_bar ? *ends_of_bar(*given, wheels)[1] : wheel_called(*given, wheels);
    const BodyId on = is_bar ? defs.body_ids.at(name) : ground;
    LinearStiffness law;
    law.K(2, 2) = rate(cursor.require("rate"), defs.units.rate);
    Vector6 preload = Vector6::Zero();
    if (const auto field = cursor.optional("preload"))
        preload[2] = defs.units.force.si(field->number(defs.units.force.name));
    const Marker centre{wheel.body, wheel.centre_local};
    return Elastic{
        name, Bushing{.i = marker_of(on, centre_of(wheel, defs.bodies), Matrix3::Identity(), defs),
                      .j = centre,
                      .law = law,
                      .preload = preload}};
}

void add_bodies_of_bars(const Cursor& scene, const std::vector<Wheel>& wheels, Definitions& defs) {
    const auto section = scene.optional("springs");
    if (!section) return;
    for (const auto& [name, spring] : section->entries()) {
        const auto bar = wheels_of_bar(spring);
        if (!bar) continue;
        if (defs.mirror && mirrored_name(*defs.mirror, name))
            bar->fail(fmt::format("a bar is between both sides, but its name has {}; rename it",
                                  quote(defs.mirror->from)));
        const BodyId body = static_cast<BodyId>(defs.bodies.size());
        if (!defs.body_ids.emplace(name, body).second)
            spring.fail(fmt::format("the bar's body is called {}, as another one; rename the bar",
                                    quote(name)));
        const Vector3 r = centre_of(*ends_of_bar(*bar, wheels)[0], defs.bodies);
        defs.bodies.push_back({name, {.r = r, .p = Quaternion::Identity()}});
        defs.twin_of.push_back(body);
    }
}

void add_joints_of_bars(const Cursor& scene, const Definitions& defs, Scene& result) {
    const auto section = scene.optional("springs");
    if (!section) return;
    for (const auto& [name, spring] : section->entries()) {
        const auto bar = wheels_of_bar(spring);
        if (!bar) continue;
        const Wheel& wheel = *ends_of_bar(*bar, result.wheels)[0];
        const BodyId body = defs.body_ids.at(name);
        const Vector3 r = defs.bodies[static_cast<std::size_t>(body)].design.r;
        const Direction up{body, Vector3::UnitZ()};
        const Point origin{body, Vector3::Zero()};
        add_joint(spring,
                  {name + ".slide", Translational{origin, {ground, r}, up, {ground, up.u_local}}},
                  result);
        add_joint(spring,
                  {name + ".height", InPlane{{wheel.body, wheel.centre_local}, origin, up, 0}},
                  result);
    }
}

}  // namespace elastocheck::reader
