// Gravity: a dead force m g at the centre of gravity of every body that has a mass.
#include <fmt/format.h>

#include <algorithm>

#include "models/reader/elements/sections.hpp"

namespace elastocheck::reader {
namespace {

Vector3 read_acceleration(const Cursor& field, const Definitions& defs) {
    const Vector3 g = vector(field, {"m/s²"});
    if (defs.mirror && g.y() != 0)
        field.fail(
            "has a y component, which is not symmetric; allowed in a scene with a mirror: [x, 0, "
            "z]");
    return g;
}

// [kg]; none if the body has no mass
std::optional<double> read_mass(const Cursor& body) {
    const auto mass = body.optional("mass");
    if (!mass) {
        if (const auto centre = body.optional("centre_of_gravity"))
            centre->fail(
                "centre of gravity of a body without mass; give its mass or remove this field");
        return std::nullopt;
    }
    const double m = mass->number("kg");
    if (m < 0) mass->fail(fmt::format("negative mass {}; allowed: zero or more", mass->found()));
    return m;
}

void add_weight(const Cursor& body, const Load& weight, Scene& scene) {
    if (std::ranges::find(scene.static_loads, weight.name, &Load::name) != scene.static_loads.end())
        body.fail(
            fmt::format("the load name '{}' is reserved for its weight, but already in use; rename "
                        "the other load",
                        weight.name));
    scene.static_loads.push_back(weight);
}

}  // namespace

void read_gravity(const Cursor& scene, const Definitions& defs, Scene& result) {
    const auto field = scene.optional("gravity");
    const Vector3 g = field ? read_acceleration(*field, defs) : Vector3::Zero();
    bool any_mass = false;
    for (const auto& [name, body_entry] : scene.require("bodies").entries()) {
        const auto mass = read_mass(body_entry);
        if (!mass) continue;
        any_mass = true;
        const BodyId id = defs.body_ids.at(name);
        const auto centre = body_entry.optional("centre_of_gravity");
        const Vector3 p = hardpoint(centre ? *centre : body_entry.require("origin"), defs);
        if (!field) {
            result.omitted.push_back({"mass of body '" + name + "'", "the scene has no gravity"});
            continue;
        }
        const Load weight{"gravity." + name, DeadForce{point_of(id, p, defs), *mass * g}};
        add_weight(body_entry, weight, result);
        if (const BodyId other = defs.twin_of[static_cast<std::size_t>(id)]; other != id)
            add_weight(body_entry,
                       {"gravity." + defs.bodies[static_cast<std::size_t>(other)].name,
                        twin(weight.kind, defs)},
                       result);
    }
    if (field && !any_mass) field->fail("has no effect: no body has a mass");
}

}  // namespace elastocheck::reader
