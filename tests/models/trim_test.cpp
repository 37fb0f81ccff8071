// The trim of a scene file: adjustments, conditions, loads.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elastocheck/read_scene.hpp"
#include "tests/models/mistakes.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

const std::string scene_text = R"(elastocheck: 1
name: trimmed
units: {length: mm, angle: deg, force: kN}
points: {o: [0, 0, 0], a: [100, 20, 0], b: [0, 200, 50], c: [30, 40, 500]}
bodies: {arm: {origin: o}, hub: {origin: a}}
joints:
  hinge: {type: revolute, bodies: [arm, ground], at: o, axis: x}
  slide: {type: translational, bodies: [hub, arm], at: a, axis: [0, 3, 4], held: true}
  rod: {type: distance, bodies: [hub, ground], from: a, to: b}
springs:
  coil: {bodies: [hub, ground], from: a, to: c, rate: 40, preload: 3}
bushings:
  mount: {bodies: [arm, ground], at: o, rates: [1, 2, 3]}
tyres: {tyre: {rate: 5}}
loads:
  push: {on: hub, at: a, force: [0, 0, 1]}
  brake: {on: hub, at: b, force: [-1, 0, 0]}
  twist: {on: hub, moment: [0, 1, 0]}
trim:
  adjust: [springs.coil.preload, joints.rod]
  until: {travel: 5, tip.y: -7}
  under: {push: 3.5, twist: 2}
branches:
  out: {load: brake, to: 10, steps: 10}
wheel: {body: hub, centre: a, spin_axis: y, side: left}
probes: {tip: {on: hub, at: b}}
)";

Scene with(const std::string& right, const std::string& wrong) {
    return parse_scene(replaced(scene_text, right, wrong), "scene.yaml");
}

TEST(Trim, AdjustsWhatABranchWouldDrive) {
    const Scene scene = parse_scene(scene_text, "scene.yaml");
    ASSERT_TRUE(scene.trim.has_value());
    const Trim& trim = *scene.trim;
    EXPECT_EQ(trim.line, 19);
    ASSERT_EQ(trim.adjust.size(), 2U);
    EXPECT_EQ(trim.adjust[0].name, "springs.coil.preload");
    EXPECT_EQ(std::get<FreeLength>(trim.adjust[0].what).elastic, 0);
    EXPECT_EQ(trim.adjust[0].unit, ParameterUnit::newton);
    EXPECT_DOUBLE_EQ(trim.adjust[0].per_unit, 1 / 40e6);  // ΔP = k Δℓ₀
    EXPECT_EQ(std::get<Motion>(trim.adjust[1].what).joint, 2);
    EXPECT_EQ(trim.adjust[1].unit, ParameterUnit::metre);
    EXPECT_EQ(trim.adjust[1].per_unit, 1);
    const Scene held =
        with("[springs.coil.preload, joints.rod]", "[joints.slide, bushings.mount.preload.y]");
    const auto& drive = std::get<Motion>(held.trim->adjust.at(0).what);
    EXPECT_EQ(held.joints.at(static_cast<std::size_t>(drive.joint)).name, "slide.drive");
    EXPECT_EQ(std::get<Preload>(held.trim->adjust.at(1).what).direction, Vector6(Vector6::Unit(1)));
}

TEST(Trim, ConditionsAreInTheUnitsOfTheScene) {
    const Scene scene = parse_scene(scene_text, "scene.yaml");
    const auto& until = scene.trim->until;
    ASSERT_EQ(until.size(), 2U);
    EXPECT_EQ(until[0].name, "travel");
    EXPECT_EQ(std::get<WheelTravel>(until[0].what).wheel, 0);
    EXPECT_EQ(until[0].value, 0.005);
    EXPECT_EQ(std::get<ProbeCoordinate>(until[1].what).axis, 1);
    EXPECT_EQ(until[1].value, -0.007);
    const Scene angles = with("{travel: 5, tip.y: -7}", "{toe: 0.1, camber: -1}");
    EXPECT_TRUE(std::holds_alternative<WheelToe>(angles.trim->until.at(0).what));
    EXPECT_DOUBLE_EQ(angles.trim->until.at(0).value.value(), 0.1 * std::numbers::pi / 180);
    EXPECT_TRUE(std::holds_alternative<WheelCamber>(angles.trim->until.at(1).what));
}

TEST(Trim, AListOfConditionsMeansAsDrawn) {
    for (const char* list : {"[travel, toe]", "[toe, tip.x]"}) {
        const Scene scene = with("{travel: 5, tip.y: -7}", list);
        for (const auto& condition : scene.trim->until)
            EXPECT_FALSE(condition.value.has_value()) << list;
    }
}

TEST(Trim, ItsLoadsAreHeldOnEveryBranch) {
    const Scene scene = parse_scene(scene_text, "scene.yaml");
    ASSERT_EQ(scene.static_loads.size(), 2U);
    EXPECT_EQ(scene.static_loads[0].name, "push");
    EXPECT_EQ(std::get<DeadForce>(scene.static_loads[0].kind).f, Vector3d(0, 0, 3500));
    EXPECT_EQ(std::get<DeadMoment>(scene.static_loads[1].kind).m, Vector3d(0, 2, 0));  // kN·mm
    EXPECT_TRUE(scene.omitted.empty()) << scene.omitted[0].what;
    EXPECT_TRUE(with("  under: {push: 3.5, twist: 2}\n", "").static_loads.empty());
    EXPECT_EQ(
        std::get<DeadForce>(with("{push: 3.5, twist: 2}", "[push]").static_loads.at(0).kind).f,
        Vector3d(0, 0, 1000));
}

TEST(Trim, IsOneOfSeveralWheelsByName) {
    std::string text = replaced(scene_text, "wheel: {body: hub,", "wheels:\n  front: {body: hub,");
    text = replaced(replaced(text, "{travel: 5, tip.y: -7}", "[front.travel, front.toe]"),
                    "{tyre: {rate", "{tyre: {wheel: front, rate");
    EXPECT_EQ(parse_scene(text, "scene.yaml").trim->until.at(1).name, "front.toe");
}

TEST(Trim, SaysWhatIsWrong) {
    const std::string adjust = "adjust: [springs.coil.preload, joints.rod]",
                      until = "until: {travel: 5, tip.y: -7}";
    const std::string outputs = "; allowed: camber, tip.x, tip.y, tip.z, toe, travel";
    const std::string driven =
        " is active only on the branches that drive it; allowed: elements and joints that are "
        "active on all branches";
    expect_complaints(
        scene_text,
        {{until, "until: travel", "trim: 2 adjusted, 1 condition: one more condition is needed"},
         {adjust, "adjust: joints.rod",
          "trim: 1 adjusted, 2 conditions: one more adjustment is needed"},
         {until, "until: [travel, toe, camber, tip.x]",
          "trim: 2 adjusted, 4 conditions: 2 more adjustments are needed"},
         {adjust,
          "adjust: [springs.coil.preload, joints.rod, bushings.mount.preload.x, "
          "bushings.mount.preload.y]",
          "trim: 4 adjusted, 2 conditions: 2 more conditions are needed"},
         {adjust + "\n", "\n", "trim.adjust: missing; this field is required"},
         {until + "\n", "\n", "trim.until: missing; this field is required"},
         {adjust, "adjust: []", "trim.adjust: empty; an adjusted quantity is needed"},
         {adjust, "adjust: {joints.rod: 1}",
          "trim.adjust: expected a name or a list of names, found a map; adjusted quantities have "
          "no values before the trim"},
         {adjust, "adjust: [joints.rod, joints.rod]", "trim.adjust: 'joints.rod' is listed twice"},
         {adjust, "adjust: [springs.coil.preload, springs.coil.free_length]",
          "trim.adjust: 'springs.coil.free_length' adjusts the same quantity as "
          "'springs.coil.preload'; allowed: once"},
         {adjust, "adjust: [push, joints.rod]",
          "trim.adjust: 'push' is a load, which cannot be adjusted; allowed: preloads, free "
          "lengths and offsets, named as in drive"},
         {adjust, "adjust: [travel, joints.rod]", "trim.adjust: 'travel'" + driven},
         {adjust, "adjust: [joints.hinge, joints.rod]", "trim.adjust: 'joints.hinge'" + driven},
         {adjust, "adjust: [tyres.tyre.road, joints.rod]",
          "trim.adjust: 'tyres.tyre.road'" + driven},
         {until, "until: {tow: 5, tip.y: -7}",
          "trim.until.tow: 'tow' cannot be a condition of a trim, did you mean 'toe'?" +
              outputs.substr(1)},
         {until, "until: {travel: much, tip.y: -7}",
          "trim.until.travel: expected a number, found 'much'"},
         {until, "until: [travel, travel]", "trim.until: 'travel' is listed twice"},
         {"{push: 3.5, twist: 2}", "{pusch: 3.5}",
          "trim.under.pusch: there is no load called 'pusch', did you mean 'push'? defined: brake, "
          "push, twist"},
         {"  under:", "  over:", "trim: unknown field 'over'; allowed: adjust, until, under"}});
    EXPECT_TRUE(
        complaint_of(replaced(scene_text, adjust, "adjust: [springs.coil.prelaod, joints.rod]"))
            .starts_with("trim.adjust: 'springs.coil.prelaod' cannot be driven, did you mean "
                         "'springs.coil.preload'? allowed: "));
}

}  // namespace
}  // namespace elastocheck
