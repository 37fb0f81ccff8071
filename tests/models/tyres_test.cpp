// Tyres: a vertical rate at the contact patch, and the road height as driver.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "tests/models/mistakes.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

// Two wheels, each on a suspension of one spring rate.
const std::string axle = R"(elastocheck: 1
name: wheels
units: {length: mm, angle: deg, force: kN}
mirror: left -> right
points: {hub_left: [0, 700, 300], patch_left: [5, 710, 0]}
bodies: {hub_left: {origin: hub_left}}
bushings: {strut_left: {bodies: [hub_left, ground], at: hub_left, rates: [9, 9, 0.02], rotational_rates: [9, 9, 9]}}
tyres:
  tyre_left: {wheel: left, rate: 0.2, preload: 3.5}
loads: {push_left: {on: hub_left, at: hub_left, force: [0, 0, 1]}}
branches:
  bump: {drive: [tyres.tyre_left.road, tyres.tyre_right.road], to: 50, steps: 5}
  roll: {drive: {tyres.tyre_left.road: 1, tyres.tyre_right.road: -1}, to: 50, steps: 5}
  load: {load: push_left, to: 1, steps: 5}
wheels: {left: {body: hub_left, centre: hub_left, contact_patch: patch_left, spin_axis: y, side: left}}
)";

const std::string single = R"(elastocheck: 1
name: wheel
units: {length: m, angle: deg, force: N}
points: {hub: [0, 0.7, 0.3]}
bodies: {hub: {origin: hub}}
bushings: {strut: {bodies: [hub, ground], at: hub, rates: [9, 9, 20e3], rotational_rates: [9, 9, 9]}}
tyres: {tyre: {rate: 200e3}}
branches: {bump: {drive: tyres.tyre.road, to: 0.05, steps: 5}}
wheel: {body: hub, centre: hub, spin_axis: y, side: left}
)";

const Bushing& tyre(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.elastics, name, &Elastic::name);
    EXPECT_NE(found, scene.elastics.end());
    EXPECT_TRUE(found->active_only_where_driven);
    return std::get<Bushing>(found->kind);
}

// Upward force of the tyre for a rise z of the patch and h of the road, on a branch that drives the
// road.
double push(const Scene& scene, const Driver& driver, double z, double h) {
    const auto& road = std::get<Preload>(driver.what);
    const auto& b =
        std::get<Bushing>(scene.elastics.at(static_cast<std::size_t>(road.elastic)).kind);
    const Vector6 e = z * Vector6::Unit(2);
    const Vector6 pulls_back =
        std::get<LinearStiffness>(b.law).K * e + b.preload + driver.rate * h * road.direction;
    EXPECT_TRUE((pulls_back.array() != 0).count() <= 1);
    return -pulls_back[2];
}

TEST(Tyre, PushesTheWheelUpByItsPreloadAndItsRateTimesTheHeightOfTheRoad) {
    const Scene scene = parse_scene(axle, "scene.yaml");
    for (const Driver& driver : scene.branches.at(0).drivers) {
        EXPECT_DOUBLE_EQ(push(scene, driver, 0, 0), 3500);
        EXPECT_DOUBLE_EQ(push(scene, driver, 0, 0.01), 3500 + 200e3 * 0.01);
        EXPECT_DOUBLE_EQ(push(scene, driver, 0.01, 0), 3500 - 200e3 * 0.01);
        EXPECT_DOUBLE_EQ(push(scene, driver, 0.01, 0.01), 3500);
    }
    EXPECT_EQ(scene.branches.at(0).unit, ParameterUnit::metre);
    EXPECT_DOUBLE_EQ(scene.branches.at(0).to, 0.05);
}

TEST(Tyre, StandsUnderTheContactPatchOfItsWheel) {
    const Scene scene = parse_scene(axle, "scene.yaml");
    for (const double side : {+1.0, -1.0}) {
        const Bushing& b = tyre(scene, side > 0 ? "tyre_left" : "tyre_right");
        EXPECT_EQ(b.i.body, ground);
        EXPECT_LE((b.i.s_local - Vector3d(0.005, side * 0.71, 0)).norm(), 1e-15);
        EXPECT_LE((b.j.s_local - Vector3d(0.005, side * 0.01, -0.3)).norm(), 1e-15);
        EXPECT_EQ(b.j.body, scene.wheels.at(side > 0 ? 0 : 1).body);
        EXPECT_EQ(scene.wheels.at(side > 0 ? 0 : 1).tyre_rate, 200e3);
    }
    const Scene one = parse_scene(single, "scene.yaml");
    EXPECT_EQ(one.wheels.at(0).tyre_rate, 200e3);
    EXPECT_EQ(tyre(one, "tyre").i.s_local, Vector3d(0, 0.7, 0.3));
}

TEST(Tyre, StandsOnlyOnTheBranchesThatMoveItsRoad) {
    const Model model = compile(parse_scene(axle, "scene.yaml"));
    for (const Branch& branch : model.branches) {
        const Model here = on_branch(model, branch);
        for (const Elastic& elastic : here.elastics)
            if (elastic.name.starts_with("tyre")) {
                const auto& law = std::get<LinearStiffness>(std::get<Bushing>(elastic.kind).law);
                EXPECT_EQ(law.K.isZero(0), branch.name == "load") << branch.name;
            }
    }
}

TEST(Tyre, StandsOnARoadThatIsHeldWhereItIs) {
    const Scene scene = parse_scene(
        replaced(single, "branches: {bump: {drive: tyres.tyre.road, to: 0.05, steps: 5}}",
                 "loads: {push: {on: hub, at: hub, force: [0, 0, 1]}}\n"
                 "branches: {up: {load: push, to: 50, steps: 5, hold: {tyres.tyre.road: 0}}}"),
        "scene.yaml");
    for (const Detail detail : {Detail::required, Detail::everything}) {
        const Model model = compile(scene, detail);
        const Model here = on_branch(model, model.branches.at(0));
        const auto tyre = std::ranges::find(here.elastics, "tyre", &Elastic::name);
        ASSERT_NE(tyre, here.elastics.end());
        EXPECT_EQ(std::get<LinearStiffness>(std::get<Bushing>(tyre->kind).law).K(2, 2), 200e3);
    }
}

TEST(Tyre, HasNoPreloadThatIsDrivenLikeABushings) {
    EXPECT_EQ(
        complaint_of(replaced(single, "drive: tyres.tyre.road", "drive: bushings.tyre.preload.z"))
            .substr(0, 65),
        "branches.bump.drive: 'bushings.tyre.preload.z' cannot be driven, ");
}

TEST(Tyre, SaysWhatIsWrong) {
    expect_complaints(
        axle,
        {{"wheel: left, ", "", "tyres.tyre_left.wheel: missing; this field is required"},
         {"wheel: left, ", "wheel: lift, ",
          "tyres.tyre_left.wheel: there is no wheel called 'lift', did you mean 'left'? defined: "
          "left, right"},
         {"rate: 0.2", "rate: 0", "tyres.tyre_left.rate: zero; a tyre needs a rate"},
         {"rate: 0.2", "rate: -1",
          "tyres.tyre_left.rate: negative rate '-1'; allowed: zero or more"},
         {"rate: 0.2", "rates: 0.2",
          "tyres.tyre_left: unknown field 'rates', did you mean 'rate'? allowed: wheel, rate, "
          "preload"},
         {"preload: 3.5}", "preload: 3.5}\n  spare_left: {wheel: left, rate: 1}",
          "tyres.spare_left: wheel 'left' has a tyre already; allowed: one"},
         {"  tyre_left:", "  tyre:",
          "tyres.tyre: the mirror generates a twin of its wheel but not of the tyre; both or "
          "neither must have 'left' in their name"}});
    expect_complaints(
        single, {{"{rate: 200e3}", "{wheel: hub, rate: 200e3}",
                  "tyres.tyre.wheel: the only wheel of the scene has no name; remove this field"},
                 {"wheel: {body: hub, centre: hub, spin_axis: y, side: left}",
                  "probes: {p: {on: hub, at: hub}}",
                  "tyres.tyre: the scene has no wheel; give wheel or wheels"}});
}

}  // namespace
}  // namespace elastocheck
