// Drivers and held values of a branch: joints created for them, signs, units, and lost drivers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elastocheck/compile.hpp"
#include "models/branch.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Two bodies, all kinds of driven joints, elements, a wheel. `branches` is the text of one
// or more branches.
std::string rig(const std::string& branches) {
    return replaced(fixture("rig"), "  up: {drive: travel, to: 1, steps: 1}", branches);
}

Scene parsed(const std::string& text) { return parse_scene(text, "rig.yaml"); }

const Joint& joint_of(const Scene& scene, const Driver& driver) {
    return scene.joints.at(static_cast<std::size_t>(std::get<Motion>(driver.what).joint));
}

TEST(Driven, TravelIsAJackUnderTheWheelCentre) {
    const Scene scene = parsed(rig("  up: {drive: travel, from: -80, to: 100, steps: 18}"));
    const Branch& branch = scene.branches.at(0);
    EXPECT_EQ(branch.unit, ParameterUnit::metre);
    EXPECT_EQ(branch.from, -0.08);
    EXPECT_EQ(branch.to, 0.1);
    ASSERT_EQ(branch.drivers.size(), 1U);
    EXPECT_EQ(branch.drivers[0].rate, 1);
    EXPECT_EQ(branch.drivers[0].start, 0);
    const Joint& joint = joint_of(scene, branch.drivers[0]);
    EXPECT_EQ(joint.name, "jack");
    EXPECT_TRUE(joint.active_only_where_driven);
    const auto& jack = std::get<InPlane>(joint.kind);
    EXPECT_EQ(jack.i.body, 1);
    EXPECT_EQ(jack.i.s_local, Vector3d::Zero());
    EXPECT_EQ(jack.j.body, ground);
    EXPECT_EQ(jack.j.s_local, Vector3d(0.1, 0.02, 0));
    EXPECT_EQ(jack.normal_j.u_local, Vector3d::UnitZ());
    EXPECT_EQ(jack.offset, 0);
}

TEST(Driven, PatchTravelIsAJackUnderTheContactPatch) {
    const Scene scene = parsed(rig("  up: {drive: patch_travel, to: 100, steps: 1}"));
    const Joint& joint = joint_of(scene, scene.branches.at(0).drivers.at(0));
    EXPECT_EQ(joint.name, "patch_jack");
    const auto& jack = std::get<InPlane>(joint.kind);
    EXPECT_EQ(jack.i.s_local, Vector3d(0, 0, -0.3));
    EXPECT_EQ(jack.j.s_local, Vector3d(0.1, 0.02, -0.3));
}

TEST(Driven, BranchesOfOneWheelShareItsJack) {
    const Scene scene = parsed(rig(R"(  a: {drive: travel, to: 100, steps: 1}
  b: {drive: travel, to: -100, steps: 1}
  c: {drive: patch_travel, to: 100, steps: 1, hold: {joints.slide: 2}})"));
    EXPECT_EQ(scene.joints.size(), 6U + 3U);
    EXPECT_EQ(joint_of(scene, scene.branches[0].drivers[0]).name,
              joint_of(scene, scene.branches[1].drivers[0]).name);
}

TEST(Driven, EachWheelHasItsOwnJack) {
    std::string text = rig("  up: {drive: [left.travel, right.patch_travel], to: 100, steps: 1}");
    text.replace(text.find("wheel: {body"), std::string::npos,
                 R"(wheels:
  left: {body: hub, centre: a, contact_patch: patch, contact: carrier, spin_axis: y, side: left}
  right: {body: arm, centre: o, spin_axis: -y, side: right}
)");
    const Scene scene = parsed(text);
    ASSERT_EQ(scene.wheels.size(), 2U);
    EXPECT_EQ(scene.wheels[0].name, "left");
    EXPECT_EQ(scene.wheels[1].name, "right");
    EXPECT_EQ(joint_of(scene, scene.branches[0].drivers[0]).name, "left.jack");
    EXPECT_EQ(joint_of(scene, scene.branches[0].drivers[1]).name, "right.patch_jack");
}

// Plane constraint n_j · (p_i - p_j) = offset: positive displacement moves i along the axis
// relative to j.
TEST(Driven, DisplacementOfASlideIsThatOfItsFirstBodyAlongTheAxis) {
    const Scene scene = parsed(rig("  out: {drive: joints.slide, to: 30, steps: 3}"));
    const Joint& joint = joint_of(scene, scene.branches.at(0).drivers.at(0));
    EXPECT_EQ(joint.name, "slide.drive");
    EXPECT_TRUE(joint.active_only_where_driven);
    const auto& drive = std::get<InPlane>(joint.kind);
    EXPECT_EQ(drive.i.body, 1);
    EXPECT_EQ(drive.j.body, 0);
    EXPECT_NEAR((drive.normal_j.u_local - Vector3d(0, 0.6, 0.8)).norm(), 0, 1e-16);
}

// u_i · (cos α y_j - sin α x_j) = 0 holds after rotating body i by α about the axis
// as written, right-handed.
TEST(Driven, AngleIsThatOfTheFirstBodyAboutTheAxisAsWritten) {
    const std::pair<const char*, Vector3d> joints[] = {{"hinge", Vector3d(1, 2, -2) / 3},
                                                       {"tube", {0, 0, -1}}};
    for (const auto& [name, axis] : joints) {
        const Scene scene =
            parsed(rig(fmt::format("  turn: {{drive: joints.{}, to: 90, steps: 3}}", name)));
        const Branch& branch = scene.branches.at(0);
        EXPECT_EQ(branch.unit, ParameterUnit::radian);
        EXPECT_DOUBLE_EQ(branch.to, std::numbers::pi / 2);
        const Joint& joint = joint_of(scene, branch.drivers.at(0));
        EXPECT_EQ(joint.name, std::string(name) + ".drive");
        const auto& drive = std::get<Angle>(joint.kind);
        EXPECT_NEAR(drive.j.u_local.dot(drive.y_j.u_local), 0, 1e-16);
        EXPECT_NEAR((drive.j.u_local.cross(drive.y_j.u_local) - axis).norm(), 0, 1e-15);
        for (const double alpha : {-2.0, -0.3, 0.0, 0.7, 3.0}) {
            const Vector3d u_i = AngleAxisd(alpha, axis) * drive.i.u_local;
            const auto Phi = [&](double a) {
                return u_i.dot(std::cos(a) * drive.y_j.u_local - std::sin(a) * drive.j.u_local);
            };
            EXPECT_NEAR(Phi(alpha), 0, 1e-15) << name;
            EXPECT_GT(
                u_i.dot(std::cos(alpha) * drive.j.u_local + std::sin(alpha) * drive.y_j.u_local),
                0.99);
        }
    }
}

TEST(Driven, RodLengthsAndPlaneOffsetsAreDrivenDirectly) {
    const Scene scene =
        parsed(rig("  out: {drive: {joints.rod: 1, joints.plane: -0.5}, to: 30, steps: 3}"));
    EXPECT_EQ(scene.joints.size(), 6U);
    const auto& drivers = scene.branches.at(0).drivers;
    EXPECT_EQ(joint_of(scene, drivers.at(0)).name, "rod");
    EXPECT_EQ(std::get<Distance>(joint_of(scene, drivers.at(0)).kind).length, 0.23);
    EXPECT_EQ(joint_of(scene, drivers.at(1)).name, "plane");
    EXPECT_EQ(drivers[1].rate, -0.5);
}

TEST(Driven, HeldJointsAreActiveOnEveryBranchAndCanBeDriven) {
    std::string text =
        rig("  up: {load: push, to: 100, steps: 1}\n  out: {drive: joints.slide, to: 9, steps: 3}");
    text.replace(text.find("axis: [0, 3, 4]"), 15, "axis: [0, 3, 4], held: true");
    const Scene scene = parsed(text);
    ASSERT_EQ(scene.joints.size(), 7U);
    EXPECT_EQ(scene.joints[6].name, "slide.drive");
    EXPECT_FALSE(scene.joints[6].active_only_where_driven);
    EXPECT_EQ(std::get<Motion>(scene.branches.at(1).drivers.at(0).what).joint, 6);
}

TEST(Driven, ElementsAreDrivenByFreeLengthOrPreload) {
    const Scene scene = parsed(rig(
        R"(  length: {drive: springs.coil.free_length, to: 20, steps: 1}
  force: {drive: springs.coil.preload, to: 200, steps: 1}
  rubber: {drive: {bushings.mount.preload.y: 2, bushings.mount.preload_moment.z: 3}, to: 10, steps: 1})"));
    const auto& b = scene.branches;
    EXPECT_EQ(std::get<FreeLength>(b[0].drivers[0].what).elastic, 0);
    EXPECT_EQ(b[0].to, 0.02);
    // P = k (ℓ₀ - ℓ): 200 N more require 200 / 40 = 5 mm more free length.
    EXPECT_EQ(b[1].unit, ParameterUnit::newton);
    EXPECT_DOUBLE_EQ(b[1].drivers[0].rate * b[1].to, 0.005);
    EXPECT_EQ(std::get<Preload>(b[2].drivers[0].what).direction, Vector6(Vector6::Unit(1)));
    EXPECT_EQ(b[2].drivers[0].rate, 2);
    EXPECT_EQ(std::get<Preload>(b[2].drivers[1].what).direction, Vector6(Vector6::Unit(5)));
    EXPECT_DOUBLE_EQ(b[2].drivers[1].rate, 0.003);  // 3 N·mm per N
}

TEST(Driven, PreloadOfALinearSpringWithLooseSeatsIsAFreeLength) {
    const Scene scene =
        parsed(replaced(rig("  force: {drive: springs.coil.preload, to: 200, steps: 1}"),
                        "rate: 40, preload", "rate: 40, seats: free, preload"));
    const Driver& driver = scene.branches.at(0).drivers.at(0);
    EXPECT_EQ(std::get<FreeLength>(driver.what).elastic, 0);
    EXPECT_DOUBLE_EQ(driver.rate * scene.branches[0].to, 0.005);
}

TEST(Driven, TheFirstQuantityGivesTheParameterItsUnit) {
    const Scene scene =
        parsed(rig("  both: {drive: {joints.hinge: 1, joints.slide: 0.5}, to: 90, steps: 1}"));
    const Branch& branch = scene.branches.at(0);
    EXPECT_EQ(branch.unit, ParameterUnit::radian);
    // 0.5 mm per degree, over 90 degrees
    EXPECT_DOUBLE_EQ(branch.drivers[1].rate * branch.to, 0.045);
}

TEST(Driven, HeldValuesAreStartValuesOfTheBranch) {
    const Scene scene = parsed(
        rig("  up: {drive: travel, to: 50, steps: 1, hold: {joints.slide: -12, joints.hinge: 90, "
            "springs.coil.preload: 400}, static_loads: {brake: 500, twist: 3000}}"));
    const auto& drivers = scene.branches.at(0).drivers;
    ASSERT_EQ(drivers.size(), 6U);
    for (std::size_t k = 1; k < 6; ++k) EXPECT_EQ(drivers[k].rate, 0);
    EXPECT_EQ(std::get<Load>(drivers[1].what).name, "brake");
    EXPECT_EQ(drivers[1].start, 500);
    EXPECT_EQ(drivers[2].start, 3);  // N·m
    EXPECT_EQ(drivers[3].start, -0.012);
    EXPECT_DOUBLE_EQ(drivers[4].start, std::numbers::pi / 2);
    EXPECT_DOUBLE_EQ(drivers[5].start, 0.01);
}

TEST(Driven, LoadsHaveWeights) {
    const Scene scene =
        parsed(rig("  up: {load: {push: 1, brake: 0.4, twist: -30}, to: 50, steps: 1, "
                   "static_loads: [push]}"));
    const auto& drivers = scene.branches.at(0).drivers;
    ASSERT_EQ(drivers.size(), 4U);
    EXPECT_EQ(drivers[1].rate, 0.4);
    EXPECT_EQ(drivers[2].rate, -30);
    EXPECT_EQ(std::get<DeadMoment>(std::get<Load>(drivers[2].what).kind).m,
              Vector3d(0, 0.001, 0));  // mm
    EXPECT_EQ(drivers[3].start, 1);
    EXPECT_EQ(scene.branches[0].unit, ParameterUnit::newton);
}

TEST(Branch, UnusedLoadsAreNamed) {
    const Scene scene =
        parsed(replaced(fixture("two_parts"), "load: push,", "load: push, static_loads: [lost],"));
    ASSERT_EQ(scene.omitted.size(), 1U);
    EXPECT_EQ(scene.omitted[0].what, "load 'spare'");
    EXPECT_EQ(scene.omitted[0].why, "no branch uses it");
    EXPECT_EQ(compile(scene).omitted.at(0).what, "load 'spare'");
}

// ---- The model on a branch.

TEST(BranchSides, DivideTheStepsAndKeepTheirNumber) {
    for (int steps = 2; steps < 40; ++steps)
        for (const double to : {0.001, 0.5, 1.0, 2.5, 70.0}) {
            Branch branch;
            branch.from = -1;
            branch.to = to;
            branch.steps = steps;
            const auto both = branch_sides(branch);
            ASSERT_EQ(both.size(), 2U);
            EXPECT_EQ(both[0].from, 0);
            EXPECT_EQ(both[0].to, -1);
            EXPECT_EQ(both[1].from, 0);
            EXPECT_EQ(both[1].to, to);
            EXPECT_GE(both[0].steps, 1);
            EXPECT_GE(both[1].steps, 1);
            EXPECT_EQ(both[0].steps + both[1].steps, steps);
            EXPECT_LE(std::abs(both[0].steps - steps / (1 + to)), 1);
        }
}

TEST(BranchSides, BranchFromZeroHasOneSide) {
    Branch branch;
    branch.to = -3;
    branch.steps = 7;
    ASSERT_EQ(branch_sides(branch).size(), 1U);
    EXPECT_EQ(branch_sides(branch)[0].to, -3);
    std::swap(branch.from, branch.to);
    ASSERT_EQ(branch_sides(branch).size(), 1U);
    EXPECT_EQ(branch_sides(branch)[0].from, 0);
    EXPECT_EQ(branch_sides(branch)[0].to, -3);
    EXPECT_EQ(branch_sides(branch)[0].steps, 7);
}

TEST(OnBranch, JackIsActiveOnlyWhereItIsDriven) {
    const Scene scene = parsed(
        rig("  load: {load: push, to: 9, steps: 1}\n  jack: {drive: travel, to: 9, steps: 1}\n"
            // in parallel with an inactive jack
            "  slide: {drive: joints.slide, to: 9, steps: 1}\n"
            "  both: {drive: joints.slide, to: 9, steps: 1, hold: {travel: 0}}"));
    const Model model = compile(scene);
    ASSERT_EQ(model.joints.size(), 8U);
    for (const Branch& branch : model.branches) {
        // else some constraints are inactive
        EXPECT_EQ(stands_on(model, branch), branch.name == "both") << branch.name;
        const Model here = on_branch(model, branch);
        EXPECT_TRUE(stands_on(here, branch)) << branch.name;
        ASSERT_EQ(here.branches.size(), 1U);
        EXPECT_EQ(here.branches[0].name, branch.name);
        ASSERT_EQ(here.joints.size(), model.joints.size());  // reactions keep their positions
        const int standing = branch.name == "load" ? 0 : branch.name == "both" ? 2 : 1;
        EXPECT_EQ(constraint_rows(here), constraint_rows(model) - 2 + standing) << branch.name;
        for (std::size_t k = 0; k < here.joints.size(); ++k) {
            const int driven = here.joints[k].driven;
            const bool stands = !model.joints[k].active_only_where_driven || driven >= 0;
            EXPECT_EQ(here.joints[k].name, model.joints[k].name);
            if (model.joints[k].driven < 0 || !stands) {
                EXPECT_EQ(driven, -1);
            } else {
                ASSERT_GE(driven, 0);
                ASSERT_LT(static_cast<std::size_t>(driven), here.constraints.size()) << branch.name;
                EXPECT_EQ(here.constraints[static_cast<std::size_t>(driven)].joint,
                          static_cast<int>(k));
            }
        }
        for (const Driver& driver : here.branches[0].drivers) {
            if (const auto* motion = std::get_if<Motion>(&driver.what)) {
                EXPECT_GE(here.joints[static_cast<std::size_t>(motion->joint)].driven, 0);
            }
        }
    }
}

TEST(OnBranch, BranchWithTwoSidesIsRejectedByTheLegs) {
    const Scene scene = parsed(rig("  up: {drive: travel, from: -9, to: 9, steps: 2}"));
    const Model model = compile(scene);
    EXPECT_FALSE(stands_on(model, model.branches[0]));
    for (const Branch& way : branch_sides(model.branches[0]))
        EXPECT_TRUE(stands_on(on_branch(model, way), way));
}

}  // namespace
}  // namespace elastocheck
