// Forward sensitivity of the equilibrium leg: against slopes of its own solutions and closed forms.
#include "reference/equilibrium/linear_response.hpp"

#include <fmt/format.h>

#include "tests/reference/equilibrium/scenes.hpp"
#include "tests/support/slopes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

using Eigen::VectorXd;
using support::apart, support::at_wheel, support::bare, support::OneWay, support::stacked;

OneWay way_of(const char* file, const std::string& branch, double to) {
    return support::way_of(scene(file), branch, to);
}
Equilibrium end_of(const Model& model, const Branch& branch) {
    const auto path = solve(model, branch, std::vector{branch.to});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    return path.points.back();
}
Response ask(const OneWay& way, const Equilibrium& state, const Disturbance& disturbance) {
    return linear_response(way.model, way.branch, bare(state), {&disturbance, 1});
}
VectorXd one(const OneWay& way, const Equilibrium& state, const Disturbance& disturbance) {
    const Response response = ask(way, state, disturbance);
    EXPECT_EQ(response.outcome, Outcome::converged) << response.detail;
    return response.increments.empty() ? VectorXd::Constant(6, NAN)
                                       : stacked(response.increments[0]);
}
void expect_slope(const OneWay& way, const Disturbance& disturbance, double h,
                  const std::string& where) {
    support::expect_slope(one(way, end_of(way.model, way.branch), disturbance), way, disturbance, h,
                          end_of, where);
}

TEST(EquilibriumRespond, IsTheSlopeOfTheOwnSolutionFarFromDesign) {
    const struct {
        const char *scene, *branch;
        double to;
    } all[] = {{"mcpherson_strut", "lateral", 1},
               {"double_wishbone", "vertical", 1},
               {"front_axle", "parallel", -1},
               {"semi_trailing_arm", "vertical", -1}};
    for (const auto& [file, branch, to] : all) {
        const OneWay way = way_of(file, branch, to);
        for (int k = 0; k < 3; ++k)
            expect_slope(way, at_wheel(way.model, Vector3d::Unit(k)), 400,
                         fmt::format("{}, {}, force {}", file, branch, k));
        expect_slope(way, at_wheel(way.model, Vector3d::Zero(), Vector3d::UnitZ()), 100, file);
    }
}

TEST(EquilibriumRespond, IsTheSlopeOfTheOwnSolutionOverADrivenOffset) {
    const char* all[][2] = {{"double_wishbone", "steering"},
                            {"front_axle", "parallel"},
                            {"semi_trailing_arm", "travel"}};
    for (const auto& [file, branch] : all) {
        const OneWay way = way_of(file, branch, 1);
        for (std::size_t j = 0; j < way.model.joints.size(); ++j)
            if (way.model.joints[j].driven >= 0)
                expect_slope(way, Motion{static_cast<int>(j)}, 0.004,
                             file + way.model.joints[j].name);
    }
}

TEST(EquilibriumRespond, WhatHasNoEnergyAnswersAsItIsSolved) {
    const OneWay follower = way_of("follower", "up", 1),
                 bushing = way_of("bushing_by_small_angles", "pull", 1);
    expect_slope(follower, UnitWrench{{0, {0.3, 0, 0}}, {0.3, 0.2, 1}, {0.1, 0, 0}}, 100,
                 "follower");
    expect_slope(bushing, UnitWrench{{0, {0.1, 0.05, -0.1}}, {0.3, 0.2, 1}, {0.1, 0, 0}}, 50,
                 "small angles");
}

// tan θ = F/(k L); stiffness V'' = k L² cos θ + F L sin θ = k L² / cos θ. A force acts by its
// moment about the pin.
TEST(EquilibriumRespond, OfThePinnedBar) {
    const OneWay way = way_of("pinned_bar", "up", 1);
    const double k = 20e3, L = 0.5, theta = std::atan(way.branch.to / (k * L));
    const Equilibrium state = end_of(way.model, way.branch);
    const Vector3d tip = L * Vector3d(std::cos(theta), 0, std::sin(theta)), f(0.7, -2, 1.3),
                   m(4, -3, 1);
    const double turn = (tip.cross(f) + m).dot(-Vector3d::UnitY()) * std::cos(theta) / (k * L * L);
    VectorXd expected = VectorXd::Zero(6);
    expected[4] = -turn;
    EXPECT_LE(apart(one(way, state, UnitWrench{{0, {L, 0, 0}}, f, m}), expected), 1e-13);
}

// At rest: dr of the mount's centre f/k, dπ = (s × f + m)/k_R.
TEST(EquilibriumRespond, OfABushingAtAnOffset) {
    const OneWay way = way_of("single_bushing", "pull", 1);
    const Equilibrium state{0, {way.model.bodies[0].design}, {}, 0};
    const Vector3d s(0.2, -0.1, 0.3), f(0.7, -2, 1.3), m(0.4, -0.3, 0.1);
    VectorXd expected(6);
    expected << f.cwiseQuotient(Vector3d(2e5, 3e5, 5e5)),
        (s.cross(f) + m).cwiseQuotient(Vector3d(400, 500, 700));
    EXPECT_LE(apart(one(way, state, UnitWrench{{0, s}, f, m}), expected), 1e-13);
}

// Both ends of the coupler have equal velocity along it: ω c·e = a·e, with a and c the velocities
// of B and C at unit rates.
TEST(EquilibriumRespond, OfAFourBarsCrank) {
    const OneWay way = way_of("four_bar", "turn", 1);
    for (const double phi : {0.0, 0.7, 2.0, 4.5}) {
        const auto path = solve(way.model, way.branch, std::vector{phi});
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        const auto& probes = way.model.probes;
        const Vector3d B = position(path.points[0], probes[0].at),
                       C = position(path.points[0], probes[1].at), D(0.1, 0, 0),
                       y = Vector3d::UnitY();
        const double omega = y.cross(B).dot(C - B) / y.cross(Vector3d(C - D)).dot(C - B);
        VectorXd expected = VectorXd::Zero(12);
        expected[4] = 1;
        expected[10] = omega;
        EXPECT_LE(
            apart(one(way, path.points[0], std::get<Motion>(way.branch.drivers[0].what)), expected),
            1e-12)
            << phi;
    }
}

TEST(EquilibriumRespond, OnlyThePosesAndTheParameterOfAStateAreRead) {
    const OneWay way = way_of("double_wishbone", "vertical", 1);
    Equilibrium state = end_of(way.model, way.branch);
    const std::vector<Disturbance> side{at_wheel(way.model, Vector3d::UnitY())};
    const VectorXd with =
        stacked(linear_response(way.model, way.branch, state, side).increments.at(0));
    for (Wrench& reaction : state.reactions) reaction.force.setConstant(NAN);
    EXPECT_EQ(stacked(linear_response(way.model, way.branch, state, side).increments.at(0)), with);
}

TEST(EquilibriumRespond, WhatPushesAnIdleModeIsRefusedAndNamed) {
    const OneWay way = way_of("chrono_mcpherson", "jounce", 1);
    const Equilibrium state = end_of(way.model, way.branch);
    for (std::size_t b = 0; b < way.model.bodies.size(); ++b) {
        const bool strut = way.model.bodies[b].name == "strut";
        const Response response =
            ask(way, state,
                UnitWrench{
                    {static_cast<int>(b), Vector3d::Zero()}, Vector3d::Zero(), Vector3d::UnitZ()});
        EXPECT_EQ(response.outcome, strut ? Outcome::loaded_idle_mode : Outcome::converged)
            << response.detail;
        if (strut) {
            EXPECT_NE(response.detail.find("a wrench on 'strut': body 'strut' is pushed"),
                      std::string::npos)
                << response.detail;
        }
    }
}

TEST(EquilibriumRespond, AtALimitPointThereIsNone) {
    // ℓ³ = ℓ₀ b²
    const OneWay way = way_of("two_spring_arch", "down", -1);
    const double b = 0.3, l_0 = std::hypot(b, 0.08), l = std::cbrt(l_0 * b * b),
                 z = std::sqrt(l * l - b * b);
    Equilibrium state{2 * 100e3 * (l - l_0) * z / l, {way.model.bodies[0].design}, {}, 0};
    state.poses[0].r.z() = z;
    const Response response = ask(way, state, UnitWrench{{0, Vector3d::Zero()}, Vector3d::UnitZ()});
    EXPECT_EQ(response.outcome, Outcome::singular) << response.detail;
    EXPECT_TRUE(response.increments.empty());
}

TEST(EquilibriumRespond, AnOffsetThatASecondJointHoldsIsSaidToContradict) {
    Scene s;
    s.bodies = {{"bar", {}}};
    const Direction y{ground, Vector3d::UnitY()}, own_y{0, Vector3d::UnitY()},
        z{ground, Vector3d::UnitZ()};
    s.joints = {{"hinge", Revolute{{0, Vector3d::Zero()}, {ground, Vector3d::Zero()}, own_y, y}},
                {"jack", InPlane{{0, {0.8, 0, 0}}, {ground, Vector3d::Zero()}, z}},
                {"stop", InPlane{{0, {0.8, 0.1, 0}}, {ground, Vector3d::Zero()}, z}}};
    s.branches = {branch_of(
        "still", {driven_by({"lift", DeadForce{{0, {0.8, 0, 0}}, Vector3d::UnitZ()}})}, 1, 1)};
    s.probes = {{"end", {0, {0.8, 0, 0}}}};
    const OneWay way = support::way_of(s, "still", 1);
    const Response response = ask(way, {0, {way.model.bodies[0].design}, {}, 0}, Motion{1});
    EXPECT_EQ(response.outcome, Outcome::inconsistent_constraints);
    EXPECT_NE(response.detail.find("moving 'jack': the joints 'hinge', 'jack', 'stop' contradict"),
              std::string::npos)
        << response.detail;
}

TEST(EquilibriumRespond, WhatIsNoNumberOrNotOfTheModelIsSaid) {
    const OneWay way = way_of("double_wishbone", "vertical", 1);
    Equilibrium state = end_of(way.model, way.branch);
    EXPECT_THROW(ask(way, state, UnitWrench{{ground, Vector3d::Zero()}, Vector3d::UnitX()}),
                 std::invalid_argument);
    EXPECT_THROW(ask(way, state, UnitWrench{{99, Vector3d::Zero()}, Vector3d::UnitX()}),
                 std::invalid_argument);
    EXPECT_THROW(ask(way, state, Motion{99}), std::invalid_argument);
    for (std::size_t j = 0; j < way.model.joints.size(); ++j)
        if (way.model.joints[j].driven < 0) {
            EXPECT_THROW(ask(way, state, Motion{static_cast<int>(j)}), std::invalid_argument);
        }
    const auto side = at_wheel(way.model, Vector3d::UnitY());
    state.poses[1].r.y() = NAN;
    EXPECT_EQ(ask(way, state, side).outcome, Outcome::not_finite);
    state.poses.pop_back();
    EXPECT_THROW(ask(way, state, side), std::invalid_argument);
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
