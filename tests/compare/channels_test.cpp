// Output channels: wheel angles by definition, travel, units.
#include "elastocheck/channels.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "elastocheck/compile.hpp"
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

// A wheel on one body at the origin, rotated by `turn`.
std::pair<Model, Equilibrium> wheel(int side, const Eigen::Quaterniond& turn) {
    Model model;
    model.bodies.push_back({"wheel", {}});
    model.wheels.push_back({"", 0, {0, 0.1, 0}, {0, {0, 0.1, -0.3}}, Vector3d(0, side, 0), side});
    Equilibrium state;
    state.poses.push_back({Vector3d(1, 2, 3), turn});
    return {model, state};
}

Eigen::Quaterniond about(const Vector3d& axis, double degrees) {
    return Eigen::Quaterniond(AngleAxisd(degrees * std::numbers::pi / 180, axis));
}

TEST(Channels, ToeIsPositiveWhenTheFrontOfTheWheelTurnsInwards) {
    // Left wheel: toe-in turns its front to the right, clockwise from above, negative about z. The
    // right wheel the other way.
    for (const auto& [side, turn] : {std::pair{+1, -2.0}, std::pair{-1, +2.0}}) {
        const auto [model, state] = wheel(side, about(Vector3d::UnitZ(), turn));
        EXPECT_NEAR(value(model, state, "toe"), 2, 1e-12);
        EXPECT_NEAR(value(model, state, "camber"), 0, 1e-12);
    }
}

TEST(Channels, CamberIsPositiveWhenTheTopLeansOut) {
    // Left wheel: leaning out (to the left, +y) is a negative turn about x. The right wheel the
    // other way.
    for (const auto& [side, turn] : {std::pair{+1, -3.0}, std::pair{-1, +3.0}}) {
        const auto [model, state] = wheel(side, about(Vector3d::UnitX(), turn));
        EXPECT_NEAR(value(model, state, "camber"), 3, 1e-12);
        EXPECT_NEAR(value(model, state, "toe"), 0, 1e-12);
    }
}

TEST(Channels, SpinOfTheWheelDoesNotChangeItsOutputs) {
    const auto [model, state] = wheel(1, about(Vector3d::UnitY(), 77));
    EXPECT_NEAR(value(model, state, "toe"), 0, 1e-12);
    EXPECT_NEAR(value(model, state, "camber"), 0, 1e-12);
    EXPECT_NEAR(value(model, state, "wheel_centre_y"), 2100, 1e-9);
}

TEST(Channels, ListHasKinematicOutputsInMillimetresThenReactionsByJoint) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    const auto list = channels(model);
    // Centre, toe, camber, travel; patch position, track and wheelbase change; four of the steering
    // axis; spring and damper.
    const std::size_t kinematic = 6 + 5 + 4 + 2;
    EXPECT_EQ(list.size(), kinematic + 1 + 6 * model.joints.size());
    EXPECT_EQ(list[0].name, "wheel_centre_x");
    EXPECT_STREQ(symbol(list[0].unit), "mm");
    EXPECT_EQ(list[kinematic].name, "wheel_load");
    EXPECT_EQ(list[kinematic + 1].name, "ball_joint.force_x");
    EXPECT_EQ(list[kinematic + 1].joints(), std::vector<int>{0});
    for (std::size_t c = kinematic; c < list.size(); ++c)
        EXPECT_FALSE(list[c].main || list[c].kinematic()) << c;
    for (std::size_t c = 5; c < kinematic; ++c)
        EXPECT_TRUE(!list[c].main && list[c].kinematic()) << c;
}

TEST(Channels, EveryOutputHasAUnitADefinitionWithItsSignAndAUniqueName) {
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

TEST(Channels, OutputNamesContainTheWheelIfThereAreSeveral) {
    auto [model, state] = wheel(1, about(Vector3d::UnitZ(), -2));
    model.bodies.push_back({"other", {}});
    model.wheels.push_back(
        {"right", 1, {0, -0.1, 0}, {1, {0, -0.1, -0.3}}, Vector3d(0, -1, 0), -1});
    model.wheels.front().name = "left";
    state.poses.push_back({Vector3d(0, 0, 0.02), about(Vector3d::UnitZ(), 1)});
    EXPECT_NEAR(value(model, state, "left.toe"), 2, 1e-12);
    EXPECT_NEAR(value(model, state, "right.toe"), 1, 1e-12);
    EXPECT_NEAR(value(model, state, "right.travel"), 20, 1e-12);
    EXPECT_NEAR(value(model, state, "left.travel"), 3000, 1e-12);
    EXPECT_EQ(find_channel(channels(model), "toe"), -1);
}

TEST(Travel, IsPositiveUpwardsFromTheDesignPosition) {
    auto [model, state] = wheel(1, Eigen::Quaterniond::Identity());
    model.bodies[0].design.r = Vector3d(1, 2, 2.5);
    EXPECT_NEAR(value(model, state, "travel"), 500, 1e-9);
    EXPECT_NEAR(value(model, design_state(model), "travel"), 0, 0);
    // The reference direction rotates with the design pose too.
    model.bodies[0].design.p = about(Vector3d::UnitX(), 90);
    EXPECT_NEAR(value(model, state, "travel"), 400, 1e-9);
}

// ---- The steering axis is fixed to ground; the wheel rotates under it. In the design position
//
//   u = (-50, -50 side, 500) mm from l = (20, 600 side, 100): intersection with the road at
//   l - u/5 = (30, 610 side, 0), in front of the patch (0, 700 side, 0) by 30 and inboard by 90.
struct Steered {
    Model model;
    Equilibrium state;
    explicit Steered(int side, const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity()) {
        const auto at = [&](double x, double y, double z) { return Vector3d(x, side * y, z); };
        model.bodies.push_back({"wheel", {at(0, 0.7, 0), Eigen::Quaterniond::Identity()}});
        model.wheels.push_back({.name = "",
                                .body = 0,
                                .centre_local = at(0, 0, 0.3),
                                .contact = {0, Vector3d::Zero()},
                                .spin_axis_local = at(0, 1, 0),
                                .side = side});
        model.wheels[0].steering_axis = {{ground, at(0.02, 0.6, 0.1)},
                                         {ground, at(-0.03, 0.55, 0.6)}};
        state = design_state(model);
        state.poses[0].p = turn;
    }
    double operator[](const std::string& name) const { return value(model, state, name); }
};

TEST(SteeringAxis, CasterInclinationScrubRadiusAndTrailEqualHandCalculation) {
    for (const int side : {+1, -1}) {
        Steered drawn(side);
        for (int order = 0; order < 2; ++order) {  // exchanging the ends of the axis has no effect
            EXPECT_NEAR(drawn["caster"], std::atan(0.1) * 180 / std::numbers::pi, 1e-12);
            EXPECT_NEAR(drawn["kingpin_inclination"], std::atan(0.1) * 180 / std::numbers::pi,
                        1e-12);
            EXPECT_NEAR(drawn["scrub_radius"], 90, 1e-10);
            EXPECT_NEAR(drawn["mechanical_trail"], 30, 1e-10);
            auto& axis = *drawn.model.wheels[0].steering_axis;
            std::swap(axis.lower, axis.upper);
        }
    }
}

// Rotated about the vertical through its patch, the wheel carries the directions along
// and across it.
TEST(SteeringAxis, ScrubAndTrailAreMeasuredInAxesOfTheSteeredWheel) {
    for (const int side : {+1, -1})
        for (const double turn : {-35.0, -3.0, 20.0, 60.0}) {
            const Steered turned(side, about(Vector3d::UnitZ(), side * turn));
            const double c = std::cos(turn * std::numbers::pi / 180),
                         s = std::sin(turn * std::numbers::pi / 180);
            EXPECT_NEAR(turned["mechanical_trail"], 30 * c - 90 * s, 1e-10) << side << " " << turn;
            EXPECT_NEAR(turned["scrub_radius"], 90 * c + 30 * s, 1e-10) << side << " " << turn;
            EXPECT_NEAR(turned["caster"], std::atan(0.1) * 180 / std::numbers::pi, 1e-12);
        }
}

// The road is at the patch: raised by 50 mm, it meets the axis 5 mm further back and inboard.
TEST(SteeringAxis, ScrubAndTrailAreMeasuredAtTheHeightOfThePatch) {
    Steered risen(1);
    risen.state.poses[0].r.z() = 0.05;
    EXPECT_NEAR(risen["mechanical_trail"], 25, 1e-10);
    EXPECT_NEAR(risen["scrub_radius"], 95, 1e-10);
}

TEST(SteeringAxis, VerticalAxisHasZeroAnglesAndAHorizontalOneIsUndefined) {
    const char* names[] = {"caster", "kingpin_inclination", "scrub_radius", "mechanical_trail"};
    Steered upright(1);
    auto& axis = *upright.model.wheels[0].steering_axis;
    axis = {{ground, {0.01, 0.6, 0.1}}, {ground, {0.01, 0.6, 0.5}}};
    EXPECT_EQ(upright["caster"], 0);
    EXPECT_EQ(upright["kingpin_inclination"], 0);
    EXPECT_NEAR(upright["scrub_radius"], 100, 1e-10);
    EXPECT_NEAR(upright["mechanical_trail"], 10, 1e-10);
    for (const double slope : {0.0, 0.05, 0.099}) {  // [rad] to the road, along and across
        for (const bool along : {true, false}) {
            const Vector3d u(along ? std::cos(slope) : 0, along ? 0 : std::cos(slope),
                             std::sin(slope));
            axis.upper.s_local = axis.lower.s_local + 0.5 * u;
            for (const char* name : names)
                EXPECT_TRUE(std::isinf(upright[name])) << name << " " << slope;
        }
    }
    axis.upper.s_local = axis.lower.s_local + 0.5 * Vector3d(std::cos(0.101), 0, std::sin(0.101));
    for (const char* name : names) EXPECT_TRUE(std::isfinite(upright[name])) << name;
    upright.model.wheels[0].steering_axis.reset();
    for (const char* name : names) EXPECT_EQ(find_channel(channels(upright.model), name), -1);
}

TEST(ContactPatch, DisplacementIsPositiveOutwardsAndForALongerWheelbase) {
    for (const int side : {+1, -1})
        for (const Axle axle : {Axle::front, Axle::rear}) {
            Steered moved(side);
            moved.state.poses[0].r += Vector3d(0.003, 0.002 * side, 0.05);
            EXPECT_NEAR(moved["track_change"], 2, 1e-12);
            EXPECT_NEAR(moved["contact_patch_x"], 3, 1e-12);
            EXPECT_NEAR(moved["contact_patch_y"], 702 * side, 1e-10);
            EXPECT_NEAR(moved["contact_patch_z"], 50, 1e-12);
            EXPECT_EQ(find_channel(channels(moved.model), "wheelbase_change"), -1);
            moved.model.vehicle = Vehicle{.wheelbase = 2.7, .cg_height = 0.5, .axle = axle};
            EXPECT_NEAR(moved["wheelbase_change"], axle == Axle::front ? 3 : -3, 1e-12);
        }
}

// Two wheels with vertical axes j = 1.2 m apart and 0.1 m inboard of the patches,
// steered about them.
struct TwoSteered {
    Model model;
    Equilibrium state;
    explicit TwoSteered(double left, double right) {  // [deg], positive to the left
        for (const int side : {+1, -1}) {
            model.bodies.push_back({side > 0 ? "l" : "r",
                                    {Vector3d(0, side * 0.6, 0), Eigen::Quaterniond::Identity()}});
            model.wheels.push_back({.name = side > 0 ? "left" : "right",
                                    .body = side > 0 ? 0 : 1,
                                    .centre_local = Vector3d(0, side * 0.1, 0.3),
                                    .contact = {side > 0 ? 0 : 1, Vector3d(0, side * 0.1, 0)},
                                    .spin_axis_local = Vector3d(0, side, 0),
                                    .side = side});
            model.wheels.back().steering_axis = {{ground, {0, side * 0.6, 0.1}},
                                                 {ground, {0, side * 0.6, 0.5}}};
        }
        model.vehicle = Vehicle{.wheelbase = 2.7, .cg_height = 0.5, .axle = Axle::front};
        state = design_state(model);
        state.poses[0].p = about(Vector3d::UnitZ(), left);
        state.poses[1].p = about(Vector3d::UnitZ(), right);
    }
    double operator[](const std::string& name) const { return value(model, state, name); }
};

// Circle about a point on the rear-axle line, R to the left of the middle: tan δ = l / (R -+ j/2).
TEST(Ackermann, IsHundredPercentIfPerpendicularsMeetOnTheRearAxle) {
    const auto angle = [](double R, double y) {
        return std::atan(2.7 / (R - y)) * 180 / std::numbers::pi;
    };
    for (const double R : {4.0, 10.0, -5.0, -30.0}) {
        const TwoSteered round(angle(R, 0.6), angle(R, -0.6));
        EXPECT_NEAR(round["ackermann"], 100, 1e-9) << R;
    }
    for (const double both : {2.5, 20.0, -7.0})
        EXPECT_NEAR(TwoSteered(both, both)["ackermann"], 0, 1e-9);
    EXPECT_LT(TwoSteered(19, 20)["ackermann"], -1);  // the outer wheel turns more
    EXPECT_LT(TwoSteered(-20, -19)["ackermann"], -1);
}

TEST(Ackermann, IsUndefinedUnlessBothWheelsSteerInOneDirection) {
    for (const auto& [left, right] :
         {std::pair{0.0, 0.0}, {1.9, 5.0}, {5.0, 1.9}, {3.0, -3.0}, {-4.0, 6.0}})
        EXPECT_TRUE(std::isinf(TwoSteered(left, right)["ackermann"])) << left << " " << right;
    TwoSteered rear(10, 12);
    rear.model.vehicle->axle = Axle::rear;
    EXPECT_EQ(find_channel(channels(rear.model), "ackermann"), -1);
    rear.model.vehicle.reset();
    EXPECT_EQ(find_channel(channels(rear.model), "ackermann"), -1);
}

TEST(Track, IsTheLateralDistanceOfOppositeContactPatches) {
    TwoSteered axle(0, 0);
    EXPECT_NEAR(axle["track"], 1400, 1e-10);
    axle.state.poses[0].r.y() += 0.004;
    axle.state.poses[1].r.y() += 0.001;
    EXPECT_NEAR(axle["track"], 1403, 1e-10);
    EXPECT_NEAR(axle["left.track_change"], 4, 1e-10);
    EXPECT_NEAR(axle["right.track_change"], -1, 1e-10);
    std::swap(axle.model.wheels[0], axle.model.wheels[1]);
    EXPECT_NEAR(axle["track"], 1403, 1e-10);
    axle.model.wheels[0].side = axle.model.wheels[1].side;
    EXPECT_EQ(find_channel(channels(axle.model), "track"), -1);
}

TEST(Compression, IsTheDesignLengthMinusTheLength) {
    Model model;
    model.bodies.push_back({"arm", {}});
    const AxialSpring coil{{0, {0.3, 0, 0}}, {ground, {0.3, 0, 0.5}}, LinearRate{1e4}, 0.6};
    model.elastics = {
        {"coil", coil}, {"coil.bump_stop", coil, false, WrittenAs::stop}, {"rubber", Bushing{}}};
    model.dampers = {{"damper", {0, {0.3, 0, 0}}, {ground, {0.3, 0.4, 0}}}};
    Equilibrium state = design_state(model);
    EXPECT_EQ(value(model, state, "coil.compression"), 0);
    state.poses[0].r = Vector3d(0, 0.1, 0.1);
    EXPECT_NEAR(value(model, state, "coil.compression"), 500 - 1e3 * std::hypot(0.4, 0.1), 1e-10);
    EXPECT_NEAR(value(model, state, "damper.compression"), 400 - 1e3 * std::hypot(0.3, 0.1), 1e-10);
    const auto list = channels(model);
    EXPECT_EQ(find_channel(list, "coil.bump_stop.compression"), -1);
    EXPECT_EQ(find_channel(list, "rubber.compression"), -1);
}

// A body held by a jack, rotated by a drive and pulled by a rod.
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

TEST(DriveEffort, IsTheReactionAlongTheDrivenMotionOfRodPlaneAndAngle) {
    // A rod between the origins, pushing them apart with 5 N; a plane whose normal is z of body j,
    // which is -y of the ground; and an angle about x.
    const Driven rod(DistanceBetween{Point{0}, Point{1}, 1}, {Vector3d(5, 0, 0), Vector3d::Zero()});
    EXPECT_NEAR(value(rod.model, rod.state, "drive.drive_force"), 5, 1e-12);
    const Driven plane(PointInPlane{Point{0}, Point{1}, {1, {0, 0, 1}}, 0},
                       {Vector3d(1, 7, 2), Vector3d::Zero()});
    EXPECT_NEAR(value(plane.model, plane.state, "drive.drive_force"), -7, 1e-12);
    const Driven angle(DirectionAtAngle{{0, {0, 1, 0}}, {1, {0, 1, 0}}, {1, {0, 0, 1}}, 0},
                       {Vector3d::Zero(), Vector3d(3, 4, 5)});
    EXPECT_NEAR(value(angle.model, angle.state, "drive.drive_moment"), 3, 1e-12);
    // The effort is no output for a joint that nothing moves, and zero for an inactive joint.
    Model nobody = rod.model;
    nobody.branches.clear();
    EXPECT_EQ(find_channel(channels(nobody), "drive.drive_force"), -1);
    Model gone = rod.model;
    gone.joints[0].driven = -1;
    const auto list = channels(rod.model);
    EXPECT_EQ(evaluate(gone,
                       std::vector{
                           list[static_cast<std::size_t>(find_channel(list, "drive.drive_force"))]},
                       rod.state),
              std::vector<double>{0});
}

TEST(ReactionTotals, SumTheWrenchesOfTwoJointsOnABodyAboutOnePoint) {
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
    ASSERT_EQ(list.size(), 6u);  // the total on ground is that of the arm, reversed
    EXPECT_EQ(list[2].name, "front+rear.force_z");
    const auto values = evaluate(model, list, state);
    EXPECT_NEAR(values[2], 14, 1e-12);
    EXPECT_NEAR(values[4], 8, 1e-12);  // (-2, 0, 0) x (0, 0, 4) = (0, 8, 0)
}

}  // namespace
}  // namespace elastocheck::compare
