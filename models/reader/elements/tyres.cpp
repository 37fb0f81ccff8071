// Reads tyres: a vertical rate at the contact patch, which only pushes.
//
// The element is a bushing from ground (i) to the contact patch (j), both markers at the patch in the
// design position, in ground axes; d_z is the rise of the patch. With the road raised by h the tyre
// pushes the wheel up with P - k (d_z - h), or not at all where that is negative:
//
//   u'(x) = k min(x, 0),  x = d_z - e₀,  e₀ = P/k + h.
//
// A branch raises the road by driving e₀, the undeformed d_z.
#include <fmt/format.h>

#include <algorithm>

#include "models/reader/definitions/look_up.hpp"
#include "models/reader/elements/sections.hpp"

namespace elastocheck::reader {
namespace {

std::size_t wheel_of(const Cursor& tyre, const Scene& scene) {
    if (scene.wheels.empty()) tyre.fail("the scene has no wheel; give wheel or wheels");
    const auto named = tyre.optional("wheel");
    if (scene.wheels.front().name.empty()) {  // the short form
        if (named) named->fail("the only wheel of the scene has no name; remove this field");
        return 0;
    }
    std::map<std::string, std::size_t> wheels;
    for (std::size_t k = 0; k < scene.wheels.size(); ++k) wheels.emplace(scene.wheels[k].name, k);
    return look_up(tyre.require("wheel"), "wheel", wheels);
}

struct Tyre {
    std::size_t wheel = 0;
    double k = 0;  // [N/m] > 0
    double P = 0;  // force that pushes the wheel up at the design position [N]
};

Bushing bushing(const Tyre& tyre, const Wheel& wheel, const Definitions& defs) {
    const auto& [on, s_local] = wheel.contact;
    const Vector3& r = defs.bodies[static_cast<std::size_t>(on)].design.r;
    PerAxis law;
    law.axis[2] = Curve{.knots = {0}, .pieces = {{0, tyre.k, 0, 0}, {0, 0, 0, 0}}};
    return {.i = {ground, r + s_local},
            .j = {on, s_local},
            .law = law,
            .undeformed = tyre.P / tyre.k * Vector6::Unit(2)};
}

void add_tyre(const Cursor& field, const std::string& name, const Tyre& tyre,
              const Definitions& defs, Drivables& drivables, Scene& scene) {
    Wheel& above = scene.wheels[tyre.wheel];
    if (above.tyre_rate != 0)
        field.fail(fmt::format("wheel {} has a tyre already; allowed: one", quote(above.name)));
    above.tyre_rate = tyre.k;
    const int id = static_cast<int>(scene.elastics.size());
    scene.elastics.push_back({name, bushing(tyre, above, defs), true, WrittenAs::tyre});
    drivables.table["tyres." + name + ".road"] = {ParameterUnit::metre, defs.units.length,
                                                  FreeLength{id}, 1, std::nullopt};
}

}  // namespace

void read_tyres(const Cursor& scene, const Definitions& defs, Drivables& drivables, Scene& result) {
    const auto section = scene.optional("tyres");
    if (!section) return;
    for (const auto& [name, field] : section->entries()) {
        field.only_keys({"wheel", "rate", "preload"});
        const Cursor rate_field = field.require("rate");
        const auto preload = field.optional("preload");
        Tyre tyre{.wheel = wheel_of(field, result),
                  .k = rate(rate_field, defs.units.rate),
                  .P = preload ? defs.units.force.si(preload->number(defs.units.force.name)) : 0};
        if (tyre.k == 0) rate_field.fail("zero; a tyre needs a rate");
        add_tyre(field, name, tyre, defs, drivables, result);
        if (!defs.mirror) continue;
        const auto other = twin_name(*defs.mirror, name, *section);
        const auto other_wheel = mirrored_name(*defs.mirror, result.wheels[tyre.wheel].name);
        if (other.has_value() != other_wheel.has_value())
            field.fail(
                fmt::format("the mirror generates a twin of {} but not of {}; both or neither must "
                            "have {} in their name",
                            other ? "the tyre" : "its wheel", other ? "its wheel" : "the tyre",
                            quote(defs.mirror->from)));
        if (!other) continue;
        const auto there = std::ranges::find(result.wheels, *other_wheel, &Wheel::name);
        tyre.wheel = static_cast<std::size_t>(there - result.wheels.begin());
        add_tyre(field, *other, tyre, defs, drivables, result);
    }
}

}  // namespace elastocheck::reader
