// compare/design/: least squares within bounds, solve-for, tolerances; on closed forms and on the
// references.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "compare/design/figures.hpp"
#include "compare/design/least_squares.hpp"
#include "compare/design/solve_for.hpp"
#include "compare/design/tolerances.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();

VectorXd vector(std::initializer_list<double> values) {
    VectorXd v(static_cast<Index>(values.size()));
    std::ranges::copy(values, v.begin());
    return v;
}

// ---- Least squares within bounds.

// Karush-Kuhn-Tucker conditions of 300 random linear problems, of which 100 have fewer residuals than
// numbers need.
TEST(LeastSquares, FulfilsTheConditionsOfOptimalityWithinBounds) {
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
                                return vector({10 * (x[1] - x[0] * x[0]), 1 - x[0]});
                            },
                            [](const VectorXd& x) {
                                MatrixXd J(2, 2);
                                J << -20 * x[0], 10, -1, 0;
                                return J;
                            },
                            {VectorXd::Constant(2, -infinity), VectorXd::Constant(2, infinity)},
                            vector({-1.2, 1})};
    const Minimum free = minimise(rosenbrock, rosenbrock.about);
    EXPECT_TRUE(free.converged);
    EXPECT_LE((free.x - vector({1, 1})).norm(), 1e-12);
    rosenbrock.box.high = vector({0.5, 10});
    const Minimum bounded = minimise(rosenbrock, rosenbrock.about);
    EXPECT_TRUE(bounded.converged);
    EXPECT_LE((bounded.x - vector({0.5, 0.25})).norm(), 1e-7);
    EXPECT_EQ(limits_reached(rosenbrock, bounded), (std::vector<int>{1, 0}));
}

// ---- Solve-for, figures in closed form.

Figures closed(std::function<VectorXd(const VectorXd&)> value,
               std::function<MatrixXd(const VectorXd&)> rate) {
    return {std::move(value), [rate](const VectorXd& p) {
                const MatrixXd J = rate(p);
                return FigureGradient{J};
            }};
}

// |p| = 2 from (0.6, 0.8): the nearest point of the circle is (1.2, 1.6).
TEST(SolveFor, MeetsAWishWithTheSmallestChange) {
    const Figures radius = closed([](const VectorXd& p) { return vector({p.norm()}); },
                                  [](const VectorXd& p) { return p.transpose() / p.norm(); });
    const Solution found =
        solve_for(radius, {vector({2}), vector({0.6, 0.8}), vector({-5, -5}), vector({5, 5})});
    EXPECT_TRUE(found.met);
    EXPECT_TRUE(found.converged);
    EXPECT_LE((found.p - vector({1.2, 1.6})).norm(), 1e-6);
    EXPECT_NEAR(found.after[0], 2, 1e-9);
    // Changes count as shares of the ranges: with a range of the first a hundred times that of the
    // second the first does it, y almost unchanged.
    const Solution scaled =
        solve_for(radius, {vector({2}), vector({0.6, 0.8}), vector({-500, -5}), vector({500, 5})});
    EXPECT_TRUE(scaled.met);
    EXPECT_NEAR(scaled.p[1], 0.8, 1e-3);
}

// As many numbers as wishes: p² = 9 and p q = 6 from (2, 1).
TEST(SolveFor, MeetsAsManyWishesAsNumbers) {
    const Figures both = closed(
        [](const VectorXd& p) {
            return vector({p[0] * p[0], p[0] * p[1]});
        },
        [](const VectorXd& p) {
            MatrixXd J(2, 2);
            J << 2 * p[0], 0, p[1], p[0];
            return J;
        });
    const Solution found =
        solve_for(both, {vector({9, 6}), vector({2, 1}), vector({0, 0}), vector({10, 10})});
    EXPECT_TRUE(found.met);
    EXPECT_LE((found.p - vector({3, 2})).norm(), 1e-8);
}

// p = 1 and 3 p = 0, both over the range of p: nearest in (p - 1)² + p², at p = 1/2.
TEST(SolveFor, NamesTheWishesThatConflict) {
    const Figures twice = closed(
        [](const VectorXd& p) {
            return vector({p[0], 3 * p[0], p[1]});
        },
        [](const VectorXd&) {
            MatrixXd J(3, 2);
            J << 1, 0, 3, 0, 0, 1;
            return J;
        });
    const Solution found =
        solve_for(twice, {vector({1, 0, 2}), vector({0, 0}), vector({-10, -10}), vector({10, 10})});
    EXPECT_FALSE(found.met);
    EXPECT_TRUE(found.converged);
    EXPECT_LE((found.p - vector({0.5, 2})).norm(), 1e-6);
    EXPECT_NEAR(found.conflict[0], std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(found.conflict[1], std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(found.conflict[2], 0, 1e-6);
    EXPECT_EQ(found.at_limit, (std::vector<int>{0, 0}));
}

TEST(SolveFor, NamesTheLimitThatPreventsAWish) {
    const Figures sum = closed([](const VectorXd& p) { return vector({p[0] - p[1]}); },
                               [](const VectorXd&) {
                                   return MatrixXd{{1, -1}};
                               });
    const Solution found =
        solve_for(sum, {vector({7}), vector({0, 0}), vector({-1, -2}), vector({4, 2})});
    EXPECT_FALSE(found.met);
    EXPECT_EQ(found.p, vector({4, -2}));
    EXPECT_EQ(found.at_limit, (std::vector<int>{1, -1}));
    EXPECT_NEAR(found.after[0], 6, 1e-12);
}

TEST(SolveFor, DoesNotStartWhereNothingMovesOrThereIsNoValue) {
    const Figures still = closed(
        [](const VectorXd& p) {
            return vector({p[0], 1});
        },
        [](const VectorXd&) {
            return MatrixXd{{1}, {0}};
        });
    const Wishes wishes{vector({1, 2}), vector({0}), vector({-1}), vector({2})};
    const Solution found = solve_for(still, wishes);
    EXPECT_EQ(found.still, (std::vector<bool>{false, true}));
    EXPECT_FALSE(found.met);
    EXPECT_EQ(found.p, wishes.start);
    const Figures none = closed(
        [](const VectorXd&) {
            return vector({std::nan(""), 0});
        },
        [](const VectorXd&) {
            return MatrixXd{{1}, {0}};
        });
    EXPECT_FALSE(solve_for(none, wishes).before.allFinite());
    EXPECT_FALSE(solve_for(none, wishes).met);
}

// ---- Figures of scenes.

SceneAt scene_with(const std::string& name, std::vector<std::string> paths) {
    return [file = std::string(ELASTOCHECK_SCENES "/") + name + ".yaml", paths](const VectorXd& p) {
        std::vector<Setting> settings;
        for (std::size_t k = 0; k < paths.size(); ++k)
            settings.push_back(setting(paths[k], p[static_cast<Index>(k)]));
        return read_scene(file, settings);
    };
}
std::vector<Number> numbers_of(const std::string& name, const std::vector<std::string>& paths) {
    std::vector<Number> numbers;
    for (const auto& path : paths)
        for (const auto& number : support::scene(name).numbers)
            if (number.path == path) numbers.push_back(number);
    EXPECT_EQ(numbers.size(), paths.size());
    return numbers;
}
VectorXd values_of(const std::vector<Number>& numbers) {
    VectorXd p(static_cast<Index>(numbers.size()));
    for (Index k = 0; k < p.size(); ++k) p[k] = numbers[static_cast<std::size_t>(k)].value;
    return p;
}

Figures figures_of(const std::string& name, const std::vector<std::string>& paths,
                   std::vector<Figure> figures) {
    return solved_figures(scene_with(name, paths), numbers_of(name, paths), std::move(figures));
}

// Two upright springs: z = 400 + F / (k_1 + k_2) mm.
const std::vector<std::string> rates{"springs.first.rate", "springs.second.rate"};
const std::vector<Figure> heights{{.name = "centre_z", .branch = "up", .at = 3000},
                                  {.name = "centre_z", .branch = "up", .at = 1500},
                                  {.name = "centre_z", .branch = "down", .at = -2000},
                                  {.name = "centre_z", .branch = "up", .at = 0}};
Figures springs(std::vector<Figure> figures = heights) {
    return figures_of("parallel_springs", rates, std::move(figures));
}

TEST(Figures, OfTwoSpringsAreTheClosedForm) {
    const VectorXd p = vector({30, 45}), f = springs().value(p);
    const VectorXd expected = vector({440, 420, 400 - 2000 / 75.0, 400});
    EXPECT_LE((f - expected).cwiseAbs().maxCoeff(), 1e-9);
    const FigureGradient gradient = springs().gradient(p);
    for (Index k = 0; k < 2; ++k) {
        EXPECT_NEAR(gradient.rate(0, k), -3000 / 75.0 / 75, 1e-12);
        EXPECT_NEAR(gradient.rate(2, k), 2000 / 75.0 / 75, 1e-12);
        EXPECT_NEAR(gradient.rate(3, k), 0, 1e-12);
    }
}

// Extrapolated differences of whole solutions: a characteristic is a derivative of the state, and a
// figure over travel moves its place.
TEST(Figures, HaveTheRatesOfDifferencesOfSolutions) {
    const std::vector<std::string> paths{"points.tie_rod_inner.z", "points.arm_rear.y",
                                         "springs.K1_coil.rate"};
    const VectorXd p = values_of(numbers_of("mcpherson", paths));
    const double z =
        figure_values(support::scene("mcpherson"),
                      std::vector<Figure>{{.name = "travel", .branch = "jounce", .at = 1500}},
                      Leg::equilibrium)
            .value[0];
    const Figures of = figures_of(
        "mcpherson", paths,
        {{.name = "toe", .branch = "jounce", .at = 2000},
         {.name = "bump_steer", .branch = "jounce", .at = 1200},
         {.name = "wheel_rate", .branch = "rebound", .at = -800},
         {.name = "lateral_force_steer", .branch = "jounce"},
         {.name = "roll_centre_height", .branch = "jounce", .at = 500},
         {.name = "K1_coil.force", .branch = "jounce", .at = 900},
         {.name = "wheel_centre_y", .branch = "jounce", .at = z, .over = "travel", .change = true},
         {.name = "bump_camber", .branch = "jounce", .at = z, .over = "travel"}});
    const FigureGradient gradient = of.gradient(p);
    ASSERT_TRUE(gradient.rate.allFinite()) << gradient.why_not << gradient.rate;
    const VectorXd step = vector({5e-4, 5e-4, 300});
    for (Index k = 0; k < p.size(); ++k) {
        const auto at = [&](double share) {
            VectorXd q = p;
            q[k] += share * step[k];
            return of.value(q);
        };
        const VectorXd whole = (at(1) - at(-1)) / (2 * step[k]),
                       half = (at(0.5) - at(-0.5)) / step[k], exact = gradient.rate.col(k);
        const VectorXd difference = (4 * half - whole) / 3;
        for (Index j = 0; j < exact.size(); ++j)
            EXPECT_NEAR(exact[j], difference[j],
                        1e-7 * gradient.rate.row(j).cwiseProduct(step.transpose()).norm() / step[k])
                << j << " by " << paths[static_cast<std::size_t>(k)];
    }
}

TEST(Figures, OfEveryLegAreTheSameAndAFigureOverAnOutputIsAtItsPlace) {
    const Scene scene = support::scene("mcpherson");
    const std::vector<Figure> figures{{.name = "toe", .branch = "jounce", .at = 2000},
                                      {.name = "bump_steer", .branch = "jounce", .at = 2000},
                                      {.name = "bump_steer", .branch = "rebound", .at = 0},
                                      {.name = "toe", .branch = "rebound", .at = -1500}};
    const VectorXd truth = figure_values(scene, figures, Leg::equilibrium).value;
    for (const Leg leg : {Leg::energy, Leg::series}) {
        const VectorXd other = figure_values(scene, figures, leg).value;
        EXPECT_LE((other - truth).cwiseAbs().maxCoeff(), 1e-6) << name(leg);
    }
    const std::vector<Figure> travel{{.name = "travel", .branch = "jounce", .at = 2000}};
    const double z = figure_values(scene, travel, Leg::equilibrium).value[0];
    const std::vector<Figure> over{
        {.name = "toe", .branch = "jounce", .at = z, .over = "travel"},
        {.name = "toe", .branch = "jounce", .at = z, .over = "travel", .change = true},
        {.name = "toe", .branch = "jounce", .at = 1e4, .over = "travel"}};
    const FigureValues placed = figure_values(scene, over, Leg::equilibrium);
    EXPECT_NEAR(placed.value[0], truth[0], 1e-7);
    EXPECT_NEAR(placed.value[1], truth[0], 1e-7);  // toe is zero as drawn
    EXPECT_TRUE(std::isnan(placed.value[2]));
    EXPECT_NE(placed.why_not.find("does not reach travel = 10000 mm"), std::string::npos)
        << placed.why_not;
}

// k_1 + k_2 = 80 for z = 437.5 at 3000 N: of the ways to get there the smallest change, 2.5 each.
TEST(SolveFor, FindsRatesOfTwoSprings) {
    const auto number = springs({heights[0]});
    const Solution found =
        solve_for(number, {vector({437.5}), vector({30, 45}), vector({10, 20}), vector({60, 70})});
    EXPECT_TRUE(found.met);
    EXPECT_LE((found.p - vector({32.5, 47.5})).cwiseAbs().maxCoeff(), 1e-4);
    EXPECT_NEAR(found.p.sum(), 80, 1e-7);
}

// The tie rod of the McPherson strut, without bump steer at the design position. Its change agrees
// with the one that the file's head states (3.5 mm) to the size of the second derivative.
TEST(SolveFor, FindsTheTieRodWithoutBumpSteer) {
    const std::vector<std::string> paths{"points.tie_rod_inner.z"};
    const std::vector<Figure> figures{{.name = "bump_steer", .branch = "jounce"}};
    const auto scene = scene_with("mcpherson", paths);
    const Solution found =
        solve_for(figures_of("mcpherson", paths, figures),
                  {vector({0}), vector({-0.015}), vector({-0.05}), vector({0.02})});
    EXPECT_TRUE(found.met);
    EXPECT_NE(found.before[0], 0);
    EXPECT_NEAR(found.p[0], -0.0115, 1e-3);
    for (const Leg leg : {Leg::equilibrium, Leg::energy, Leg::series})
        EXPECT_LE(std::abs(figure_values(scene(found.p), figures, leg).value[0]),
                  1e-6 * found.movement[0])
            << name(leg);
}

TEST(SolveFor, SaysWhyANumberDoesNotMoveAFigure) {
    const auto reasons =
        why_still(scene_with("parallel_springs", {"points.foot_1.x", "springs.first.rate"}),
                  {.name = "centre_x", .branch = "up", .at = 3000},
                  numbers_of("parallel_springs", {"points.foot_1.x", "springs.first.rate"}),
                  vector({-200, 30}));
    ASSERT_EQ(reasons.size(), 2u);
    EXPECT_EQ(reasons[1], "springs.first.rate: it moves centre_z, for example, and not centre_x");
}

// ---- Tolerances.

TEST(Tolerances, ShareOfEachAddsUpAndTheWorstCaseIsTheSum) {
    const std::vector<Tolerated> numbers{normal("a", 2), uniform("b", 3)};
    const auto [f, g] = [&] {
        const auto all = scatter(MatrixXd{{3, -1}, {0, 0}}, numbers);
        return std::pair(all[0], all[1]);
    }();
    EXPECT_NEAR(f.sd, std::sqrt(36 + 3), 1e-14);
    EXPECT_NEAR(f.worst_case, 3 * 6 + 3, 1e-14);
    EXPECT_NEAR(f.share[0], 36.0 / 39, 1e-14);
    EXPECT_NEAR(f.share[1], 3.0 / 39, 1e-14);
    EXPECT_EQ(g.sd, 0);
    EXPECT_EQ(g.share, VectorXd::Zero(2));
    // Fully correlated: |3·2 - √3|, and the second takes away.
    const auto both = scatter(MatrixXd{{3, -1}}, numbers, MatrixXd{{1, 1}, {1, 1}});
    EXPECT_NEAR(both[0].sd, 6 - std::sqrt(3.0), 1e-12);
    EXPECT_LT(both[0].share[1], 0);
    EXPECT_NEAR(both[0].share.sum(), 1, 1e-12);
    EXPECT_FALSE(is_correlation(MatrixXd{{1, 0.9, 0.9}, {0.9, 1, -0.9}, {0.9, -0.9, 1}}));
    EXPECT_TRUE(is_correlation(MatrixXd{{1, 0.9}, {0.9, 1}}));
}

// 400 samples of the references. The standard deviation of a sample's standard deviation is
// σ / √(2 N) for a normal distribution and less for a sum with uniform parts: bounds of four of
// these.
TEST(Tolerances, OfAMcPhersonAreThoseOfAMonteCarloOfTheReferences) {
    const std::vector<std::string> paths{"points.tie_rod_inner.z", "points.tie_rod_outer.z",
                                         "points.arm_rear.z", "springs.K1_coil.rate"};
    const std::vector<Tolerated> tolerated{normal(paths[0], 5e-4), uniform(paths[1], 1e-3),
                                           normal(paths[2], 1e-3), uniform(paths[3], 1e3)};
    const MatrixXd rho{{1, 0.6, 0, 0}, {0.6, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    const auto numbers = numbers_of("mcpherson", paths);
    const VectorXd nominal = values_of(numbers);
    const std::vector<Figure> figures{{.name = "bump_steer", .branch = "jounce"},
                                      {.name = "toe", .branch = "jounce", .at = 1500},
                                      {.name = "lateral_force_steer", .branch = "jounce"}};
    const Figures of = figures_of("mcpherson", paths, figures);
    const auto linear = scatter(of.gradient(nominal).rate, tolerated, rho);

    constexpr int samples = 400;
    std::mt19937_64 random(3);
    std::normal_distribution<double> gauss;
    // The second is uniform and correlated with the first: by a copula whose correlation is that
    // of a normal with a uniform variable, ρ √(3/π).
    const double r = 0.6 / std::sqrt(3 / std::numbers::pi);
    MatrixXd values(samples, 3);
    for (Index s = 0; s < samples; ++s) {
        const double u = gauss(random), v = r * u + std::sqrt(1 - r * r) * gauss(random);
        const auto share = [](double z) { return std::erf(z / std::sqrt(2.0)); };  // -1 to 1
        const VectorXd d =
            vector({5e-4 * u, 1e-3 * share(v), 1e-3 * gauss(random), 1e3 * share(gauss(random))});
        values.row(s) = of.value(nominal + d);
    }
    for (Index f = 0; f < 3; ++f) {
        const double mean = values.col(f).mean(),
                     sd = std::sqrt((values.col(f).array() - mean).square().sum() / (samples - 1));
        const Scatter& by_gradient = linear[static_cast<std::size_t>(f)];
        EXPECT_GT(by_gradient.sd, 0);
        EXPECT_NEAR(sd / by_gradient.sd, 1, 4 / std::sqrt(2.0 * samples))
            << figures[static_cast<std::size_t>(f)].name;
        EXPECT_LE(sd, by_gradient.worst_case);
    }
}

}  // namespace
}  // namespace elastocheck::compare
