// Forward sensitivity of the energy leg: against slopes of its own minima and closed forms.
#include "reference/energy/linear_response.hpp"

#include "tests/reference/energy/support.hpp"
#include "tests/support/slopes.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using support::apart, support::at_wheel, support::bare, support::OneWay, support::stacked;

OneWay way_of(const char* file, const std::string& branch, double to) {
    return support::way_of(scene_named(file), branch, to);
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

TEST(EnergyRespond, IsTheSlopeOfTheOwnMinimaFarFromDesign) {
    const struct {
        const char *scene, *branch;
        double to;
    } all[] = {{"mcpherson_strut", "lateral", 1},
               {"double_wishbone", "vertical", 1},
               {"semi_trailing_arm", "vertical", -1}};
    for (const auto& [file, branch, to] : all) {
        const OneWay way = way_of(file, branch, to);
        for (int k = 0; k < 3; ++k)
            expect_slope(way, at_wheel(way.model, Vector3d::Unit(k)), 400,
                         fmt::format("{}, {}, force {}", file, branch, k));
        expect_slope(way, at_wheel(way.model, Vector3d::Zero(), Vector3d::UnitZ()), 100, file);
    }
}

TEST(EnergyRespond, IsTheSlopeOfTheOwnMinimaOverADrivenOffset) {
    const char* all[][2] = {{"double_wishbone", "steering"}, {"semi_trailing_arm", "travel"}};
    for (const auto& [file, branch] : all) {
        const OneWay way = way_of(file, branch, 1);
        for (std::size_t j = 0; j < way.model.joints.size(); ++j)
            if (way.model.joints[j].driven >= 0)
                expect_slope(way, Motion{static_cast<int>(j)}, 0.004,
                             file + way.model.joints[j].name);
    }
}

// A body on a bushing under a large dead moment, which has no potential: the response equals that
// of re-centred charts.
TEST(EnergyRespond, DeadMomentsThatActTurnWithNothing) {
    Scene scene = scene_named("single_bushing");
    scene.branches = {load_branch("twist", {{"m", DeadMoment{0, {200, -150, 120}}}}, 1, 4)};
    const OneWay way = support::way_of(scene, "twist", 1);
    for (int k = 0; k < 3; ++k)
        expect_slope(way, UnitWrench{{0, {0.2, 0, 0.1}}, Vector3d::UnitY(), 3 * Vector3d::Unit(k)},
                     8, fmt::format("moment {}", k));
}

// θ in the plane of the bar: V'' = k_R + F L sin θ at k_R θ = F L cos θ.
TEST(EnergyRespond, OfThePendulum) {
    const OneWay way = way_of("pendulum", "up", 1);
    const double k_R = 600, L = 0.4, F = way.branch.to;
    double theta = 0.5;
    for (int i = 0; i < 50; ++i)
        theta -= (k_R * theta - F * L * std::cos(theta)) / (k_R + F * L * std::sin(theta));
    const Equilibrium state = end_of(way.model, way.branch);
    const double turn = L * std::cos(theta) / (k_R + F * L * std::sin(theta));
    const Vector3d along(0.8, 0.6, 0), axis = along.cross(Vector3d::UnitZ());
    VectorXd expected(6);
    expected << turn * L * (-std::sin(theta) * along + std::cos(theta) * Vector3d::UnitZ()),
        turn * axis;
    EXPECT_LE(
        apart(one(way, state, UnitWrench{{0, Vector3d::Zero()}, Vector3d::UnitZ()}), expected),
        1e-11);
}

// Both ends of the coupler have equal velocity along it: ω c·e = a·e, with a and c the velocities
// of B and C at unit rates.
TEST(EnergyRespond, OfAFourBarsCrank) {
    const OneWay way = way_of("four_bar", "turn", 1);
    for (const double phi : {0.0, 0.7, 2.0}) {
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
            1e-11)
            << phi;
    }
}

TEST(EnergyRespond, OnlyThePosesAndTheParameterOfAStateAreRead) {
    const OneWay way = way_of("double_wishbone", "vertical", 1);
    Equilibrium state = end_of(way.model, way.branch);
    const std::vector<Disturbance> side{at_wheel(way.model, Vector3d::UnitY())};
    const VectorXd with =
        stacked(linear_response(way.model, way.branch, state, side).increments.at(0));
    for (Wrench& reaction : state.reactions) reaction.force.setConstant(NAN);
    EXPECT_EQ(stacked(linear_response(way.model, way.branch, state, side).increments.at(0)), with);
}

TEST(EnergyRespond, WhatHasNoEnergyIsNotAnswered) {
    const OneWay way = way_of("follower", "up", 1);
    const Response response = ask(way, {0, {way.model.bodies[0].design}, {}, 0},
                                  UnitWrench{{0, Vector3d::Zero()}, Vector3d::UnitZ()});
    EXPECT_EQ(response.outcome, Outcome::not_conservative);
    EXPECT_NE(response.detail.find("load 'push' turns with its body"), std::string::npos)
        << response.detail;
    EXPECT_TRUE(response.increments.empty());
}

TEST(EnergyRespond, WhatIsTooLargeIsNotAsked) {
    Scene scene;
    for (int b = 0; b < 700; ++b) {
        scene.bodies.push_back({fmt::format("b{}", b), {}});
        scene.elastics.push_back(
            {fmt::format("e{}", b), Bushing{{b - 1, Vector3d::Zero()},
                                            {b, Vector3d::Zero()},
                                            LinearStiffness{1e5 * Matrix6::Identity()}}});
    }
    scene.branches = {
        load_branch("pull", {{"f", DeadForce{{699, Vector3d::Zero()}, Vector3d::UnitX()}}}, 1, 1)};
    scene.probes = {{"end", {699, Vector3d::Zero()}}};
    const OneWay way = support::way_of(scene, "pull", 1);
    const Equilibrium state{0, std::vector<Pose>(way.model.bodies.size()), {}, 0};
    EXPECT_EQ(ask(way, state, UnitWrench{{699, Vector3d::Zero()}, Vector3d::UnitX()}).outcome,
              Outcome::too_large);
}

TEST(EnergyRespond, WhatPushesAnIdleModeIsRefusedAndNamed) {
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
            EXPECT_NE(response.detail.find(
                          "a wrench on 'strut': a motion that nothing resists is pushed"),
                      std::string::npos)
                << response.detail;
        }
    }
}

TEST(EnergyRespond, AtALimitPointThereIsNone) {
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

TEST(EnergyRespond, AnOffsetThatASecondJointHoldsIsSaidToContradict) {
    Scene s;
    s.bodies = {{"bar", {}}};
    const Direction y{ground, Vector3d::UnitY()}, own_y{0, Vector3d::UnitY()},
        z{ground, Vector3d::UnitZ()};
    s.joints = {{"hinge", Revolute{{0, Vector3d::Zero()}, {ground, Vector3d::Zero()}, own_y, y}},
                {"jack", InPlane{{0, {0.8, 0, 0}}, {ground, Vector3d::Zero()}, z}},
                {"stop", InPlane{{0, {0.8, 0.1, 0}}, {ground, Vector3d::Zero()}, z}}};
    s.branches = {
        load_branch("still", {{"lift", DeadForce{{0, {0.8, 0, 0}}, Vector3d::UnitZ()}}}, 1, 1)};
    s.probes = {{"end", {0, {0.8, 0, 0}}}};
    const OneWay way = support::way_of(s, "still", 1);
    const Response response = ask(way, {0, {way.model.bodies[0].design}, {}, 0}, Motion{1});
    EXPECT_EQ(response.outcome, Outcome::inconsistent_constraints);
    EXPECT_NE(response.detail.find("moving 'jack'"), std::string::npos) << response.detail;
}

TEST(EnergyRespond, WhatIsNoNumberOrNotOfTheModelIsSaid) {
    const OneWay way = way_of("double_wishbone", "vertical", 1);
    Equilibrium state = end_of(way.model, way.branch);
    for (const Disturbance& wrong :
         {Disturbance(UnitWrench{{ground, Vector3d::Zero()}, Vector3d::UnitX()}),
          Disturbance(UnitWrench{{99, Vector3d::Zero()}, Vector3d::UnitX()}),
          Disturbance(Motion{99}), Disturbance(Motion{-1})})
        EXPECT_THROW(ask(way, state, wrong), std::invalid_argument);
    const auto side = at_wheel(way.model, Vector3d::UnitY());
    state.poses[1].r.y() = NAN;
    EXPECT_EQ(ask(way, state, side).outcome, Outcome::not_finite);
    state.poses.pop_back();
    EXPECT_THROW(ask(way, state, side), std::invalid_argument);
}

}  // namespace
}  // namespace elastocheck::reference::energy
