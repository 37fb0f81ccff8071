// Outputs of a scene without effect on the mechanics: steering axes, dampers, the vehicle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/models/mistakes.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

const std::string strut = R"(elastocheck: 1
name: strut
units: {length: mm, angle: deg, force: kN}
points: {ball: [-20, 600, 200], hub: [0, 700, 300], patch: [0, 710, 0], lower: [-10, 610, 500], top: [-30, 580, 900]}
bodies: {hub: {origin: hub}, rod: {origin: top}}
joints: {tube: {type: cylindrical, bodies: [hub, rod], at: lower, axis: [lower, top]}}
springs: {coil: {bodies: [hub, rod], from: lower, to: top, rate: 0.03, bump_stop: {clearance: 20, rate: 1}}}
bushings: {mount: {bodies: [rod, ground], at: top, rates: [9, 9, 9], rotational_rates: [9, 9, 9]}}
loads: {push: {on: hub, at: hub, force: [0, 0, 1]}}
branches: {up: {load: push, to: 1, steps: 5}}
wheel: {body: hub, centre: hub, contact_patch: patch, spin_axis: y, side: left, steering_axis: [ball, {on: rod, at: top}]}
dampers: {damper: {bodies: [hub, ground], from: lower, to: top}}
vehicle: {wheelbase: 2700, cg_height: 550, axle: rear, brake_share: 0.3, drive_share: 1}
)";

Scene parsed(const std::string& text) { return parse_scene(text, "scene.yaml"); }

Vector3d drawn(const Scene& scene, const Point& p) {
    return p.s_local + (p.body == ground
                            ? Vector3d::Zero().eval()
                            : scene.bodies.at(static_cast<std::size_t>(p.body)).design.r);
}

TEST(SteeringAxis, HasEachEndOnTheBodyWhereItSits) {
    const Scene scene = parsed(strut);
    const auto& axis = scene.wheels.at(0).steering_axis;
    ASSERT_TRUE(axis.has_value());
    EXPECT_EQ(axis->lower.body, 0);
    EXPECT_EQ(axis->upper.body, 1);
    EXPECT_LE((drawn(scene, axis->lower) - Vector3d(-0.02, 0.6, 0.2)).norm(), 1e-16);
    EXPECT_LE((drawn(scene, axis->upper) - Vector3d(-0.03, 0.58, 0.9)).norm(), 1e-16);

    const Scene fixed = parsed(replaced(strut, "{on: rod, at: top}]", "{on: ground, at: top}]"));
    EXPECT_EQ(fixed.wheels.at(0).steering_axis->upper.body, ground);
    EXPECT_EQ(fixed.wheels.at(0).steering_axis->upper.s_local, Vector3d(-0.03, 0.58, 0.9));
    EXPECT_FALSE(parsed(replaced(strut, ", steering_axis: [ball, {on: rod, at: top}]", ""))
                     .wheels.at(0)
                     .steering_axis);
}

TEST(Damper, IsTwoPoints) {
    const Scene scene = parsed(strut);
    const Damper& damper = scene.dampers.at(0);
    EXPECT_EQ(damper.name, "damper");
    EXPECT_EQ(damper.i.body, 0);
    EXPECT_EQ(damper.j.body, ground);
    EXPECT_LE((drawn(scene, damper.i) - Vector3d(-0.01, 0.61, 0.5)).norm(), 1e-16);
    EXPECT_EQ(damper.j.s_local, Vector3d(-0.03, 0.58, 0.9));
    EXPECT_TRUE(
        parsed(replaced(strut, "dampers: {damper: {bodies: [hub, ground], from: lower, to: top}}\n",
                        ""))
            .dampers.empty());
}

TEST(Vehicle, IsInTheUnitsOfTheScene) {
    const auto vehicle = parsed(strut).vehicle;
    ASSERT_TRUE(vehicle.has_value());
    EXPECT_DOUBLE_EQ(vehicle->wheelbase, 2.7);
    EXPECT_DOUBLE_EQ(vehicle->cg_height, 0.55);
    EXPECT_EQ(vehicle->axle, Axle::rear);
    EXPECT_EQ(vehicle->brake_share, 0.3);
    EXPECT_EQ(vehicle->drive_share, 1);
    EXPECT_EQ(parsed(replaced(strut, "axle: rear", "axle: front")).vehicle->axle, Axle::front);
}

// Numbers of outputs can be set like all others.
TEST(Outputs, TheirNumbersCanBeSet) {
    const Scene scene = parsed(strut);
    for (const char* path :
         {"vehicle.wheelbase", "vehicle.cg_height", "vehicle.brake_share", "vehicle.drive_share"})
        EXPECT_NE(std::ranges::find(scene.numbers, path, &Number::path), scene.numbers.end())
            << path;
    const Setting longer{"vehicle.wheelbase", "2900"}, higher{"points.top.z", "950"},
        other{"vehicle.axle", "front"};
    const Setting all[] = {longer, higher, other};
    const Scene set = parse_scene(strut, "scene.yaml", all);
    EXPECT_DOUBLE_EQ(set.vehicle->wheelbase, 2.9);
    EXPECT_EQ(set.vehicle->axle, Axle::front);
    EXPECT_DOUBLE_EQ(drawn(set, set.wheels.at(0).steering_axis->upper).z(), 0.95);
    EXPECT_DOUBLE_EQ(set.dampers.at(0).j.s_local.z(), 0.95);
}

TEST(Outputs, OfAModelAreThoseOfItsScene) {
    for (const Detail detail : {Detail::required, Detail::everything}) {
        const Model model = compile(parsed(strut), detail);
        ASSERT_TRUE(model.wheels.at(0).steering_axis.has_value());
        EXPECT_EQ(model.wheels.at(0).steering_axis->upper.body, 1);
        EXPECT_EQ(model.dampers.size(), 1U);
        EXPECT_TRUE(model.vehicle.has_value());
    }
}

// A damper's end on a body merged into ground is on ground, and does not prevent the merge.
TEST(Outputs, AnEndOfADamperDoesNotKeepABodyFromBeingGround) {
    const Scene scene = parsed(replaced(
        replaced(
            replaced(strut, "rod: {origin: top}}", "rod: {origin: top}, frame: {origin: top}}"),
            "joints: {", "joints: {weld: {type: fixed, bodies: [frame, ground], at: top}, "),
        "bodies: [hub, ground], from", "bodies: [hub, frame], from"));
    EXPECT_EQ(scene.dampers.at(0).j.body, 2);
    const Model model = compile(scene);
    EXPECT_EQ(model.bodies.size(), 2U);
    EXPECT_EQ(model.dampers.at(0).j.body, ground);
    EXPECT_LE((model.dampers.at(0).j.s_local - Vector3d(-0.03, 0.58, 0.9)).norm(), 1e-15);
}

TEST(Outputs, KnowWhatTheirElementsWereWrittenAs) {
    const Scene scene = parsed(strut);
    const auto of = [&](const char* name) {
        return std::ranges::find(scene.elastics, name, &Elastic::name)->written_as;
    };
    EXPECT_EQ(of("coil"), WrittenAs::itself);
    EXPECT_EQ(of("coil.bump_stop"), WrittenAs::stop);
    EXPECT_EQ(of("mount"), WrittenAs::itself);
}

TEST(Outputs, SayWhatIsWrong) {
    const std::string axis = "steering_axis: [ball, {on: rod, at: top}]",
                      missing = ": missing; this field is required";
    expect_complaints(
        strut,
        {{axis, "steering_axis: ball",
          "wheel.steering_axis: expected a list of 2 ends, the lower and the upper, found 'ball'"},
         {axis, "steering_axis: [ball]",
          "wheel.steering_axis: expected a list of 2 ends, the lower and the upper, found a list "
          "of 1"},
         {axis, "steering_axis: [ball, {on: ground, at: ball}]",
          "wheel.steering_axis: both ends are at the same position; an axis needs two different "
          "ones"},
         {axis, "steering_axis: [ball, tip]",
          "wheel.steering_axis: there is no hardpoint called 'tip', did you mean 'top'? defined: "
          "ball, hub, lower, patch, top"},
         {axis, "steering_axis: [ball, {on: rot, at: top}]",
          "wheel.steering_axis.on: there is no body called 'rot', did you mean 'rod'? defined: "
          "ground, hub, rod"},
         {axis, "steering_axis: [ball, {on: rod}]", "wheel.steering_axis.at" + missing},
         {axis, "steering_axis: [ball, {at: top}]", "wheel.steering_axis.on" + missing},
         {axis, "steering_axis: [ball, {of: rod, at: top}]",
          "wheel.steering_axis: unknown field 'of'; allowed: on, at"},
         {"{bodies: [hub, ground], from: lower, to: top}}",
          "{bodies: [hub, ground], from: top, to: top}}",
          "dampers.damper.to: the same position as `from`; a damper needs a length"},
         {"{bodies: [hub, ground], from: lower", "{bodies: [hub, hub], from: lower",
          "dampers.damper.bodies: both bodies are 'hub'; two different bodies are needed"},
         {"[hub, ground], from: lower, to: top}}", "[hub, ground], from: lower, to: top, rate: 3}}",
          "dampers.damper: unknown field 'rate'; allowed: bodies, from, to"},
         {"{damper: {bodies", "{coil: {bodies",
          "dampers.coil: a spring has the same name 'coil', and each has an output of that name; "
          "rename one of the two"},
         {"wheelbase: 2700, ", "", "vehicle.wheelbase" + missing},
         {"cg_height: 550, ", "", "vehicle.cg_height" + missing},
         {"axle: rear, ", "", "vehicle.axle" + missing},
         {"brake_share: 0.3, ", "", "vehicle.brake_share" + missing},
         {", drive_share: 1", "", "vehicle.drive_share" + missing},
         {"wheelbase: 2700", "wheelbase: 0",
          "vehicle.wheelbase: '0' is not a wheelbase; allowed: above zero"},
         {"wheelbase: 2700", "wheelbase: long",
          "vehicle.wheelbase: expected a number, found 'long'"},
         {"cg_height: 550", "cg_height: -1",
          "vehicle.cg_height: '-1' is not a height; allowed: above zero"},
         {"axle: rear", "axle: middle",
          "vehicle.axle: 'middle' is not an axle; allowed: front, rear"},
         {"brake_share: 0.3", "brake_share: 30",
          "vehicle.brake_share: '30' is not a share; allowed: 0 to 1"},
         {"drive_share: 1", "drive_share: -0.1",
          "vehicle.drive_share: '-0.1' is not a share; allowed: 0 to 1"},
         {"wheelbase: 2700", "wheel_base: 2700",
          "vehicle: unknown field 'wheel_base', did you mean 'wheelbase'? allowed: wheelbase, "
          "cg_height, "
          "axle, "
          "brake_share, drive_share"}});
    // A stop has no output of this name.
    EXPECT_EQ(complaint_of(replaced(strut, "{damper: {bodies", "{coil.bump_stop: {bodies")),
              "none");
}

}  // namespace
}  // namespace elastocheck
