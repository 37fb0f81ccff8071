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
    model.wheels.push_back({"", 0, {0, 0.1, 0}, {0, 0.1, -0.3}, Vector3d(0, side, 0), side});
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
    const Model model = compile(support::scene("chrono_mcpherson"));
    const auto list = channels(model);
    EXPECT_EQ(list.size(), 6u + 6 * model.joints.size());
    EXPECT_EQ(list[0].name, "wheel_centre_x");
    EXPECT_STREQ(symbol(list[0].unit), "mm");
    EXPECT_EQ(list[6].name, "ball_joint.force_x");
    EXPECT_EQ(list[6].joints(), std::vector<int>{0});
    EXPECT_FALSE(list[6].main || list[6].kinematic());
}

TEST(Channels, EveryOneHasAUnitADefinitionAndANameOfItsOwn) {
    for (const auto& name : support::small_scene_names()) {
        const auto list = channels(compile(support::scene(name)));
        for (std::size_t c = 0; c < list.size(); ++c) {
            EXPECT_GT(list[c].definition.size(), 20u) << list[c].name;
            EXPECT_STRNE(symbol(list[c].unit), "-") << list[c].name;
            EXPECT_EQ(find_channel(list, list[c].name), static_cast<int>(c));
            const bool signed_one = list[c].definition.find("positive") != std::string::npos ||
                                    list[c].definition.find("right-handed") != std::string::npos;
            EXPECT_TRUE(signed_one) << list[c].name << ": " << list[c].definition;
        }
        EXPECT_EQ(find_channel(list, "nobody"), -1);
    }
}

TEST(Channels, OfSeveralWheelsCarryTheWheelsName) {
    auto [model, state] = wheel(1, about(Vector3d::UnitZ(), -2));
    model.bodies.push_back({"other", {}});
    model.wheels.push_back({"right", 1, {0, -0.1, 0}, {0, -0.1, -0.3}, Vector3d(0, -1, 0), -1});
    model.wheels.front().name = "left";
    state.poses.push_back({Vector3d(0, 0, 0.02), about(Vector3d::UnitZ(), 1)});
    EXPECT_NEAR(value(model, state, "left.toe"), 2, 1e-12);
    EXPECT_NEAR(value(model, state, "right.toe"), 1, 1e-12);
    EXPECT_NEAR(value(model, state, "right.travel"), 20, 1e-12);
    EXPECT_NEAR(value(model, state, "left.travel"), 3000, 1e-12);
    EXPECT_EQ(find_channel(channels(model), "toe"), -1);
}

TEST(Travel, CountsFromTheDesignPositionUpwards) {
    auto [model, state] = wheel(1, Eigen::Quaterniond::Identity());
    model.bodies[0].design.r = Vector3d(1, 2, 2.5);
    EXPECT_NEAR(value(model, state, "travel"), 500, 1e-9);
    EXPECT_NEAR(value(model, design_state(model), "travel"), 0, 0);
    // What it counts from turns with the design pose too.
    model.bodies[0].design.p = about(Vector3d::UnitX(), 90);
    EXPECT_NEAR(value(model, state, "travel"), 400, 1e-9);
}

// A body that a jack holds, a drive turns and a rod pulls.
struct Driven {
    Model model;
    Equilibrium state;
    Driven(const ConstraintKind& kind, const Wrench& on_i) {
        model.bodies = {{"i", {}}, {"j", {}}};
        model.joints.push_back({"drive", 0, 1, {0, {0, 0, 0}}, 0, false});
        model.constraints.push_back({0, kind});
        model.branches.push_back({.name = "", .to = 1, .steps = 1, .drivers = {{Motion{0}, 0, 1}}});
        state.poses = {{Vector3d(1, 0, 0), about(Vector3d::UnitX(), 30)},
                       {Vector3d(0, 0, 0), about(Vector3d::UnitX(), 90)}};
        state.reactions.push_back(on_i);
    }
};

TEST(Effort, TimesTheChangeOfTheOffsetIsTheWorkOfTheDriver) {
    // A rod between the origins, pushing them apart with 5 N; a plane whose normal is z of body j, which is
    // -y of the ground; and an angle about x.
    const Driven rod(DistanceBetween{Point{0}, Point{1}, 1}, {Vector3d(5, 0, 0), Vector3d::Zero()});
    EXPECT_NEAR(value(rod.model, rod.state, "drive.drive_force"), 5, 1e-12);
    const Driven plane(PointInPlane{Point{0}, Point{1}, {1, {0, 0, 1}}, 0},
                       {Vector3d(1, 7, 2), Vector3d::Zero()});
    EXPECT_NEAR(value(plane.model, plane.state, "drive.drive_force"), -7, 1e-12);
    const Driven angle(DirectionAtAngle{{0, {0, 1, 0}}, {1, {0, 1, 0}}, {1, {0, 0, 1}}, 0},
                       {Vector3d::Zero(), Vector3d(3, 4, 5)});
    EXPECT_NEAR(value(angle.model, angle.state, "drive.drive_moment"), 3, 1e-12);
    // Where nothing moves the joint its effort is no output; where it does not stand it is zero.
    Model nobody = rod.model;
    nobody.branches.clear();
    EXPECT_EQ(find_channel(channels(nobody), "drive.drive_force"), -1);
    Model gone = rod.model;
    gone.joints[0].driven = -1;
    const auto list = channels(rod.model);
    EXPECT_EQ(
        evaluate(gone, std::vector{list[static_cast<std::size_t>(find_channel(list, "drive.drive_force"))]},
                 rod.state),
        std::vector<double>{0});
}

TEST(Totals, AddUpTheWrenchesOnOneBodyAboutOnePoint) {
    Model model;
    model.bodies = {{"arm", {}}, {"knuckle", {}}};
    model.joints = {{"front", 0, ground, {0, {1, 0, 0}}},
                    {"rear", ground, 0, {ground, {-1, 0, 0}}},
                    {"other", 0, 1, {0, {0, 0, 0}}}};
    Equilibrium state = design_state(model);
    state.reactions[0].force = {0, 0, 10};
    state.reactions[1].force = {0, 0, -4};  // on ground: +4 on the arm, 2 m behind the front joint
    const std::vector<std::vector<int>> groups{{0, 1}};
    const auto list = totals(model, groups);
    ASSERT_EQ(list.size(), 6u);  // the ground's share is the arm's, turned round
    EXPECT_EQ(list[2].name, "front+rear.force_z");
    const auto values = evaluate(model, list, state);
    EXPECT_NEAR(values[2], 14, 1e-12);
    EXPECT_NEAR(values[4], 8, 1e-12);  // (-2, 0, 0) x (0, 0, 4) = (0, 8, 0)
}

}  // namespace
}  // namespace elastocheck::compare
