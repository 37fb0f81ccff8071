// compare/design/optimise: bands, prices of bounds, several starts; on closed forms and on the
// references.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "compare/design/optimise.hpp"
#include "compare/design/solve_for.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double unbounded = std::numeric_limits<double>::infinity();

VectorXd list_of(std::initializer_list<double> values) {
    VectorXd v(static_cast<Index>(values.size()));
    std::ranges::copy(values, v.begin());
    return v;
}

Figures exact_figures_of(std::function<VectorXd(const VectorXd&)> value,
                         std::function<MatrixXd(const VectorXd&)> rate) {
    return {std::move(value), [rate](const VectorXd& p) {
                const MatrixXd J = rate(p);
                return FigureGradient{J};
            }};
}
const Figures radius =
    exact_figures_of([](const VectorXd& p) { return list_of({p.norm()}); },
                     [](const VectorXd& p) -> MatrixXd { return p.transpose() / p.norm(); });

Optimum from(const Figures& figures, const Goals& goals, int starts = 1) {
    return optimise(figures, goals, starts_of(goals, starts));
}

// |p| ≥ 2 from (0.6, 0.8): the nearest point is (1.2, 1.6), 1 away, 0.1 as a share of the ranges;
// each unit of the bound is a unit of the way.
TEST(Optimise, MeetsABandWithTheSmallestChangeAndKnowsItsPrice) {
    const Goals goals{.low = list_of({2}),
                      .high = list_of({3}),
                      .goal = {0},
                      .start = list_of({0.6, 0.8}),
                      .least = list_of({-5, -5}),
                      .most = list_of({5, 5})};
    const Optimum found = from(radius, goals, 3);
    EXPECT_TRUE(found.met);
    EXPECT_TRUE(found.converged);
    EXPECT_LE((found.p - list_of({1.2, 1.6})).norm(), 1e-5);
    EXPECT_NEAR(found.cost, 0.1, 1e-6);
    ASSERT_EQ(found.active.size(), 1u);
    EXPECT_FALSE(found.active[0].of_number);
    EXPECT_FALSE(found.active[0].upper);
    EXPECT_EQ(found.active[0].bound, 2);
    EXPECT_NEAR(found.active[0].price, 0.1, 1e-5);
}

TEST(Optimise, ChangesNothingWithinTheBands) {
    const Goals goals{.low = list_of({0.5}),
                      .high = list_of({3}),
                      .goal = {0},
                      .start = list_of({0.6, 0.8}),
                      .least = list_of({-5, -5}),
                      .most = list_of({5, 5})};
    const Optimum found = from(radius, goals, 2);
    EXPECT_TRUE(found.met);
    EXPECT_TRUE(found.converged);
    EXPECT_LE((found.p - goals.start).norm(), 1e-9);
    EXPECT_TRUE(found.active.empty());
}

// p + q with p q ≥ b is least at p = q = √b, where it is 2 √b: its derivative by b is 1 / √b.
// The limit p ≥ l > √b holds p: p + q = l + b / l.
TEST(Optimise, MinimisesAFigureWithPricesOfBandsAndLimits) {
    const Figures both = exact_figures_of(
        [](const VectorXd& p) {
            return list_of({p[0] * p[1], p[0] + p[1]});
        },
        [](const VectorXd& p) {
            return MatrixXd{{p[1], p[0]}, {1, 1}};
        });
    Goals goals{.low = list_of({4, -unbounded}),
                .high = list_of({unbounded, unbounded}),
                .goal = {0, 1},
                .minimised = 1,
                .start = list_of({5, 7}),
                .least = list_of({0.5, 0.25}),
                .most = list_of({10, 12})};
    Optimum found = from(both, goals);
    EXPECT_TRUE(found.met);
    EXPECT_TRUE(found.converged) << found.optimality;
    EXPECT_NEAR(found.cost, 4, 1e-6);
    ASSERT_EQ(found.active.size(), 1u);
    EXPECT_NEAR(found.active[0].price, 0.5, 1e-4);
    goals.least[0] = 4;
    found = from(both, goals);
    EXPECT_LE((found.p - list_of({4, 1})).norm(), 1e-6);
    ASSERT_EQ(found.active.size(), 2u);
    for (const ActiveBound& one : found.active)
        EXPECT_NEAR(one.price, one.of_number ? 1 - 4.0 / 16 : 0.25, 1e-4);
}

// The prices are the differences of the costs with each bound relaxed; of ten problems with six
// bands in four numbers.
TEST(Optimise, PricesAreTheDerivativesOfTheCostByTheBounds) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> at(-1, 1);
    int prices = 0;
    for (int k = 0; k < 10; ++k) {
        const MatrixXd A = MatrixXd::NullaryExpr(6, 4, [&] { return at(random); });
        const MatrixXd B = 0.2 * MatrixXd::NullaryExpr(6, 4, [&] { return at(random); });
        const Figures figures = exact_figures_of(
            [A, B](const VectorXd& p) { return VectorXd(A * p + B * p.cwiseAbs2()); },
            [A, B](const VectorXd& p) { return MatrixXd(A + 2 * B * p.asDiagonal()); });
        VectorXd inside = VectorXd::NullaryExpr(4, [&] { return at(random); });
        const VectorXd centre = figures.value(inside);
        Goals goals{.low = centre.array() - 0.05,
                    .high = centre.array() + 0.05,
                    .goal = {0, 1, 2, 3, 4, 5},
                    .start = VectorXd::Zero(4),
                    .least = VectorXd::Constant(4, -3),
                    .most = VectorXd::Constant(4, 2)};
        const Optimum found = from(figures, goals);
        ASSERT_TRUE(found.met && found.converged) << k;
        for (const ActiveBound& one : found.active) {
            const double relaxed = 1e-5;
            Goals wider = goals;
            (one.upper ? wider.high : wider.low)[one.which] += one.upper ? relaxed : -relaxed;
            const Optimum there = optimise(figures, wider, {found.p});
            // the bounds are met within 1e-7
            EXPECT_NEAR(one.price, (found.cost - there.cost) / relaxed, 2e-3) << k;
            prices += one.price > 0.01;
        }
    }
    EXPECT_GE(prices, 20);
}

// p ≥ 1 and 3 p ≤ 0, both over the range of p: nearest in (1 - p)² + p², at p = 1/2.
TEST(Optimise, NamesTheBandsThatConflictAndTheLimitThatPreventsOne) {
    const Figures twice = exact_figures_of(
        [](const VectorXd& p) {
            return list_of({p[0], 3 * p[0], p[1]});
        },
        [](const VectorXd&) {
            return MatrixXd{{1, 0}, {3, 0}, {0, 1}};
        });
    Goals goals{.low = list_of({1, -unbounded, 2}),
                .high = list_of({unbounded, 0, 3}),
                .goal = {0, 1, 2},
                .start = list_of({0, 0}),
                .least = list_of({-10, -10}),
                .most = list_of({10, 10})};
    const Optimum found = from(twice, goals, 3);
    EXPECT_FALSE(found.met);
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR(found.p[0], 0.5, 1e-6);
    EXPECT_NEAR(found.conflict[0], std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(found.conflict[1], std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(found.conflict[2], 0, 1e-6);
    EXPECT_EQ(found.at_limit, (std::vector<int>{0, 0}));
    goals.high[1] = 100;
    goals.most[1] = 1.5;
    const Optimum limited = from(twice, goals);
    EXPECT_FALSE(limited.met);
    EXPECT_EQ(limited.p[1], 1.5);
    EXPECT_EQ(limited.at_limit, (std::vector<int>{0, 1}));
}

// (p² - 1)² + 0.3 p has its least minimum at -1.035, and another one at 0.96 beside the start.
TEST(Optimise, FindsTheLeastOfTwoMinimaFromSeveralStarts) {
    const Figures wells = exact_figures_of(
        [](const VectorXd& p) { return list_of({std::pow(p[0] * p[0] - 1, 2) + 0.3 * p[0]}); },
        [](const VectorXd& p) { return MatrixXd{{4 * p[0] * (p[0] * p[0] - 1) + 0.3}}; });
    const Goals goals{.low = list_of({-unbounded}),
                      .high = list_of({unbounded}),
                      .goal = {0},
                      .minimised = 0,
                      .start = list_of({0.7}),
                      .least = list_of({-2}),
                      .most = list_of({2})};
    EXPECT_NEAR(from(wells, goals, 1).p[0], 0.96, 0.01);
    const Optimum found = from(wells, goals, 5);
    EXPECT_NEAR(found.p[0], -1.035, 0.01);
    EXPECT_GT(found.best, 0);
    EXPECT_EQ(found.searches.size(), 5u);
    EXPECT_EQ(found.p, from(wells, goals, 5).p);
}

TEST(Optimise, LeavesAGoalThatDoesNotMoveOutAndDoesNotMinimiseIt) {
    const Figures still = exact_figures_of(
        [](const VectorXd& p) {
            return list_of({p[0], 7});
        },
        [](const VectorXd&) {
            return MatrixXd{{1}, {0}};
        });
    Goals goals{.low = list_of({0.5, 6}),
                .high = list_of({1, 8}),
                .goal = {0, 1},
                .start = list_of({0}),
                .least = list_of({-1}),
                .most = list_of({2})};
    const Optimum found = from(still, goals);
    EXPECT_EQ(found.still, (std::vector<bool>{false, true}));
    EXPECT_TRUE(found.met);
    EXPECT_NEAR(found.p[0], 0.5, 1e-6);
    goals.minimised = 1;
    EXPECT_EQ(from(still, goals).best, -1);
}

// Beyond p = 1.5 there is no value: at the limit, and at some starts.
TEST(Optimise, StaysWhereTheFiguresHaveValues) {
    const Figures partly = exact_figures_of(
        [](const VectorXd& p) { return list_of({p[0] < 1.5 ? p[0] * p[0] : std::nan("")}); },
        [](const VectorXd& p) { return MatrixXd{{p[0] < 1.5 ? 2 * p[0] : std::nan("")}}; });
    Goals goals{.low = list_of({1}),
                .high = list_of({2}),
                .goal = {0},
                .start = list_of({0.1}),
                .least = list_of({-0.5}),
                .most = list_of({20})};
    const Optimum found = from(partly, goals, 4);
    EXPECT_TRUE(found.met);
    EXPECT_NEAR(found.p[0], 1, 1e-5);
    goals.start[0] = 3;
    EXPECT_FALSE(from(partly, goals).before.allFinite());
    EXPECT_FALSE(from(partly, goals).met);
}

TEST(Optimise, PassesOnAnExceptionOfTheFigures) {
    int calls = 0;
    const Figures failing = exact_figures_of(
        [&](const VectorXd& p) {
            if (++calls > 6) throw std::domain_error("as planned");
            return list_of({p[0] * p[0] * p[0]});
        },
        [](const VectorXd& p) { return MatrixXd{{3 * p[0] * p[0]}}; });
    const Goals goals{.low = list_of({1}),
                      .high = list_of({8}),
                      .goal = {0},
                      .start = list_of({4}),
                      .least = list_of({0.1}),
                      .most = list_of({5})};
    EXPECT_THROW(from(failing, goals), std::domain_error);
}

// The tie rod of the McPherson strut: toe within 0.1 deg over 80 mm both ways. A relaxed band is confirmed by another search.
TEST(Optimise, KeepsToeOfAMcPhersonWithinABandOverItsTravel) {
    const std::string path = "points.tie_rod_inner.z";
    const SceneAt scene = [path](const VectorXd& p) {
        return read_scene(ELASTOCHECK_SCENES "/mcpherson.yaml",
                          std::vector<Setting>{setting(path, p[0])});
    };
    std::vector<Figure> figures;
    for (int k = -8; k <= 8; ++k)
        figures.push_back({.name = "toe",
                           .branch = k < 0 ? "rebound" : "jounce",
                           .at = 10.0 * k,
                           .over = "travel"});
    const auto count = static_cast<Index>(figures.size());
    Goals goals{.low = VectorXd::Constant(count, -0.1),
                .high = VectorXd::Constant(count, 0.1),
                .goal = std::vector<int>(figures.size(), 0),
                .start = list_of({-0.015}),
                .least = list_of({-0.05}),
                .most = list_of({0.02})};
    const Number number{path, -0.015, "m"};
    const Figures toe = solved_figures(scene, {number}, figures);
    const Optimum found = from(toe, goals);
    EXPECT_GT(found.before.cwiseAbs().maxCoeff(), 0.15);
    ASSERT_TRUE(found.met);
    EXPECT_TRUE(found.converged) << found.optimality;
    for (const Leg leg : {Leg::equilibrium, Leg::energy, Leg::series})
        EXPECT_LE(figure_values(scene(found.p), figures, leg).value.cwiseAbs().maxCoeff(),
                  0.1 + 1e-6)
            << name(leg);
    ASSERT_FALSE(found.active.empty());
    const ActiveBound& first = found.active.front();
    const double relaxed = 0.002;
    (first.upper ? goals.high : goals.low)[first.which] += first.upper ? relaxed : -relaxed;
    const Optimum there = optimise(toe, goals, {found.p});
    EXPECT_NEAR((found.cost - there.cost) / relaxed, first.price, 0.1 * first.price);
}

}  // namespace
}  // namespace elastocheck::compare
