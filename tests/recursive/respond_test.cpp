// Linear response of the recursion by each method: the paper's first step, one matrix, idle modes.
#include "recursive/linear_response.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "recursive/diagnosis/analysis.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/slopes.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using support::relative_distance, support::at_wheel, support::poses_only, support::SideModel,
    support::stacked, support::side_named;

Method rung(const char* name) { return find_method(name).value(); }

SideModel side_named(const char* scene, const std::string& branch, double to) {
    return support::side_named(support::scene(scene), branch, to);
}

Equilibrium end_of(const Model& model, const Branch& branch) {
    const auto path = solve(model, branch, {.method = rung("series"), .steps = 1});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    return path.points.back();
}
VectorXd one(const SideModel& way, const Equilibrium& state, const Disturbance& disturbance,
             const Method& method = rung("series")) {
    const Response response =
        linear_response(way.model, way.branch, poses_only(state), {&disturbance, 1}, method);
    EXPECT_EQ(response.outcome, Outcome::converged) << response.detail;
    return response.increments.size() == 1 ? stacked(response.increments[0])
                                           : VectorXd::Constant(6, std::nan(""));
}
// The paper's first step is the response of K to the load, for any size of the load.
TEST(RecursionResponse, PublishedResponseEqualsTheFirstStepOfThePublishedSweep) {
    const SideModel way = side_named("chrono_mcpherson", "jounce", 1);
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

TEST(RecursionResponse, MethodsWithTheSameMatrixGiveTheSameResponse) {
    const SideModel way = side_named("double_wishbone", "vertical", 1);
    const Equilibrium state = end_of(way.model, way.branch);
    const Disturbance side = at_wheel(way.model, Vector3d::UnitY(), Vector3d::Zero());
    const VectorXd linear = one(way, state, side, rung("published")),
                   consistent = one(way, state, side);
    for (const Method& method : methods)
        EXPECT_EQ(one(way, state, side, method),
                  std::holds_alternative<Linear>(method.kind) ? linear : consistent)
            << method.name;
    EXPECT_GT(relative_distance(linear, consistent), 1e-3);
}

// The pivot order of a state gives the same response at the next one, without a search if the two are near.
TEST(RecursionResponse, PivotOrdersAreReusedAtTheNextState) {
    const SideModel way = side_named("double_wishbone", "vertical", 1);
    const auto path = solve(way.model, way.branch, {.method = rung("series"), .steps = 8});
    ASSERT_EQ(path.points.size(), 9u);
    ResponseAnalysis kept{analyse(way.model)};
    const auto orders = [&] { return kept.orders.with_tangent; };
    int searches = 0;
    for (const Equilibrium& state : path.points) {
        const Disturbance side = at_wheel(way.model, Vector3d::UnitY(), Vector3d::Zero());
        const auto before = orders();
        const Response response = linear_response(way.model, way.branch, poses_only(state),
                                                  {&side, 1}, rung("series"), kept);
        ASSERT_EQ(response.outcome, Outcome::converged) << response.detail;
        searches += before != orders();
        EXPECT_LE(relative_distance(stacked(response.increments[0]), one(way, state, side)), 1e-10);
    }
    EXPECT_GE(searches, 1) << "the first state leaves its own";
    EXPECT_LE(searches, 3);
}

TEST(RecursionResponse, PivotOrderOfASimilarModelIsUsedWithoutASearch) {
    const Model model = side_named("double_wishbone", "vertical", 1).model,
                other = side_named("front_axle", "vertical", 1).model;
    const auto own = analyse(model).system.lu.order;
    EXPECT_EQ(analyse(model, own).system.lu.order, own);
    EXPECT_EQ(analyse(model, own).system.lu.orders, 0);
    EXPECT_EQ(analyse(model, analyse(other).system.lu.order).system.lu.order->row, own->row)
        << "that of another structure is not used";
}

TEST(RecursionResponse, ResponsesToSeveralDisturbancesAreLinearAndIndependent) {
    const SideModel way = side_named("front_axle", "vertical", 1);
    const Equilibrium state = end_of(way.model, way.branch);
    const Point at{way.model.wheels[0].body, way.model.wheels[0].centre_local};
    const Vector3d f(0.3, -2, 0.7), m(5, 1, -3);
    const std::vector<Disturbance> both{UnitWrench{at, f}, UnitWrench{at, Vector3d::Zero(), m},
                                        UnitWrench{at, f, m}};
    const auto response = linear_response(way.model, way.branch, state, both, rung("series"));
    ASSERT_EQ(response.increments.size(), 3u) << response.detail;
    EXPECT_EQ(stacked(response.increments[0]), one(way, state, both[0]));
    EXPECT_LE(relative_distance(stacked(response.increments[0]) + stacked(response.increments[1]),
                                stacked(response.increments[2])),
              1e-13);
}

TEST(RecursionResponse, ResponseHasNoPartAlongAnUnloadedIdleMode) {
    const SideModel way = side_named("chrono_mcpherson", "jounce", 1);
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

}  // namespace
}  // namespace elastocheck::recursive
