// Linear response against derivatives of solutions, closed forms and the paper's first step.
#include "recursive/linear_response.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "elastocheck/compile.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/slopes.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using support::apart, support::at_wheel, support::bare, support::OneWay, support::stacked,
    support::way_of;

Method rung(const char* name) { return find_method(name).value(); }

OneWay way_of(const char* scene, const std::string& branch, double to) {
    return support::way_of(support::scene(scene), branch, to);
}

Equilibrium end_of(const Model& model, const Branch& branch) {
    const auto path = solve(model, branch, {.method = rung("series"), .steps = 1});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    return path.points.back();
}
VectorXd one(const OneWay& way, const Equilibrium& state, const Disturbance& disturbance,
             const Method& method = rung("series")) {
    const Response response =
        linear_response(way.model, way.branch, bare(state), {&disturbance, 1}, method);
    EXPECT_EQ(response.outcome, Outcome::converged) << response.detail;
    return response.increments.size() == 1 ? stacked(response.increments[0])
                                           : VectorXd::Constant(6, std::nan(""));
}
BodyId body_named(const Model& model, const std::string& name) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
        if (model.bodies[b].name == name) return static_cast<BodyId>(b);
    throw std::logic_error("no body " + name);
}
void expect_slope(const OneWay& way, const Disturbance& disturbance, double h,
                  const std::string& where) {
    support::expect_slope(one(way, end_of(way.model, way.branch), disturbance), way, disturbance, h,
                          end_of, where);
}

TEST(Respond, IsTheSlopeOfTheOwnSolutionFarFromDesign) {
    const struct {
        const char *scene, *branch;
        double to;
    } all[] = {{"mcpherson_strut", "lateral", 1},
               {"double_wishbone", "vertical", 1},
               {"double_wishbone", "travel", -1},
               {"front_axle", "vertical", 1},
               {"semi_trailing_arm", "vertical", -1}};
    for (const auto& [scene, branch, to] : all) {
        const OneWay way = way_of(scene, branch, to);
        for (int k = 0; k < 3; ++k)
            expect_slope(way, at_wheel(way.model, Vector3d::Unit(k), Vector3d::Zero()), 400,
                         fmt::format("{}, {}, force {}", scene, branch, k));
        expect_slope(way, at_wheel(way.model, Vector3d::Zero(), Vector3d::UnitZ()), 100,
                     fmt::format("{}, {}, moment", scene, branch));
    }
}

TEST(Respond, IsTheSlopeOfTheOwnSolutionOverADrivenOffset) {
    const char* all[][2] = {{"double_wishbone", "steering"},
                            {"front_axle", "parallel"},
                            {"semi_trailing_arm", "travel"}};
    for (const auto& [scene, branch] : all) {
        const OneWay way = way_of(scene, branch, 1);
        for (std::size_t j = 0; j < way.model.joints.size(); ++j)
            if (way.model.joints[j].driven >= 0)
                expect_slope(way, Motion{static_cast<int>(j)}, 0.004,
                             fmt::format("{}, {}", scene, way.model.joints[j].name));
    }
}

TEST(Respond, FollowersAnswerAsTheyAreSolved) {
    const OneWay way = way_of("follower", "up", 1);
    expect_slope(way, UnitWrench{{0, {0.3, 0, 0}}, Vector3d(0.3, 0.2, 1), Vector3d(0.1, 0, 0)}, 100,
                 "follower");
}

// The paper's first step is the response of K to the load, for any size of the load.
TEST(Respond, ThePublishedAnswerIsTheFirstStepOfThePublishedSweep) {
    const OneWay way = way_of("chrono_mcpherson", "jounce", 1);
    const auto& load = std::get<DeadForce>(std::get<Load>(way.branch.drivers[0].what).kind);
    const auto path = solve(way.model, way.branch);
    const double step = path.points[1].load;
    const VectorXd dq =
        step * one(way, path.points[0], UnitWrench{load.at, load.f}, rung("published"));
    for (std::size_t b = 0; b < way.model.bodies.size(); ++b) {
        const auto at = static_cast<Eigen::Index>(6 * b);
        const Pose &from = path.points[0].poses[b], &to = path.points[1].poses[b];
        const Eigen::AngleAxisd turn(to.p * from.p.conjugate());
        EXPECT_LE((to.r - from.r - dq.segment<3>(at)).norm(), 1e-14);
        EXPECT_LE((turn.angle() * turn.axis() - dq.segment<3>(at + 3)).norm(), 1e-14);
    }
}

// A slider on x between two springs: one of rate k along x without force, one across at the
// distance l with the tension T. The taut spring has the transverse stiffness T/l, which is not in
// (19):
//
//   published 1/k,   consistent 1/(k + T/l)
struct Taut {
    double k = 2000, l = 0.25, T = 900, rate = 5e4;
    Scene scene() const {
        Scene s;
        s.bodies = {{"slider", {}}};
        const Direction x{ground, Vector3d::UnitX()}, own_x{0, Vector3d::UnitX()};
        s.joints = {
            {"guide", Translational{{0, Vector3d::Zero()}, {ground, Vector3d::Zero()}, own_x, x}}};
        s.elastics = {
            {"along",
             AxialSpring{{ground, {-0.3, 0, 0}}, {0, Vector3d::Zero()}, LinearRate{k}, 0.3}},
            {"across",
             AxialSpring{
                 {ground, {0, -l, 0}}, {0, Vector3d::Zero()}, LinearRate{rate}, l - T / rate}}};
        s.branches = {
            {"pull",
             0,
             100,
             10,
             ParameterUnit::newton,
             {{Load{"pull", DeadForce{{0, Vector3d::Zero()}, Vector3d::UnitX()}}, 0, 1}}}};
        s.probes = {{"slider", {0, Vector3d::Zero()}}};
        return s;
    }
};

TEST(Respond, OnlyTheConsistentTangentKnowsThatTheTautSpringIsStiffAcross) {
    const Taut taut;
    const OneWay way = way_of(taut.scene(), "pull", 1);
    const Equilibrium state{0, {way.model.bodies[0].design}, {}, 0};
    const UnitWrench pull{{0, Vector3d::Zero()}, Vector3d::UnitX()};
    for (const Method& method : methods) {
        const bool linear = std::holds_alternative<Linear>(method.kind);
        EXPECT_NEAR(one(way, state, pull, method)[0] * (linear ? taut.k : taut.k + taut.T / taut.l),
                    1, 1e-14)
            << method.name;
    }
}

TEST(Respond, MethodsWithOneMatrixAnswerAlike) {
    const OneWay way = way_of("double_wishbone", "vertical", 1);
    const Equilibrium state = end_of(way.model, way.branch);
    const Disturbance side = at_wheel(way.model, Vector3d::UnitY(), Vector3d::Zero());
    const VectorXd linear = one(way, state, side, rung("published")),
                   consistent = one(way, state, side);
    for (const Method& method : methods)
        EXPECT_EQ(one(way, state, side, method),
                  std::holds_alternative<Linear>(method.kind) ? linear : consistent)
            << method.name;
    EXPECT_GT(apart(linear, consistent), 1e-3);
}

TEST(Respond, OnlyThePosesAndTheParameterOfAStateAreRead) {
    const OneWay way = way_of("double_wishbone", "vertical", 1);
    Equilibrium state = end_of(way.model, way.branch);
    const std::vector<Disturbance> side{at_wheel(way.model, Vector3d::UnitY(), Vector3d::Zero())};
    const auto first = linear_response(way.model, way.branch, state, side, rung("tangent"));
    for (Wrench& reaction : state.reactions) reaction.force.setConstant(std::nan(""));
    const auto second = linear_response(way.model, way.branch, state, side, rung("tangent"));
    ASSERT_EQ(second.outcome, Outcome::converged) << second.detail;
    EXPECT_EQ(stacked(first.increments[0]), stacked(second.increments[0]));
}

TEST(Respond, AnswersAreThoseOfEachDisturbanceAloneAndLinear) {
    const OneWay way = way_of("front_axle", "vertical", 1);
    const Equilibrium state = end_of(way.model, way.branch);
    const Point at{way.model.wheels[0].body, way.model.wheels[0].contact_local};
    const Vector3d f(0.3, -2, 0.7), m(5, 1, -3);
    const std::vector<Disturbance> both{UnitWrench{at, f}, UnitWrench{at, Vector3d::Zero(), m},
                                        UnitWrench{at, f, m}};
    const auto response =
        linear_response(way.model, way.branch, state, both, rung("series"), analyse(way.model));
    ASSERT_EQ(response.increments.size(), 3u) << response.detail;
    EXPECT_EQ(stacked(response.increments[0]), one(way, state, both[0]));
    EXPECT_LE(apart(stacked(response.increments[0]) + stacked(response.increments[1]),
                    stacked(response.increments[2])),
              1e-13);
}

// ---- Idle modes, redundant joints, invalid input.

TEST(Respond, WhatPushesAnIdleModeIsRefusedAndTheModeNamed) {
    const OneWay way = way_of("chrono_mcpherson", "jounce", 1);
    const Equilibrium state = end_of(way.model, way.branch);
    const BodyId strut = body_named(way.model, "strut");
    const Vector3d axis = state.poses[static_cast<std::size_t>(strut)].p * Vector3d::UnitZ();
    for (const Method& method : methods) {
        const Disturbance twist = UnitWrench{{strut, Vector3d::Zero()}, Vector3d::Zero(), axis};
        const Response response =
            linear_response(way.model, way.branch, state, {&twist, 1}, method);
        EXPECT_EQ(response.outcome, Outcome::loaded_idle_mode) << method.name;
        EXPECT_TRUE(response.increments.empty());
        EXPECT_NE(response.detail.find(
                      "a wrench on 'strut' acts on a motion that no joint or element resists as "
                      "drawn: strut: rotation about"),
                  std::string::npos)
            << response.detail;
    }
}

TEST(Respond, WhatLeavesTheIdleModeAloneIsAnsweredWithTheLeastOfIt) {
    const OneWay way = way_of("chrono_mcpherson", "jounce", 1);
    const Equilibrium state = end_of(way.model, way.branch);
    const Disturbance side = at_wheel(way.model, Vector3d::UnitY(), Vector3d::Zero());
    // The idle mode by the diagnosis of a model drawn at the state.
    Model there = way.model;
    for (std::size_t b = 0; b < there.bodies.size(); ++b) there.bodies[b].design = state.poses[b];
    const Diagnosis diagnosis = diagnose(there);
    ASSERT_EQ(diagnosis.idle.size(), 1u);
    const double L = analyse(way.model).diagnosis.length;
    for (const char* method : {"published", "series"}) {
        const VectorXd dq = one(way, state, side, rung(method));
        double along = 0;
        for (Eigen::SparseVector<double>::InnerIterator at(diagnosis.idle[0].dq); at; ++at)
            along += at.value() * dq[at.index()] * (at.index() % 6 < 3 ? 1 : L * L);
        EXPECT_LE(std::abs(along), 1e-9 * dq.norm()) << method;
    }
}

// A bar on a hinge, or on the same hinge twice.
Scene hinged(bool twice) {
    Scene s;
    s.bodies = {{"bar", {}}};
    const Direction y{ground, Vector3d::UnitY()}, own_y{0, Vector3d::UnitY()};
    const Revolute hinge{{0, Vector3d::Zero()}, {ground, Vector3d::Zero()}, own_y, y};
    s.joints = {{"hinge", hinge}};
    const Point along{0, {0, 0.3, 0}}, along_ground{ground, {0, 0.3, 0}};
    if (twice) s.joints.push_back({"again", Revolute{along, along_ground, own_y, y}});
    s.elastics = {
        {"spring", AxialSpring{{ground, {0.5, 0, -0.4}}, {0, {0.5, 0, 0}}, LinearRate{3e4}, 0.4}}};
    s.branches = {{"lift",
                   0,
                   800,
                   10,
                   ParameterUnit::newton,
                   {{Load{"lift", DeadForce{{0, {0.8, 0, 0}}, Vector3d::UnitZ()}}, 0, 1}}}};
    s.probes = {{"end", {0, {0.8, 0, 0}}}};
    return s;
}

TEST(Respond, JointsThatSayTheSameTwiceChangeNothing) {
    const OneWay once = way_of(hinged(false), "lift", 1), twice = way_of(hinged(true), "lift", 1);
    ASSERT_EQ(diagnose(twice.model).redundant.size(), 1u);
    const Equilibrium state = end_of(once.model, once.branch);
    const UnitWrench lift{{0, {0.8, 0, 0}}, Vector3d(0.2, 1, 1), Vector3d(1, 2, 3)};
    for (const char* method : {"published", "series"}) {
        const auto answer = [&](const OneWay& way) { return one(way, state, lift, rung(method)); };
        EXPECT_LE(apart(answer(twice), answer(once)), 1e-13) << method;
    }
}

TEST(Respond, AnOffsetThatASecondJointHoldsIsSaidToContradict) {
    Scene s = hinged(false);
    const auto stand = [](const Vector3d& at) {
        return InPlane{{0, at}, {ground, {0, 0, 0}}, {ground, Vector3d::UnitZ()}};
    };
    s.joints.push_back({"jack", stand({0.8, 0, 0})});
    s.joints.push_back({"stop", stand({0.8, 0.1, 0})});
    s.branches[0] = {"still",
                     0,
                     0.01,
                     10,
                     ParameterUnit::metre,
                     {{Load{"none", DeadForce{{0, Vector3d::Zero()}}}, 0, 1}}};
    const OneWay way = way_of(s, "still", 1);
    const Equilibrium state{0, {way.model.bodies[0].design}, {}, 0};
    const Disturbance up = Motion{1};
    const Response response = linear_response(way.model, way.branch, state, {&up, 1});
    EXPECT_EQ(response.outcome, Outcome::inconsistent_constraints);
    EXPECT_NE(response.detail.find("moving 'jack' would open joints"), std::string::npos)
        << response.detail;
}

TEST(Respond, AStateThatIsNoLongerStiffHasNoAnswer) {
    // A strut across under 1024 N, whose geometric stiffness -4096 N/m cancels the rate along:
    // exact in binary.
    const OneWay way = way_of(Taut{4096, 0.25, -1024, 65536}.scene(), "pull", 1);
    const Equilibrium state{0, {way.model.bodies[0].design}, {}, 0};
    const Disturbance pull = UnitWrench{{0, Vector3d::Zero()}, Vector3d::UnitX()};
    const Response response =
        linear_response(way.model, way.branch, state, {&pull, 1}, rung("series"));
    EXPECT_EQ(response.outcome, Outcome::singular);
    EXPECT_TRUE(response.increments.empty());
    EXPECT_NE(response.detail.find("no one response"), std::string::npos) << response.detail;
    EXPECT_NEAR(one(way, state, pull, rung("published"))[0] * 4096, 1, 1e-14)
        << "which knows of no pressure";
}

TEST(Respond, StatesThatAreNoNumbersAreSaidToBeNone) {
    const OneWay way = way_of("double_wishbone", "vertical", 1);
    Equilibrium state = end_of(way.model, way.branch);
    state.poses[1].r.y() = std::numeric_limits<double>::quiet_NaN();
    const Disturbance side = at_wheel(way.model, Vector3d::UnitY(), Vector3d::Zero());
    for (const char* method : {"published", "series"})
        EXPECT_EQ(linear_response(way.model, way.branch, state, {&side, 1}, rung(method)).outcome,
                  Outcome::not_finite);
}

TEST(Respond, WhatIsNotOfTheModelIsRefused) {
    const OneWay way = way_of("double_wishbone", "vertical", 1);
    Equilibrium state = end_of(way.model, way.branch);
    const auto ask = [&](const Disturbance& disturbance) {
        return linear_response(way.model, way.branch, state, {&disturbance, 1});
    };
    EXPECT_THROW(ask(UnitWrench{{ground, Vector3d::Zero()}, Vector3d::UnitX()}),
                 std::invalid_argument);
    EXPECT_THROW(ask(UnitWrench{{99, Vector3d::Zero()}, Vector3d::UnitX()}), std::invalid_argument);
    EXPECT_THROW(ask(Motion{-1}), std::invalid_argument);
    EXPECT_THROW(ask(Motion{99}), std::invalid_argument);
    for (std::size_t j = 0; j < way.model.joints.size(); ++j)
        if (way.model.joints[j].driven < 0) {
            EXPECT_THROW(ask(Motion{static_cast<int>(j)}), std::invalid_argument);
        }
    state.poses.pop_back();
    EXPECT_THROW(ask(at_wheel(way.model, Vector3d::UnitY(), Vector3d::Zero())),
                 std::invalid_argument);
}

}  // namespace
}  // namespace elastocheck::recursive
