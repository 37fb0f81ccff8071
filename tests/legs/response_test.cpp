// Linear response of a state to small disturbances, against slopes of the leg's own solutions and
// closed forms.
#include "tests/legs/legs.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::legs {
namespace {

using Eigen::VectorXd;

struct LinearResponse : LegTest {
    Equilibrium end_of(const SideModel& side) const { return solved(leg(), side, 1).points.back(); }
    Response respond(const SideModel& side, const Equilibrium& state, const Disturbance& d) const {
        return linear_response(leg(), side, poses_only(state), d);
    }
    VectorXd one(const SideModel& side, const Equilibrium& state, const Disturbance& d) const {
        const Response response = respond(side, state, d);
        EXPECT_EQ(response.outcome, Outcome::converged) << response.detail;
        return response.increments.size() == 1 ? stacked(response.increments[0])
                                               : VectorXd::Constant(6, NAN);
    }
    void expect_slope(const SideModel& side, const Disturbance& d, double h,
                      const std::string& where) const {
        const auto end = [&](const Model& m, const Branch& b) { return end_of({m, b}); };
        support::expect_slope(one(side, end_of(side), d), side, d, h, end, where);
    }
};
ELASTOCHECK_FOR(exact_legs, LinearResponse);

SideModel side_named(const char* scene, const char* branch, double to) {
    return support::side_named(support::scene(scene), branch, to);
}

TEST_P(LinearResponse, EqualsTheDerivativeOfTheLegsSolutionFarFromDesign) {
    const struct {
        const char *scene, *branch;
        double to;
    } all[] = {{"mcpherson_strut", "lateral", 1}, {"double_wishbone", "vertical", 1},
               {"double_wishbone", "travel", -1}, {"front_axle", "vertical", 1},
               {"front_axle", "parallel", -1},    {"semi_trailing_arm", "vertical", -1}};
    for (const auto& [scene, branch, to] : all) {
        if (leg().needs_energy() && std::string(scene) == "front_axle") continue;  // takes minutes
        const SideModel side = side_named(scene, branch, to);
        for (int k = 0; k < 3; ++k)
            expect_slope(side, at_wheel(side.model, Vector3d::Unit(k)), 400,
                         fmt::format("{}, {}, force {}", scene, branch, k));
        expect_slope(side, at_wheel(side.model, Vector3d::Zero(), Z), 100, scene);
    }
}

TEST_P(LinearResponse, EqualsTheDerivativeByADrivenOffset) {
    const char* all[][2] = {{"double_wishbone", "steering"},
                            {"semi_trailing_arm", "travel"},
                            {"front_axle", "parallel"}};
    for (const auto& [scene, branch] : all) {
        if (leg().needs_energy() && std::string(scene) == "front_axle") continue;
        const SideModel side = side_named(scene, branch, 1);
        for (std::size_t j = 0; j < side.model.joints.size(); ++j)
            if (side.model.joints[j].driven >= 0)
                expect_slope(side, Motion{static_cast<int>(j)}, 0.004,
                             scene + side.model.joints[j].name);
    }
}

// Dead moments have no potential where bodies rotate; followers and formulations without energy
// have none at all.
TEST_P(LinearResponse, EqualsTheDerivativeUnderNonconservativeForces) {
    Scene twisted = support::scene("single_bushing");
    twisted.branches = {load_branch(DeadMoment{0, {200, -150, 120}}, 1)};
    for (int k = 0; k < 3; ++k)
        expect_slope(side_of(twisted), UnitWrench{{0, {0.2, 0, 0.1}}, Y, 3 * Vector3d::Unit(k)}, 8,
                     fmt::format("moment {}", k));
    const SideModel follower = side_named("follower", "up", 1),
                    angles = side_named("bushing_by_small_angles", "pull", 1);
    const UnitWrench push{{0, {0.3, 0, 0}}, {0.3, 0.2, 1}, {0.1, 0, 0}};
    if (leg().needs_energy()) {
        const Response response =
            respond(follower, {0, {follower.model.bodies[0].design}, {}, 0}, push);
        EXPECT_EQ(response.outcome, Outcome::not_conservative);
        EXPECT_TRUE(contains(response.detail, "load 'push' rotates with its body"))
            << response.detail;
        EXPECT_TRUE(response.increments.empty());
        return;
    }
    expect_slope(follower, push, 100, "follower");
    expect_slope(angles, UnitWrench{{0, {0.1, 0.05, -0.1}}, {0.3, 0.2, 1}, {0.1, 0, 0}}, 50,
                 "small angles");
}

// ---- Closed forms.

// tan θ = F/(k L); stiffness V'' = k L² cos θ + F L sin θ = k L² / cos θ. A force acts by its
// moment about the pin.
TEST_P(LinearResponse, PinnedBarEqualsItsClosedForm) {
    const SideModel side = side_named("pinned_bar", "up", 1);
    const double k = 20e3, L = 0.5, theta = std::atan(side.branch.to / (k * L));
    const Vector3d tip = L * Vector3d(std::cos(theta), 0, std::sin(theta)), f(0.7, -2, 1.3),
                   m(4, -3, 1);
    VectorXd expected = VectorXd::Zero(6);
    expected[4] = (tip.cross(f) + m).y() * std::cos(theta) / (k * L * L);
    EXPECT_LE(
        relative_distance(one(side, end_of(side), UnitWrench{{0, {L, 0, 0}}, f, m}), expected),
        1e-11);
}

// At rest: dr of the mount's centre is f/k, dπ = (s × f + m)/k_R.
TEST_P(LinearResponse, OffsetBushingEqualsItsClosedForm) {
    const SideModel side = side_named("single_bushing", "pull", 1);
    const Equilibrium state{0, {side.model.bodies[0].design}, {}, 0};
    const Vector3d s(0.2, -0.1, 0.3), f(0.7, -2, 1.3), m(0.4, -0.3, 0.1);
    VectorXd expected(6);
    expected << f.cwiseQuotient(Vector3d(2e5, 3e5, 5e5)),
        (s.cross(f) + m).cwiseQuotient(Vector3d(400, 500, 700));
    EXPECT_LE(relative_distance(one(side, state, UnitWrench{{0, s}, f, m}), expected), 1e-13);
}

// θ in the plane of the bar: V'' = k_R + F L sin θ at k_R θ = F L cos θ.
TEST_P(LinearResponse, PendulumEqualsItsClosedForm) {
    const SideModel side = side_named("pendulum", "up", 1);
    const double k_R = 600, L = 0.4, F = side.branch.to;
    double theta = 0.5;
    for (int i = 0; i < 50; ++i)
        theta -= (k_R * theta - F * L * std::cos(theta)) / (k_R + F * L * std::sin(theta));
    const double turn = L * std::cos(theta) / (k_R + F * L * std::sin(theta));
    const Vector3d along(0.8, 0.6, 0);
    VectorXd expected(6);
    expected << turn * L * (-std::sin(theta) * along + std::cos(theta) * Z), turn * along.cross(Z);
    EXPECT_LE(relative_distance(one(side, end_of(side), UnitWrench{{0}, Z}), expected), 1e-11);
}

// A slider between a spring along its guide and a taut one across it: its stiffness is k + T/l.
TEST_P(LinearResponse, TautSpringHasLateralStiffness) {
    const double k = 2000, l = 0.25, T = 900, rate = 5e4;
    Scene s;
    s.bodies = {{"slider", {}}};
    s.joints = {{"guide", Translational{{0}, {ground}, {0, X}, ground_x}}};
    s.elastics = {{"along", AxialSpring{{ground, -0.3 * X}, {0}, LinearRate{k}, 0.3}},
                  {"across", AxialSpring{{ground, -l * Y}, {0}, LinearRate{rate}, l - T / rate}}};
    s.branches = {load_branch(DeadForce{{0}, X}, 100)};
    s.probes = {{"slider", {0}}};
    const SideModel side = side_of(s);
    const Equilibrium state{0, {side.model.bodies[0].design}, {}, 0};
    EXPECT_NEAR(one(side, state, UnitWrench{{0}, X})[0] * (k + T / l), 1, 1e-13);
}

// Both ends of the coupler have equal velocity along it: ω c·e = a·e, with a and c the velocities
// of B and C at unit rates.
TEST_P(LinearResponse, FourBarCrankEqualsItsClosedForm) {
    const SideModel side = side_named("four_bar", "turn", 1);
    const auto path = solved(leg(), side, 9);
    for (const auto& state : path.points) {
        const auto& probes = side.model.probes;
        const Vector3d B = position(state, probes[0].at), C = position(state, probes[1].at),
                       D(0.1, 0, 0);
        VectorXd expected = VectorXd::Zero(12);
        expected[4] = 1;
        expected[10] = Y.cross(B).dot(C - B) / Y.cross(Vector3d(C - D)).dot(C - B);
        EXPECT_LE(relative_distance(one(side, state, std::get<Motion>(side.branch.drivers[0].what)),
                                    expected),
                  1e-11)
            << state.load;
    }
}

// ---- What is read, and what is refused.

TEST_P(LinearResponse, ReadsOnlyThePosesAndTheParameterOfAState) {
    const SideModel side = side_named("double_wishbone", "vertical", 1);
    Equilibrium state = end_of(side);
    const auto wheel = at_wheel(side.model, Y);
    const VectorXd with = one(side, state, wheel);
    for (Wrench& reaction : state.reactions) reaction.force.setConstant(NAN);
    const Response without = linear_response(leg(), side, state, wheel);
    EXPECT_EQ(stacked(without.increments.at(0)), with);
}

TEST_P(LinearResponse, LoadOnAnIdleModeIsReported) {
    const SideModel side = side_named("chrono_mcpherson", "jounce", 1);
    const Equilibrium state = end_of(side);
    for (std::size_t b = 0; b < side.model.bodies.size(); ++b) {
        const bool strut = side.model.bodies[b].name == "strut";
        const Response response =
            respond(side, state, UnitWrench{{static_cast<BodyId>(b)}, Vector3d::Zero(), Z});
        EXPECT_EQ(response.outcome, strut ? Outcome::loaded_idle_mode : Outcome::converged)
            << response.detail;
        EXPECT_EQ(contains(response.detail, "a wrench on 'strut'"), strut) << response.detail;
        EXPECT_EQ(response.increments.empty(), strut);
    }
}

TEST_P(LinearResponse, LimitPointHasNoResponse) {
    const SideModel side = side_named("two_spring_arch", "down", -1);
    const double b = 0.3, l_0 = std::hypot(b, 0.08), l = std::cbrt(l_0 * b * b),
                 z = std::sqrt(l * l - b * b);
    Equilibrium state{2 * 100e3 * (l - l_0) * z / l, {side.model.bodies[0].design}, {}, 0};
    state.poses[0].r.z() = z;
    const Response response = respond(side, state, UnitWrench{{0}, Z});
    EXPECT_EQ(response.outcome, Outcome::singular) << response.detail;
    EXPECT_TRUE(response.increments.empty());
}

TEST_P(LinearResponse, OffsetHeldByASecondJointIsInconsistent) {
    Scene s = hinged_bar(0.8 * X, Y, 0);
    s.elastics.clear();
    s.joints.push_back({"jack", InPlane{{0, {0.8, 0, 0}}, {ground}, ground_z}});
    s.joints.push_back({"stop", InPlane{{0, {0.8, 0.1, 0}}, {ground}, ground_z}});
    s.branches = {load_branch(DeadForce{{0, {0.8, 0, 0}}, Z}, 1)};
    const SideModel side = side_of(s);
    const Response response = respond(side, {0, {side.model.bodies[0].design}, {}, 0}, Motion{1});
    EXPECT_EQ(response.outcome, Outcome::inconsistent_constraints);
    EXPECT_TRUE(contains(response.detail, "moving 'jack'")) << response.detail;
}

TEST_P(LinearResponse, ConsistentRedundantJointsDoNotChangeTheResponse) {
    Scene once = support::scene("pinned_bar"), twice = once;
    twice.joints.push_back(
        {"second hinge", Revolute{{0, 0.3 * Y}, {ground, 0.3 * Y}, {0, Y}, ground_y}});
    const Equilibrium state = end_of(side_of(once));
    const UnitWrench lift{{0, 0.8 * X}, {0.2, 1, 1}, {1, 2, 3}};
    EXPECT_LE(relative_distance(one(side_of(twice), state, lift), one(side_of(once), state, lift)),
              1e-12);
}

TEST_P(LinearResponse, NonFiniteOrForeignInputIsRejected) {
    const SideModel side = side_named("double_wishbone", "vertical", 1);
    Equilibrium state = end_of(side);
    std::vector<Disturbance> wrong{UnitWrench{{ground}, X}, UnitWrench{{99}, X}, Motion{99},
                                   Motion{-1}};
    for (std::size_t j = 0; j < side.model.joints.size(); ++j)
        if (side.model.joints[j].driven < 0) wrong.push_back(Motion{static_cast<int>(j)});
    for (const Disturbance& d : wrong) EXPECT_THROW(respond(side, state, d), std::invalid_argument);
    const auto wheel = at_wheel(side.model, Y);
    state.poses[1].r.y() = NAN;
    EXPECT_EQ(respond(side, state, wheel).outcome, Outcome::not_finite);
    state.poses.pop_back();
    EXPECT_THROW(respond(side, state, wheel), std::invalid_argument);
}

}  // namespace
}  // namespace elastocheck::legs
