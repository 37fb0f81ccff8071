// Outputs of a scene without effect on the mechanics: steering axes, dampers, the vehicle.
#include <gtest/gtest.h>

#include <algorithm>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

const std::string strut = fixture("strut");

Scene parsed(const std::string& text) { return parse_scene(text, "scene.yaml"); }

Vector3d drawn(const Scene& scene, const Point& p) {
    return p.s_local + (p.body == ground
                            ? Vector3d::Zero().eval()
                            : scene.bodies.at(static_cast<std::size_t>(p.body)).design.r);
}

TEST(SteeringAxis, EachEndIsOnItsOwnBody) {
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

// A force at the patch acts on the rolling wheel; along x it is a brake's unless the car holds it.
TEST(Wheel, RollsIfThePatchIsBelowItsCentre) {
    const std::string loads =
        "loads: {push: {on: hub, at: hub, force: [0, 0, 1]}, up: {on: hub, at: patch, force: [0, "
        "1, "
        "1]}, brake: {on: hub, at: patch, force: [-1, 0, 0]}, drive: {on: hub, at: patch, force: "
        "[1, "
        "0, 0], torque: ground}}";
    const std::string rolling =
        replaced(replaced(strut, "loads: {push: {on: hub, at: hub, force: [0, 0, 1]}}", loads),
                 "branches: {up: {load: push,", "branches: {up: {load: [push, up, brake, drive],");
    for (const char* contact : {"", "contact: rolling, ", "contact: carrier, "}) {
        std::string text = replaced(rolling, "contact: carrier, ", contact);
        if (std::string(contact) == "contact: carrier, ")
            text = replaced(text, ", torque: ground", "");
        const Scene scene = parsed(text);
        const Wheel& wheel = scene.wheels.at(0);
        const bool rolls = std::string(contact) != "contact: carrier, ";
        EXPECT_EQ(wheel.rolls(), rolls);
        EXPECT_LE((drawn(scene, wheel.contact) - Vector3d(0, 0.71, 0)).norm(), 1e-16);
        EXPECT_EQ(scene.bodies.size(), rolls ? 3 : 2);
        const auto& drivers = scene.branches.at(0).drivers;
        const auto load = [&](std::size_t k) { return std::get<Load>(drivers.at(k).what).kind; };
        EXPECT_EQ(std::get<DeadForce>(load(0)).at.body, 0);
        EXPECT_EQ(std::get<DeadForce>(load(1)).at.body, wheel.contact.body);
        EXPECT_EQ(std::holds_alternative<BrakeForce>(load(2)), rolls);
        if (!rolls) continue;
        EXPECT_EQ(std::get<BrakeForce>(load(2)).body, 0);
        EXPECT_EQ(std::get<BrakeForce>(load(2)).patch.body, wheel.contact.body);
        EXPECT_EQ(std::get<DeadForce>(load(3)).at.body, wheel.contact.body);
    }
    const std::string aside = replaced(replaced(strut, "patch: [0, 710, 0]", "patch: [0, 800, 0]"),
                                       "contact: carrier, ", "");
    EXPECT_FALSE(parsed(aside).wheels.at(0).rolls());
}

TEST(Damper, IsDefinedByTwoPoints) {
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
TEST(Outputs, NumbersOfOutputsCanBeSet) {
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

TEST(Outputs, ModelHasTheOutputsOfItsScene) {
    for (const Detail detail : {Detail::required, Detail::everything}) {
        const Model model = compile(parsed(strut), detail);
        ASSERT_TRUE(model.wheels.at(0).steering_axis.has_value());
        EXPECT_EQ(model.wheels.at(0).steering_axis->upper.body, 1);
        EXPECT_EQ(model.dampers.size(), 1U);
        EXPECT_TRUE(model.vehicle.has_value());
    }
}

// A damper's end on a body merged into ground is on ground, and does not prevent the merge.
TEST(Outputs, BodyFixedToGroundIsMergedDespiteADamperOnIt) {
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

TEST(Outputs, ElementsKeepTheKindTheyWereWrittenAs) {
    const Scene scene = parsed(strut);
    const auto of = [&](const char* name) {
        return std::ranges::find(scene.elastics, name, &Elastic::name)->written_as;
    };
    EXPECT_EQ(of("coil"), WrittenAs::itself);
    EXPECT_EQ(of("coil.bump_stop"), WrittenAs::stop);
    EXPECT_EQ(of("mount"), WrittenAs::itself);
}

}  // namespace
}  // namespace elastocheck
