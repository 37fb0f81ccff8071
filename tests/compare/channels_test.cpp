// Outputs: wheel angles by their definitions, travel, units.
#include "compare/channels.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "models/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

double value(const Model& model, const Equilibrium& state, const std::string& name) {
    const auto list = channels(model);
    const auto values = evaluate(model, state);
    EXPECT_EQ(list.size(), values.size());
    for (std::size_t c = 0; c < list.size(); ++c)
        if (list[c].name == name) return values[c];
    ADD_FAILURE() << "no channel " << name;
    return 0;
}

// A wheel on one body at the origin, turned by `turn`.
std::pair<Model, Equilibrium> wheel(int side, const Eigen::Quaterniond& turn) {
    Model model;
    model.bodies.push_back({"wheel", {}});
    model.wheel = Wheel{0, {0, 0.1, 0}, {0, 0.1, -0.3}, Vector3d(0, side, 0), side};
    Equilibrium state;
    state.poses.push_back({Vector3d(1, 2, 3), turn});
    return {model, state};
}

Eigen::Quaterniond about(const Vector3d& axis, double degrees) {
    return Eigen::Quaterniond(AngleAxisd(degrees * std::numbers::pi / 180, axis));
}

TEST(Channels, ToeIsPositiveWhenTheFrontOfTheWheelTurnsInwards) {
    // Left wheel: toe-in turns its front to the right, clockwise from above, negative about z. The right
    // wheel the other way.
    for (const auto& [side, turn] : {std::pair{+1, -2.0}, std::pair{-1, +2.0}}) {
        const auto [model, state] = wheel(side, about(Vector3d::UnitZ(), turn));
        EXPECT_NEAR(value(model, state, "toe"), 2, 1e-12);
        EXPECT_NEAR(value(model, state, "camber"), 0, 1e-12);
    }
}

TEST(Channels, CamberIsPositiveWhenTheTopLeansOut) {
    // Left wheel: leaning out (to the left, +y) is a negative turn about x. The right wheel the other way.
    for (const auto& [side, turn] : {std::pair{+1, -3.0}, std::pair{-1, +3.0}}) {
        const auto [model, state] = wheel(side, about(Vector3d::UnitX(), turn));
        EXPECT_NEAR(value(model, state, "camber"), 3, 1e-12);
        EXPECT_NEAR(value(model, state, "toe"), 0, 1e-12);
    }
}

TEST(Channels, WheelSpinChangesNothing) {
    const auto [model, state] = wheel(1, about(Vector3d::UnitY(), 77));
    EXPECT_NEAR(value(model, state, "toe"), 0, 1e-12);
    EXPECT_NEAR(value(model, state, "camber"), 0, 1e-12);
    EXPECT_NEAR(value(model, state, "wheel_centre_y"), 2100, 1e-9);
}

TEST(Channels, LengthsAreInMillimetresAndReactionsKeepTheirJoint) {
    const Model model = compile(support::scene("mcpherson"));
    const auto list = channels(model);
    EXPECT_EQ(list.size(), 5u + 6 * model.joints.size());
    EXPECT_EQ(list[0].name, "wheel_centre_x");
    EXPECT_STREQ(symbol(list[0].unit), "mm");
    EXPECT_EQ(list[5].name, "ball_joint.force_x");
    EXPECT_EQ(list[5].joint, 0);
    EXPECT_FALSE(list[5].main);
}

TEST(Travel, IsTheDisplacementOfTheWheelCentreAlongTheResultantForce) {
    auto [model, state] = wheel(1, Eigen::Quaterniond::Identity());
    Equilibrium moved = state;
    moved.poses[0].r += Vector3d(0.003, 0.004, 0.012);
    Branch branch{
        "", {{"", DeadForce{{0, {0, 0, 0}}, {3, 0, 0}}}, {"", DeadForce{{0, {1, 0, 0}}, {0, 4, 0}}}}, 1, 1};
    EXPECT_NEAR(curve(model, branch, {state, moved}).travel[1], 3 * 0.6 + 4 * 0.8, 1e-12);
    branch.loads = {{"", DeadMoment{0, {0, 0, 1}}}};
    EXPECT_TRUE(curve(model, branch, {state, moved}).travel.empty());
}

}  // namespace
}  // namespace elastocheck::compare
