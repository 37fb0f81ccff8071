// Driven angles, and the model on a branch; other drivers and held values are in fixtures/rig.facts.
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

// u_i · (cos α y_j - sin α x_j) = 0 holds after rotating body i by α about the axis
// as written, right-handed.
TEST(DrivenAngle, IsThatOfTheFirstBodyAboutTheAxisAsWritten) {
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

// ---- The model on a branch.

TEST(BranchSides, StepsAreDividedByLengthAndKeepTheirSum) {
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

TEST(ModelOnABranch, JackIsActiveOnlyWhereItIsDriven) {
    const Scene scene = parsed(
        rig("  load: {load: push, to: 9, steps: 1}\n  jack: {drive: travel, to: 9, steps: 1}\n"
            // in parallel with an inactive jack
            "  slide: {drive: joints.slide, to: 9, steps: 1}\n"
            "  both: {drive: joints.slide, to: 9, steps: 1, hold: {travel: 0}}"));
    const Model model = compile(scene);
    ASSERT_EQ(model.joints.size(), 8U);
    for (const Branch& branch : model.branches) {
        // else some constraints are inactive
        EXPECT_EQ(fits_branch(model, branch), branch.name == "both") << branch.name;
        const Model here = on_branch(model, branch);
        EXPECT_TRUE(fits_branch(here, branch)) << branch.name;
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

TEST(ModelOnABranch, BranchWithTwoSidesIsRejectedByTheLegs) {
    const Scene scene = parsed(rig("  up: {drive: travel, from: -9, to: 9, steps: 2}"));
    const Model model = compile(scene);
    EXPECT_FALSE(fits_branch(model, model.branches[0]));
    for (const Branch& way : branch_sides(model.branches[0]))
        EXPECT_TRUE(fits_branch(on_branch(model, way), way));
}

}  // namespace
}  // namespace elastocheck
