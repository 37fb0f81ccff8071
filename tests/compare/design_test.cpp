// compare/design/: least squares within bounds, figures and their rates, solve-for, optimise,
// tolerances; on closed forms and on the references.
#include "tests/compare/design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "compare/design/least_squares.hpp"
#include "compare/design/optimise.hpp"
#include "compare/design/results.hpp"
#include "compare/design/tolerances.hpp"
#include "compare/sensitivity/sensitivity.hpp"
#include "elastocheck/compile.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// ---- Least squares within bounds.

// Karush-Kuhn-Tucker conditions of 300 random linear problems, of which 100 have fewer residuals than
// numbers need.
TEST(LeastSquares, SolutionWithinBoundsFulfilsTheKarushKuhnTuckerConditions) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> at(-1, 1);
    int at_bounds = 0;
    for (int k = 0; k < 300; ++k) {
        const Index n = 2 + k % 6, m = n - 1 + k % 3;
        const MatrixXd A = MatrixXd::NullaryExpr(m, n, [&] { return at(random); });
        const VectorXd b = VectorXd::NullaryExpr(m, [&] { return 3 * at(random); });
        const Box box{VectorXd::NullaryExpr(n, [&] { return std::min(0.0, at(random)); }),
                      VectorXd::NullaryExpr(n, [&] { return std::max(0.0, at(random)); })};
        const Minimum found = minimise({[&](const VectorXd& x) -> VectorXd { return A * x - b; },
                                        [&](const VectorXd&) { return A; }, box, VectorXd::Zero(n)},
                                       VectorXd::Zero(n));
        const VectorXd &x = found.x, g = A.transpose() * (A * x - b);
        const double rounding = 1e-9 * (1 + b.norm());
        EXPECT_TRUE(found.converged) << k;
        for (Index i = 0; i < n; ++i) {
            ASSERT_GE(x[i], box.low[i]);
            ASSERT_LE(x[i], box.high[i]);
            EXPECT_TRUE(g[i] <= rounding || x[i] == box.low[i]) << k << " " << g[i];
            EXPECT_TRUE(g[i] >= -rounding || x[i] == box.high[i]) << k << " " << g[i];
            at_bounds += x[i] == box.low[i] || x[i] == box.high[i];
        }
    }
    EXPECT_GT(at_bounds, 300);
}

// r = (10 (y - x²), 1 - x); with x ≤ 1/2 the minimum is at (1/2, 1/4).
TEST(LeastSquares, FindsTheMinimumOfRosenbrocksFunctionWithAndWithoutABound) {
    LeastSquares rosenbrock{[](const VectorXd& x) {
                                return list_of({10 * (x[1] - x[0] * x[0]), 1 - x[0]});
                            },
                            [](const VectorXd& x) {
                                return MatrixXd{{-20 * x[0], 10}, {-1, 0}};
                            },
                            {VectorXd::Constant(2, -infinity), VectorXd::Constant(2, infinity)},
                            list_of({-1.2, 1})};
    const Minimum free = minimise(rosenbrock, rosenbrock.centre);
    EXPECT_TRUE(free.converged);
    EXPECT_LE((free.x - list_of({1, 1})).norm(), 1e-12);
    rosenbrock.box.high = list_of({0.5, 10});
    const Minimum bounded = minimise(rosenbrock, rosenbrock.centre);
    EXPECT_TRUE(bounded.converged);
    EXPECT_LE((bounded.x - list_of({0.5, 0.25})).norm(), 1e-7);
    EXPECT_EQ(limits_reached(rosenbrock, bounded), (std::vector<int>{1, 0}));
}

// ---- Rates by differences.

// |p - a| has no derivative at a; it has one at a distance of half a step.
TEST(Figures, GradientIsNaNAtAKinkAndDefinedBesideIt) {
    const Figures kink = closed(
        [](const VectorXd& p) {
            return list_of({std::abs(p[0] - 1) + 2 * p[1], p[1] * p[1]});
        },
        2);
    const MatrixXd at = kink.gradient(list_of({1, 3}));
    EXPECT_TRUE(std::isnan(at(0, 0)));
    EXPECT_NEAR(at(0, 1), 2, 1e-9);
    EXPECT_EQ(at(1, 0), 0);
    EXPECT_NEAR(at(1, 1), 6, 1e-9);
    EXPECT_NEAR(kink.gradient(list_of({1.0005, 3}))(0, 0), 1, 1e-9);
}
TEST(Figures, GradientAtTheEndOfTheDefinedRangeIsOneSided) {
    const Figures root = closed(
        [](const VectorXd& p) { return list_of({p[0] < 2 ? std::nan("") : std::exp(p[0])}); }, 1);
    EXPECT_NEAR(root.gradient(list_of({2}))(0, 0), std::exp(2), 1e-5);
    EXPECT_TRUE(std::isnan(root.gradient(list_of({1}))(0, 0)));
}

// ---- Solve-for, figures in closed form.

struct Solved {
    SearchStart start;
    Solution solution;
    bool met = false;
};
Solved solved(const Figures& figures, const VectorXd& target, const SearchRange& range) {
    Solved all{start_of(figures, range), {}};
    if (!all.start.complete() || std::ranges::count(all.start.still, true) > 0) return all;
    all.solution = solve_for(figures, {target, target, all.start.movement}, range, range.start);
    all.met = all.solution.excess() <= met_within;
    return all;
}

const Figures radius = closed([](const VectorXd& p) { return list_of({p.norm()}); }, 2);

// |p| = 2 from (0.6, 0.8): the nearest point of the circle is (1.2, 1.6). Changes count as shares of the
// ranges: with a range of the first a hundred times that of the second the first does it.
TEST(SolveFor, WishIsMetWithTheSmallestChangeRelativeToTheRanges) {
    const Solved found =
        solved(radius, list_of({2}), {list_of({0.6, 0.8}), list_of({-5, -5}), list_of({5, 5})});
    EXPECT_TRUE(found.met);
    EXPECT_TRUE(found.solution.converged);
    EXPECT_LE((found.solution.p - list_of({1.2, 1.6})).norm(), 1e-6);
    const Solved scaled =
        solved(radius, list_of({2}), {list_of({0.6, 0.8}), list_of({-500, -5}), list_of({500, 5})});
    EXPECT_TRUE(scaled.met);
    EXPECT_NEAR(scaled.solution.p[1], 0.8, 1e-3);
}

// As many numbers as wishes: p² = 9 and p q = 6 from (2, 1).
TEST(SolveFor, TwoWishesAreMetByTwoNumbers) {
    const Figures both = closed(
        [](const VectorXd& p) {
            return list_of({p[0] * p[0], p[0] * p[1]});
        },
        2);
    const Solved found =
        solved(both, list_of({9, 6}), {list_of({2, 1}), list_of({0, 0}), list_of({10, 10})});
    EXPECT_TRUE(found.met);
    EXPECT_LE((found.solution.p - list_of({3, 2})).norm(), 1e-8);
}

// p = 1 and 3 p = 0, both over the range of p: nearest in (p - 1)² + p², at p = 1/2. p - q = 7 is out of
// reach of the limits.
TEST(SolveFor, NamesTheWishesThatConflictAndTheLimitThatPreventsOne) {
    const Figures twice = closed(
        [](const VectorXd& p) {
            return list_of({p[0], 3 * p[0], p[1]});
        },
        2);
    const Solved found = solved(twice, list_of({1, 0, 2}),
                                {list_of({0, 0}), list_of({-10, -10}), list_of({10, 10})});
    EXPECT_FALSE(found.met);
    EXPECT_TRUE(found.solution.converged);
    EXPECT_LE((found.solution.p - list_of({0.5, 2})).norm(), 1e-6);
    EXPECT_LE((found.solution.conflict() - list_of({0.5, 0.5, 0})).norm(), 1e-6);
    EXPECT_EQ(found.solution.at_limit, (std::vector<int>{0, 0}));
    const Figures sum = closed([](const VectorXd& p) { return list_of({p[0] - p[1]}); }, 2);
    const Solved limited =
        solved(sum, list_of({7}), {list_of({0, 0}), list_of({-1, -2}), list_of({4, 2})});
    EXPECT_FALSE(limited.met);
    EXPECT_EQ(limited.solution.p, list_of({4, -2}));
    EXPECT_EQ(limited.solution.at_limit, (std::vector<int>{1, -1}));
}

TEST(SolveFor, FiguresThatNoNumberMovesAndMissingValuesAreReported) {
    const SearchRange range{list_of({0}), list_of({-1}), list_of({2})};
    const Figures still = closed([](const VectorXd& p) { return list_of({p[0], 1}); }, 1);
    EXPECT_EQ(start_of(still, range).still, (std::vector<bool>{false, true}));
    const Figures none = closed([](const VectorXd&) { return list_of({std::nan(""), 0}); }, 1);
    EXPECT_FALSE(start_of(none, range).complete());
}

// p, which exists above 0.3, is wished to be 0: a point beside the end of the values is no nearest one.
TEST(SolveFor, SearchEndingBesideUndefinedPointsHasNotConverged) {
    const Figures ends =
        closed([](const VectorXd& p) { return list_of({p[0] > 0.3 ? p[0] : std::nan("")}); }, 1);
    const Solved found = solved(ends, list_of({0}), {list_of({0.8}), list_of({-1}), list_of({1})});
    EXPECT_FALSE(found.met);
    EXPECT_FALSE(found.solution.converged);
}

// A search that stopped early may have missed nearer values, so that its result has no verdict.
TEST(SolveFor, UnconvergedSearchIsNotJudged) {
    const Varied varied{{list_of({0.5}), list_of({0}), list_of({1})}, {{"p", 0.5, "m"}}};
    for (const bool met : {false, true})
        for (const bool converged : {false, true}) {
            const Grade grade = !converged ? Grade::not_judged : met ? Grade::pass : Grade::fail;
            SolvedFor wishes{varied, {{.name = "f", .branch = "b"}}, list_of({1})};
            wishes.start = {list_of({0}), MatrixXd::Ones(1, 1), list_of({1})};
            wishes.solution = {list_of({1}), converged, list_of({met ? 0.0 : 0.5}), {1}};
            wishes.after = list_of({met ? 1.0 : 0.5});
            wishes.by = {list_of({1}), list_of({1}), true};
            EXPECT_EQ(result_of(wishes).verdict.grade, grade);

            OptimisedScene bands{varied, {{.points = {{.name = "f", .branch = "b"}}, .low = 1}}};
            bands.figures = bands.goals.front().points;
            bands.by = wishes.by;
            bands.optimum.p = bands.optimum.conflict = bands.optimum.scale = list_of({1});
            bands.optimum.after = wishes.after, bands.optimum.start = wishes.start;
            bands.optimum.nearest = wishes.solution;
            bands.optimum.met = met, bands.optimum.converged = converged;
            if (met) bands.certificate.emplace();
            const Grade of_bands = result_of(bands).verdict.grade;
            EXPECT_EQ(of_bands, met ? Grade::not_judged : grade);  // without a proof
        }
}

// The trims of all points of a call start from the trim of its first point.
TEST(Figures, EveryCallOfAGradientBeginsWithThePointOfTheGradient) {
    std::vector<VectorXd> first;
    const Figures figures{[&](const std::vector<VectorXd>& points) {
                              first.push_back(points.front());
                              return points;
                          },
                          list_of({0.1, 0.1})};
    const VectorXd p = list_of({1, 2});
    EXPECT_TRUE(figures.gradient(p).isApprox(MatrixXd::Identity(2, 2), 1e-12));
    for (const VectorXd& point : first) EXPECT_EQ(point, p);
    EXPECT_EQ(first.size(), 2u);
}

// ---- Figures of scenes.

// Two upright springs: z = 400 + F / (k_1 + k_2) mm.
const std::vector<std::string> rates{"springs.first.rate", "springs.second.rate"};

TEST(Figures, ValuesAndRatesOfTwoSpringsEqualTheirClosedForm) {
    const Figures springs =
        solved_figures(varied_of("parallel_springs", rates),
                       {{.name = "centre_z", .branch = "up", .station = 3000},
                        {.name = "centre_z", .branch = "up", .station = 1500},
                        {.name = "centre_z", .branch = "down", .station = -2000},
                        {.name = "centre_z", .branch = "up", .station = 0}},
                       2);
    const VectorXd p = list_of({30, 45}), expected = list_of({440, 420, 400 - 2000 / 75.0, 400});
    EXPECT_LE((springs.value(p) - expected).cwiseAbs().maxCoeff(), 1e-9);
    const MatrixXd rate = springs.gradient(p);
    for (Index k = 0; k < 2; ++k) {
        EXPECT_NEAR(rate(0, k), -3000 / 75.0 / 75, 1e-10);
        EXPECT_NEAR(rate(2, k), 2000 / 75.0 / 75, 1e-10);
        EXPECT_EQ(rate(3, k), 0);
    }
}

// `sensitivity` needs no further solutions; the parameter of a figure over travel changes with p:
//
//   dy/dp = ∂y/∂p - (∂y/∂a) / (∂x/∂a) ∂x/∂p
TEST(Figures, GradientsEqualThoseOfTheSensitivityAnalysis) {
    const std::vector<std::string> paths{"points.tie_rod_inner.z", "points.arm_rear.y",
                                         "springs.K1_coil.rate"};
    const Varied varied = varied_of("mcpherson", paths);
    const Scene scene = varied.scene(varied.start);
    const Model model = compile(scene);
    std::vector<Figure> figures;
    std::vector<Channel> outputs;
    for (const char* name : {"toe", "wheel_centre_y", "travel", "bump_steer", "wheel_rate",
                             "lateral_force_steer", "roll_centre_height", "K1_coil.force"}) {
        figures.push_back({.name = name, .branch = "jounce", .station = 1200});
        const auto all = figure_outputs(model);
        outputs.push_back(all.at(static_cast<std::size_t>(find_channel(all, name))));
    }
    const VectorXd at = figure_values(scene, figures).value;
    figures.push_back({.name = "toe", .branch = "jounce", .station = at[2], .abscissa = "travel"});
    const MatrixXd rate = solved_figures(varied, figures, 2).gradient(varied.start);
    const auto by = gradients(
        scene, {scene, {}}, model,
        compare::varying(ELASTOCHECK_SCENES "/mcpherson.yaml", {}, std::span(paths)), outputs,
        {.stations = {{"jounce", {1199, 1200, 1201}}},
         .branches = {"jounce"},
         .legs = {Leg::equilibrium}});
    const SideGradients& side = by.sides.front();
    const double slope = (side.values[2][0] - side.values[0][0]) /
                         (side.values[2][2] - side.values[0][2]);  // of toe over travel
    const MatrixXd& exact = side.legs.front().at[1];
    for (Index j = 0; j < rate.rows(); ++j)
        for (Index k = 0; k < rate.cols(); ++k) {
            const double expected =
                j < exact.rows() ? exact(j, k) : exact(0, k) - slope * exact(2, k);
            const double step = step_of(varied.numbers[static_cast<std::size_t>(k)]);
            const double largest =
                (rate.row(j).cwiseAbs() *
                 VectorXd::NullaryExpr(
                     3,
                     [&](Index i) { return step_of(varied.numbers[static_cast<std::size_t>(i)]); })
                     .asDiagonal())
                    .maxCoeff();
            EXPECT_NEAR(rate(j, k) * step, expected * step, 1e-7 * largest)
                << figures[static_cast<std::size_t>(j)].name << " by "
                << paths[static_cast<std::size_t>(k)];
        }
}

TEST(Figures, FiguresOfAllLegsAgreeAtAParameterAndAtATravel) {
    const Scene scene = support::scene("mcpherson");
    const std::vector<Figure> figures{{.name = "toe", .branch = "jounce", .station = 2000},
                                      {.name = "bump_steer", .branch = "jounce", .station = 2000},
                                      {.name = "bump_steer", .branch = "rebound", .station = 0},
                                      {.name = "toe", .branch = "rebound", .station = -1500},
                                      {.name = "travel", .branch = "jounce", .station = 2000}};
    const VectorXd truth = figure_values(scene, figures).value;
    for (const Leg leg : {Leg::energy, Leg::series}) {
        const VectorXd other = figure_values(scene, figures, leg).value;
        EXPECT_LE((other - truth).cwiseAbs().maxCoeff(), 1e-6) << name(leg);
    }
    const std::vector<Figure> over{
        {.name = "toe", .branch = "jounce", .station = truth[4], .abscissa = "travel"},
        {.name = "toe",
         .branch = "jounce",
         .station = truth[4],
         .abscissa = "travel",
         .change = true},
        {.name = "toe", .branch = "jounce", .station = 1e4, .abscissa = "travel"}};
    const FigureValues placed = figure_values(scene, over);
    EXPECT_NEAR(placed.value[0], truth[0], 1e-7);
    EXPECT_NEAR(placed.value[1], truth[0], 1e-7);  // toe is zero as drawn
    EXPECT_TRUE(std::isnan(placed.value[2]));
    EXPECT_NE(placed.why_not.find("does not reach travel = 10000 mm"), std::string::npos)
        << placed.why_not;
}

// k_1 + k_2 = 80 N/mm for z = 437.5 mm at 3000 N: the smallest change is 2.5 N/mm of each.
TEST(SolveFor, RatesOfTwoSpringsForADisplacementEqualTheirClosedForm) {
    const Varied varied =
        varied_of("parallel_springs", rates, list_of({10, 20}), list_of({60, 70}));
    const Solved found =
        solved(solved_figures(varied, {{.name = "centre_z", .branch = "up", .station = 3000}}),
               list_of({437.5}), varied);
    EXPECT_TRUE(found.met);
    EXPECT_LE((found.solution.p - list_of({32.5, 47.5})).cwiseAbs().maxCoeff(), 1e-4);
    EXPECT_NEAR(found.solution.p.sum(), 80, 1e-7);
}

// The tie rod of the McPherson strut, without bump steer at the design position. Its change agrees
// with the one that the file's head states (3.5 mm) to the size of the second derivative.
TEST(SolveFor, TieRodWithoutBumpSteerIsFound) {
    const Varied varied =
        varied_of("mcpherson", {"points.tie_rod_inner.z"}, list_of({-0.05}), list_of({0.02}));
    const std::vector<Figure> figures{{.name = "bump_steer", .branch = "jounce"}};
    const Solved found = solved(solved_figures(varied, figures), list_of({0}), varied);
    EXPECT_TRUE(found.met);
    EXPECT_NE(found.start.value[0], 0);
    EXPECT_NEAR(found.solution.p[0], -0.0115, 1e-3);
    for (const Leg leg : legs)
        if (leg != Leg::recursive) {
            const double value =
                figure_values(varied.scene(found.solution.p), figures, leg).value[0];
            EXPECT_LE(std::abs(value), 1e-6 * found.start.movement[0]) << name(leg);
        }
}

TEST(SolveFor, ReasonWhyANumberMovesNoFigureIsGiven) {
    EXPECT_TRUE(
        why_still(varied_of("parallel_springs", {"points.foot_1.x", "springs.first.rate"}),
                  {.name = "centre_x", .branch = "up", .station = 3000})
            .ends_with("\n  springs.first.rate: it moves centre_z, for example, and not centre_x"));
}

// ---- Optimise.

Optimum from(const Figures& figures, const Goals& goals, const SearchRange& range, int starts = 1) {
    return optimise(figures, goals, range, starts_of(range, starts));
}

// |p| ≥ 2 from (0.6, 0.8): the nearest point is (1.2, 1.6), 1 away, 0.1 as a share of the ranges;
// each unit of the bound costs a unit of distance. |p| ≥ 0.5 changes nothing.
TEST(Optimise, BandIsMetWithTheSmallestChangeAndHasItsShadowPrice) {
    const SearchRange range{list_of({0.6, 0.8}), list_of({-5, -5}), list_of({5, 5})};
    const Optimum found =
        from(radius, {.low = list_of({2}), .high = list_of({3}), .goal = {0}}, range, 3);
    EXPECT_TRUE(found.met);
    EXPECT_TRUE(found.converged);
    EXPECT_LE((found.p - list_of({1.2, 1.6})).norm(), 1e-5);
    EXPECT_NEAR(found.cost, 0.1, 1e-6);
    ASSERT_EQ(found.active.size(), 1u);
    EXPECT_FALSE(found.active[0].of_number);
    EXPECT_FALSE(found.active[0].upper);
    EXPECT_EQ(found.active[0].bound, 2);
    EXPECT_NEAR(found.active[0].price, 0.1, 1e-5);
    const Optimum none =
        from(radius, {.low = list_of({0.5}), .high = list_of({3}), .goal = {0}}, range, 2);
    EXPECT_TRUE(none.met && none.converged);
    EXPECT_LE((none.p - range.start).norm(), 1e-9);
    EXPECT_TRUE(none.active.empty());
}

// p + q with p q ≥ b is least at p = q = √b, where it is 2 √b: its derivative by b is 1 / √b.
// The limit p ≥ l > √b holds p: p + q = l + b / l.
TEST(Optimise, MinimisedFigureHasClosedFormShadowPricesOfBandAndLimit) {
    const Figures both = closed(
        [](const VectorXd& p) {
            return list_of({p[0] * p[1], p[0] + p[1]});
        },
        2);
    const Goals goals{.low = list_of({4, -infinity}),
                      .high = list_of({infinity, infinity}),
                      .goal = {0, 1},
                      .minimised = 1};
    SearchRange range{list_of({5, 7}), list_of({0.5, 0.25}), list_of({10, 12})};
    Optimum found = from(both, goals, range);
    EXPECT_TRUE(found.met);
    EXPECT_TRUE(found.converged) << found.optimality;
    EXPECT_NEAR(found.cost, 4, 1e-6);
    ASSERT_EQ(found.active.size(), 1u);
    EXPECT_NEAR(found.active[0].price, 0.5, 1e-4);
    range.low[0] = 4;
    found = from(both, goals, range);
    EXPECT_LE((found.p - list_of({4, 1})).norm(), 1e-6);
    ASSERT_EQ(found.active.size(), 2u);
    for (const Bound& one : found.active)
        EXPECT_NEAR(one.price, one.of_number ? 1 - 4.0 / 16 : 0.25, 1e-4);
}

// The prices are the differences of the costs with each bound relaxed; of ten problems with six
// bands in four numbers.
TEST(Optimise, ShadowPricesAreTheDerivativesOfTheCostByTheBounds) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> at(-1, 1);
    int prices = 0;
    const SearchRange range{VectorXd::Zero(4), VectorXd::Constant(4, -3), VectorXd::Constant(4, 2)};
    for (int k = 0; k < 10; ++k) {
        const MatrixXd A = MatrixXd::NullaryExpr(6, 4, [&] { return at(random); });
        const MatrixXd B = 0.2 * MatrixXd::NullaryExpr(6, 4, [&] { return at(random); });
        const Figures figures =
            closed([A, B](const VectorXd& p) -> VectorXd { return A * p + B * p.cwiseAbs2(); }, 4);
        const VectorXd inside = VectorXd::NullaryExpr(4, [&] { return at(random); }),
                       centre = figures.value(inside);
        const Goals goals{.low = centre.array() - 0.05,
                          .high = centre.array() + 0.05,
                          .goal = {0, 1, 2, 3, 4, 5}};
        const Optimum found = from(figures, goals, range);
        ASSERT_TRUE(found.met && found.converged) << k;
        for (const Bound& one : found.active) {
            const double relaxed = 1e-5;
            Goals wider = goals;
            (one.upper ? wider.high : wider.low)[one.index] += one.upper ? relaxed : -relaxed;
            const Optimum there = optimise(figures, wider, range, {found.p});
            // the bounds are met within 1e-7
            EXPECT_NEAR(one.price, (found.cost - there.cost) / relaxed, 2e-3) << k;
            prices += one.price > 0.01;
        }
    }
    EXPECT_GE(prices, 20);
}

// p ≥ 1 and 3 p ≤ 0, both over the range of p: nearest in (1 - p)² + p², at p = 1/2.
TEST(Optimise, NamesTheBandsThatConflictAndTheLimitThatPreventsOne) {
    const Figures twice = closed(
        [](const VectorXd& p) {
            return list_of({p[0], 3 * p[0], p[1]});
        },
        2);
    Goals goals{
        .low = list_of({1, -infinity, 2}), .high = list_of({infinity, 0, 3}), .goal = {0, 1, 2}};
    SearchRange range{list_of({0, 0}), list_of({-10, -10}), list_of({10, 10})};
    const Optimum found = from(twice, goals, range, 3);
    EXPECT_FALSE(found.met);
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR(found.p[0], 0.5, 1e-6);
    EXPECT_LE((found.conflict - list_of({0.5, 0.5, 0})).norm(), 1e-6);
    EXPECT_EQ(found.nearest.at_limit, (std::vector<int>{0, 0}));
    goals.high[1] = 100;
    range.high[1] = 1.5;
    const Optimum limited = from(twice, goals, range);
    EXPECT_FALSE(limited.met);
    EXPECT_EQ(limited.p[1], 1.5);
    EXPECT_EQ(limited.nearest.at_limit, (std::vector<int>{0, 1}));
}

// (p² - 1)² + 0.3 p has its least minimum at -1.035, and another one at 0.96 beside the start.
TEST(Optimise, FindsTheLeastOfTwoMinimaFromSeveralStarts) {
    const Figures wells = closed(
        [](const VectorXd& p) { return list_of({std::pow(p[0] * p[0] - 1, 2) + 0.3 * p[0]}); }, 1);
    const Goals goals{
        .low = list_of({-infinity}), .high = list_of({infinity}), .goal = {0}, .minimised = 0};
    const SearchRange range{list_of({0.7}), list_of({-2}), list_of({2})};
    EXPECT_NEAR(from(wells, goals, range).p[0], 0.96, 0.01);
    const Optimum found = from(wells, goals, range, 5);
    EXPECT_NEAR(found.p[0], -1.035, 0.01);
    EXPECT_GT(found.best, 0);
    EXPECT_EQ(found.searches.size(), 5u);
    EXPECT_EQ(found.p, from(wells, goals, range, 5).p);
}

TEST(Optimise, GoalOnAFigureThatNoNumberMovesIsLeftOut) {
    const Figures still = closed([](const VectorXd& p) { return list_of({p[0], 7}); }, 1);
    const SearchRange range{list_of({0}), list_of({-1}), list_of({2})};
    Goals goals{.low = list_of({0.5, 6}), .high = list_of({1, 8}), .goal = {0, 1}};
    const Optimum found = from(still, goals, range);
    EXPECT_EQ(found.still, (std::vector<bool>{false, true}));
    EXPECT_TRUE(found.met);
    EXPECT_NEAR(found.p[0], 0.5, 1e-6);
    goals.minimised = 1;
    EXPECT_EQ(from(still, goals, range).best, -1);
}

// Figures are undefined beyond p = 1.5, which holds for the limit and some starts. Exceptions pass through SLSQP.
TEST(Optimise, SearchStaysWhereFiguresAreDefinedAndPropagatesExceptions) {
    const Figures partly = closed(
        [](const VectorXd& p) { return list_of({p[0] < 1.5 ? p[0] * p[0] : std::nan("")}); }, 1);
    const Goals goals{.low = list_of({1}), .high = list_of({2}), .goal = {0}};
    SearchRange range{list_of({0.1}), list_of({-0.5}), list_of({20})};
    const Optimum found = from(partly, goals, range, 4);
    EXPECT_TRUE(found.met);
    EXPECT_NEAR(found.p[0], 1, 1e-5);
    range.start[0] = 3;
    EXPECT_FALSE(from(partly, goals, range).start.complete());
    int calls = 0;
    const Figures failing = closed(
        [&](const VectorXd& p) {
            if (++calls > 20) throw std::domain_error("as planned");
            return list_of({p[0] * p[0] * p[0]});
        },
        1);
    EXPECT_THROW(
        from(failing, {.low = list_of({1}), .high = list_of({100}), .goal = {0}, .minimised = 0},
             {list_of({4}), list_of({0.1}), list_of({5})}),
        std::domain_error);
}

// The tie rod of the McPherson strut: toe within 0.1 deg over 80 mm both ways. A relaxed band is
// confirmed by another search.
TEST(Optimise, KeepsToeOfAMcPhersonWithinABandOverItsTravel) {
    const Varied varied =
        varied_of("mcpherson", {"points.tie_rod_inner.z"}, list_of({-0.05}), list_of({0.02}));
    std::vector<Figure> figures;
    for (int k = -8; k <= 8; ++k)
        figures.push_back({.name = "toe",
                           .branch = k < 0 ? "rebound" : "jounce",
                           .station = 10.0 * k,
                           .abscissa = "travel"});
    const auto count = std::ssize(figures);
    Goals goals{.low = VectorXd::Constant(count, -0.1),
                .high = VectorXd::Constant(count, 0.1),
                .goal = std::vector<int>(figures.size(), 0)};
    const Figures toe = solved_figures(varied, figures);
    const Optimum found = from(toe, goals, varied);
    EXPECT_GT(found.start.value.cwiseAbs().maxCoeff(), 0.15);
    ASSERT_TRUE(found.met);
    EXPECT_TRUE(found.converged) << found.optimality;
    for (const Leg leg : {Leg::equilibrium, Leg::energy, Leg::series})
        EXPECT_LE(figure_values(varied.scene(found.p), figures, leg).value.cwiseAbs().maxCoeff(),
                  0.1 + 1e-6)
            << name(leg);
    ASSERT_FALSE(found.active.empty());
    const Bound& first = found.active.front();
    const double relaxed = 0.002;
    (first.upper ? goals.high : goals.low)[first.index] += first.upper ? relaxed : -relaxed;
    const Optimum there = optimise(toe, goals, varied, {found.p});
    EXPECT_NEAR((found.cost - there.cost) / relaxed, first.price, 0.1 * first.price);
}

// ---- Tolerances.

TEST(Tolerances, VarianceSharesSumToOneAndWorstCaseIsTheSumOfTheEffects) {
    ToleratedNumbers numbers{
        {"a", "b"}, list_of({2, std::sqrt(3.0)}), list_of({6, 3}), MatrixXd::Identity(2, 2)};
    const Scatter f = scatter(list_of({3, -1}), numbers), g = scatter(list_of({0, 0}), numbers);
    EXPECT_NEAR(f.sd, std::sqrt(36 + 3), 1e-14);
    EXPECT_NEAR(f.worst_case, 3 * 6 + 3, 1e-14);
    EXPECT_NEAR(f.share[0], 36.0 / 39, 1e-14);
    EXPECT_NEAR(f.share[1], 3.0 / 39, 1e-14);
    EXPECT_EQ(g.sd, 0);
    EXPECT_EQ(g.share, VectorXd::Zero(2));
    // Fully correlated: |3·2 - √3|, and the second takes away.
    numbers.correlation = MatrixXd{{1, 1}, {1, 1}};
    const Scatter both = scatter(list_of({3, -1}), numbers);
    EXPECT_NEAR(both.sd, 6 - std::sqrt(3.0), 1e-12);
    EXPECT_LT(both.share[1], 0);
    EXPECT_NEAR(both.share.sum(), 1, 1e-12);
    EXPECT_FALSE(is_correlation(MatrixXd{{1, 0.9, 0.9}, {0.9, 1, -0.9}, {0.9, -0.9, 1}}));
    EXPECT_TRUE(is_correlation(MatrixXd{{1, 0.9}, {0.9, 1}}));
}

// 400 samples of the references. The standard deviation of a sample's standard deviation is
// σ / √(2 N) for a normal distribution and less for a sum with uniform parts: bounds of
// four of these.
TEST(Tolerances, LinearScatterOfAMcPhersonEqualsItsMonteCarlo) {
    const Varied varied =
        varied_of("mcpherson", {"points.tie_rod_inner.z", "points.tie_rod_outer.z",
                                "points.arm_rear.z", "springs.K1_coil.rate"});
    const double third = 1 / std::sqrt(3.0);
    const ToleratedNumbers tolerated{
        {},
        list_of({5e-4, 1e-3 * third, 1e-3, 1e3 * third}),
        list_of({15e-4, 1e-3, 3e-3, 1e3}),
        MatrixXd{{1, 0.6, 0, 0}, {0.6, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    const std::vector<Figure> figures{{.name = "bump_steer", .branch = "jounce"},
                                      {.name = "toe", .branch = "jounce", .station = 1500},
                                      {.name = "lateral_force_steer", .branch = "jounce"}};
    const Figures of = solved_figures(varied, figures, 2);
    constexpr int samples = 400;
    std::mt19937_64 random(3);
    std::normal_distribution<double> gauss;
    // The second is uniform and correlated with the first: by a copula whose correlation is that
    // of a normal with a uniform variable, ρ √(3/π).
    const double r = 0.6 / std::sqrt(3 / std::numbers::pi);
    std::vector<VectorXd> points;
    for (int s = 0; s < samples; ++s) {
        const double u = gauss(random), v = r * u + std::sqrt(1 - r * r) * gauss(random);
        const auto share = [](double z) { return std::erf(z / std::sqrt(2.0)); };  // -1 to 1
        points.push_back(varied.start + list_of({5e-4 * u, 1e-3 * share(v), 1e-3 * gauss(random),
                                                 1e3 * share(gauss(random))}));
    }
    const auto values = of.values(points);
    const MatrixXd rate = of.gradient(varied.start);
    for (Index f = 0; f < 3; ++f) {
        const VectorXd all = VectorXd::NullaryExpr(
            samples, [&](Index s) { return values[static_cast<std::size_t>(s)][f]; });
        const double sd = std::sqrt((all.array() - all.mean()).square().sum() / (samples - 1));
        const Scatter by_gradient = scatter(rate.row(f), tolerated);
        EXPECT_GT(by_gradient.sd, 0);
        EXPECT_NEAR(sd / by_gradient.sd, 1, 4 / std::sqrt(2.0 * samples))
            << figures[static_cast<std::size_t>(f)].name;
        EXPECT_LE(sd, by_gradient.worst_case);
    }
}

}  // namespace
}  // namespace elastocheck::compare
