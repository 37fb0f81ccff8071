// compare/variants/: designs of experiments, statistics against closed forms, figures of variants
// against those of single solves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "compare/design/figures.hpp"
#include "compare/variants/sampler.hpp"
#include "compare/variants/solve_variants.hpp"
#include "compare/variants/statistics.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare::variants {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

struct WithOpenTurns : testing::Test {
    void SetUp() override {
        if (!openturns::available()) GTEST_SKIP() << "libopenturns-dev is not installed";
    }
};
using Sampling = WithOpenTurns;
using VariantStatistics = WithOpenTurns;

Study study_of(std::vector<Distribution> distributions, DesignKind kind, std::uint64_t count) {
    Study study;
    for (std::size_t j = 0; j < distributions.size(); ++j)
        study.variables.push_back(
            {.name = "x" + std::to_string(j), .unit = {}, .distribution = distributions[j]});
    study.design = {.kind = kind, .count = count, .seed = 7};
    study.figures = {{.name = "y", .output = {}, .branch = {}}};
    return study;
}

// ---- Designs.

TEST_F(Sampling, AVariantIsAFunctionOfItsNumberAlone) {
    for (const DesignKind& kind : std::vector<DesignKind>{MonteCarlo{}, Sobol{}, LatinHypercube{}})
        for (const bool indices : {false, true}) {
            if (indices && kind.index() == DesignKind(LatinHypercube{}).index()) continue;
            Study study = study_of({Normal{1, 2}, Triangular{0, 0.2, 1}, Levels{{1, 5, 9}},
                                    TruncatedNormal{0, 1, -1, 3}},
                                   kind, 600);
            if (!indices) {
                study.correlation = MatrixXd::Identity(4, 4);
                study.correlation(0, 1) = study.correlation(1, 0) = 0.6;
            }
            study.design.indices = indices;
            const Sampler sampler(study);
            const MatrixXd all = sampler.values(0, 600);
            for (const std::uint64_t k : {0, 1, 5, 6, 7, 311, 599})
                EXPECT_EQ(sampler.values(k, 1).row(0), all.row(static_cast<Index>(k))) << k;
            // A longer study begins with the same variants.
            if (kind.index() == DesignKind(LatinHypercube{}).index()) continue;
            Study longer = study;
            longer.design.count = 100'000;
            EXPECT_EQ(Sampler(longer).values(0, 600), all);
        }
}

TEST_F(Sampling, TheSeedChangesEveryDraw) {
    for (const DesignKind& kind :
         std::vector<DesignKind>{MonteCarlo{}, Sobol{}, LatinHypercube{}}) {
        Study study = study_of({Uniform{0, 1}, Uniform{0, 1}}, kind, 50);
        const MatrixXd first = Sampler(study).values(0, 50);
        study.design.seed = 8;
        EXPECT_TRUE((Sampler(study).values(0, 50).array() != first.array()).all());
    }
}

// Every elementary interval 2⁻ᵃ × 2⁻ᵇ, a + b = m, has one of 2ᵐ points: the first two dimensions of a
// Sobol sequence are a (0, m, 2)-net, also where a digital shift is added. In any dimension every
// interval 2⁻ᵐ has one.
TEST_F(Sampling, SobolPointsFillTheCubeEvenly) {
    constexpr int m = 8, d = 40;
    const Study study = study_of(std::vector<Distribution>(d, Uniform{0, 1}), Sobol{}, 1 << m);
    const MatrixXd u = Sampler(study).points(0, 1 << m);
    for (int a = 0; a <= m; ++a) {
        std::set<std::pair<int, int>> cells;
        for (Index i = 0; i < u.rows(); ++i)
            cells.emplace(static_cast<int>(std::ldexp(u(i, 0), a)),
                          static_cast<int>(std::ldexp(u(i, 1), m - a)));
        EXPECT_EQ(cells.size(), 1u << m) << a;
    }
    for (Index j = 0; j < d; ++j) {
        std::set<int> strata;
        for (Index i = 0; i < u.rows(); ++i)
            strata.insert(static_cast<int>(std::ldexp(u(i, j), m)));
        EXPECT_EQ(strata.size(), 1u << m) << j;
    }
}

TEST_F(Sampling, ALatinHypercubeHasOnePointInEveryStratum) {
    const Study study =
        study_of({Uniform{0, 1}, Uniform{0, 1}, Uniform{0, 1}}, LatinHypercube{}, 97);
    const MatrixXd u = Sampler(study).points(0, 97);
    for (Index j = 0; j < 3; ++j) {
        std::set<int> strata;
        for (Index i = 0; i < 97; ++i) strata.insert(static_cast<int>(97 * u(i, j)));
        EXPECT_EQ(strata.size(), 97u);
    }
}

// Moments of 2¹⁴ Sobol points, which integrate smooth functions to some 1e-3.
TEST_F(Sampling, DrawsHaveTheMomentsAndCorrelationOfTheirDistributions) {
    constexpr std::uint64_t n = 1 << 14;
    Study study = study_of({Normal{3, 2}, Normal{-1, 0.5}, Uniform{-1, 3}, Triangular{-2, 0, 2},
                            TruncatedNormal{0, 1, -1, 1}, Levels{{-1, 1}}},
                           Sobol{}, n);
    study.correlation = MatrixXd::Identity(6, 6);
    study.correlation(0, 1) = study.correlation(1, 0) = -0.7;
    const MatrixXd x = Sampler(study).values(0, n);
    const Eigen::RowVectorXd mean = x.colwise().mean();
    const MatrixXd centred = x.rowwise() - mean;
    const MatrixXd covariance = centred.transpose() * centred / static_cast<double>(n);
    // φ and Φ of the normal distribution at 1: variance 1 - 2 φ / (2 Φ - 1) between -1 and 1
    const double phi = std::exp(-0.5) / std::sqrt(2 * std::numbers::pi);
    const double truncated = std::sqrt(1 - 2 * phi / std::erf(1 / std::numbers::sqrt2));
    const double means[] = {3, -1, 1, 0, 0, 0},
                 deviations[] = {2, 0.5, 2 / std::sqrt(3.0), 2 / std::sqrt(6.0), truncated, 1};
    for (Index j = 0; j < 6; ++j) {
        EXPECT_NEAR(mean[j], means[j], 1e-3) << j;
        EXPECT_NEAR(std::sqrt(covariance(j, j)), deviations[j], 2e-3) << j;
    }
    EXPECT_NEAR(covariance(0, 1) / (2 * 0.5), -0.7, 2e-3);
    EXPECT_NEAR(covariance(0, 2), 0, 2e-3);
}

TEST_F(Sampling, AGridHasEveryCombinationOnce) {
    const Study study = study_of({Levels{{1, 2, 3}}, Levels{{10, 20}}}, Grid{}, 6);
    EXPECT_EQ(grid_size(study.variables), 6u);
    MatrixXd expected(6, 2);
    expected << 1, 10, 1, 20, 2, 10, 2, 20, 3, 10, 3, 20;
    EXPECT_EQ(Sampler(study).values(0, 6), expected);
    EXPECT_EQ(Sampler(study).values(4, 2), expected.bottomRows(2));
    EXPECT_THROW((void)grid_size(std::vector<Variable>(
                     12, {.name = "x", .unit = {}, .distribution = Levels{{1, 2, 3, 4, 5, 6}}})),
                 std::invalid_argument);
}

// ---- Statistics.

// Ishigami's function sin x₁ + a sin² x₂ + b x₃⁴ sin x₁ on [-π, π]³, a = 7, b = 0.1, of which the
// indices are known.
TEST_F(VariantStatistics, FindTheIndicesOfIshigamisFunctionWithinTheirIntervals) {
    const double pi = std::numbers::pi, a = 7, b = 0.1;
    const double V1 = 0.5 * std::pow(1 + b * std::pow(pi, 4) / 5, 2), V2 = a * a / 8,
                 V13 = b * b * std::pow(pi, 8) * (1.0 / 18 - 1.0 / 50), V = V1 + V2 + V13;
    const double first[] = {V1 / V, V2 / V, 0}, total[] = {(V1 + V13) / V, V2 / V, V13 / V};
    for (const DesignKind& kind : std::vector<DesignKind>{MonteCarlo{}, Sobol{}}) {
        Study study = study_of(std::vector<Distribution>(3, Uniform{-pi, pi}), kind, 5 * 4096);
        study.design.indices = true;
        const MatrixXd x = Sampler(study).values(0, study.design.count);
        std::vector<double> y;
        for (Index i = 0; i < x.rows(); ++i)
            y.push_back(std::sin(x(i, 0)) + a * std::pow(std::sin(x(i, 1)), 2) +
                        b * std::pow(x(i, 2), 4) * std::sin(x(i, 0)));
        const FigureStatistics found = statistics(study, 0, y);
        EXPECT_NEAR(found.sd, std::sqrt(V), 0.05 * std::sqrt(V));
        EXPECT_LT(found.mean.low, a / 2);
        EXPECT_GT(found.mean.high, a / 2);
        ASSERT_TRUE(found.sobol);
        EXPECT_EQ(found.blocks, 4096u);
        for (Index j = 0; j < 3; ++j) {
            const auto& s = *found.sobol;
            EXPECT_LT(s.first(j, 1), first[j]) << j;
            EXPECT_GT(s.first(j, 2), first[j]) << j;
            EXPECT_LT(s.total(j, 1), total[j]) << j;
            EXPECT_GT(s.total(j, 2), total[j]) << j;
            EXPECT_LT(s.total(j, 2) - s.total(j, 1), 0.1) << j;
        }
    }
}

// A block with a failed variant is left out, and the others are as before.
TEST_F(VariantStatistics, LeaveBlocksWithAFailedVariantOutOfTheIndices) {
    Study study = study_of({Uniform{0, 1}, Uniform{0, 1}}, MonteCarlo{}, 4 * 200);
    study.design.indices = true;
    const MatrixXd x = Sampler(study).values(0, study.design.count);
    std::vector<double> y;
    for (Index i = 0; i < x.rows(); ++i) y.push_back(x(i, 0) + x(i, 1) * x(i, 1));
    std::vector<double> shorter(y.begin(), y.begin() + 4 * 199);
    y[4 * 199 + 2] = std::nan("");
    const FigureStatistics with = statistics(study, 0, y), without = statistics(study, 0, shorter);
    EXPECT_EQ(with.blocks, 199u);
    EXPECT_EQ(with.blocks_left_out, 1u);
    ASSERT_TRUE(with.sobol && without.sobol);
    EXPECT_EQ(with.sobol->total, without.sobol->total);
}

// P(B >= k | low) = P(B <= k | high) = 2.5 %.
TEST_F(VariantStatistics, ClopperPearsonIntervalsHoldTheirTails) {
    const auto at_most = [](int k, int n, double p) {
        double sum = 0;
        for (int j = 0; j <= k; ++j)
            sum += std::exp(std::lgamma(n + 1) - std::lgamma(j + 1) - std::lgamma(n - j + 1) +
                            j * std::log(p) + (n - j) * std::log1p(-p));
        return sum;
    };
    for (const auto& [k, n] : {std::pair(1, 10), std::pair(7, 10), std::pair(3, 1000)}) {
        const auto [low, high] = openturns::clopper_pearson(static_cast<std::uint64_t>(k),
                                                            static_cast<std::uint64_t>(n), 0.95);
        EXPECT_NEAR(1 - at_most(k - 1, n, low), 0.025, 1e-8) << k;
        EXPECT_NEAR(at_most(k, n, high), 0.025, 1e-8) << k;
    }
    EXPECT_EQ(openturns::clopper_pearson(0, 50, 0.95).first, 0);
    EXPECT_NEAR(openturns::clopper_pearson(0, 50, 0.95).second, 1 - std::pow(0.025, 1.0 / 50),
                1e-12);
    EXPECT_EQ(openturns::clopper_pearson(50, 50, 0.95).second, 1);
}

// Of 2000 samples of 60 the intervals of a percentile contain it in 95 % at least; those of the 1 %
// and 99 % have an end without bound.
TEST_F(VariantStatistics, IntervalsOfPercentilesCoverThem) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> draw(0, 1);
    const Study study = study_of({Uniform{0, 1}}, MonteCarlo{}, 60);
    constexpr int samples = 2000;
    std::array<int, percentiles.size()> covered{};
    for (int s = 0; s < samples; ++s) {
        std::vector<double> y(60);
        for (double& value : y) value = draw(random);
        const FigureStatistics found = statistics(study, 0, y);
        for (std::size_t p = 0; p < percentiles.size(); ++p)
            covered[p] += found.percentile[p].low <= percentiles[p] &&
                          percentiles[p] <= found.percentile[p].high;
        ASSERT_TRUE(std::isinf(found.percentile.front().low));
        ASSERT_TRUE(std::isinf(found.percentile.back().high));
    }
    // 0.95 less three standard deviations of a share of 2000
    for (const int count : covered) EXPECT_GE(count, static_cast<int>(samples * 0.935));
}

TEST_F(VariantStatistics, CountWhatHasNoValue) {
    Study study = study_of({Uniform{0, 1}}, MonteCarlo{}, 6);
    study.figures[0].low = 0, study.figures[0].high = 2;
    const double inf = std::numeric_limits<double>::infinity();
    const FigureStatistics found = statistics(study, 0, {1, std::nan(""), 3, inf, 2, std::nan("")});
    EXPECT_EQ(found.count, 3u);
    EXPECT_EQ(found.missing, 2u);
    EXPECT_EQ(found.undefined, 1u);
    EXPECT_EQ(found.mean.value, 2);
    EXPECT_EQ(found.sd, 1);
    ASSERT_TRUE(found.outside);
    EXPECT_NEAR(found.outside->value, 1.0 / 3, 1e-15);
    EXPECT_TRUE(std::isnan(statistics(study, 0, {std::nan("")}).mean.value));
}

// ---- Figures of variants.

StudyFigure figure_at(const std::string& output, const std::string& branch, double at) {
    return {.name = output, .output = output, .branch = branch, .at = at};
}

// Positions, reactions, forces of elements and characteristics of variants are those of the series leg
// alone, of scenes with one-sided branches, with two-sided ones, and with parts that are active on
// some branches only.
TEST(VariantSolver, FindsTheFiguresOfEveryVariantAsAloneAndAsTheReference) {
    const struct {
        std::string scene, number;
        std::vector<StudyFigure> figures;
    } cases[]{
        {"mcpherson",
         "points.tie_rod_inner.z",
         {figure_at("toe", "jounce", 1500), figure_at("bump_steer", "rebound", -3000),
          figure_at("ball_joint.force_z", "jounce", 3000), figure_at("wheel_rate", "jounce", 0),
          figure_at("K4_arm_rear.displacement_x", "rebound", -750)}},
        {"front_axle",
         "points.tie_rod_inner_left.z",
         {figure_at("left.toe", "parallel", -0.04), figure_at("left.wheel_rate", "roll", 1000),
          figure_at("right.camber", "lateral", 3000), figure_at("left.toe", "steering", 0.05)}},
        {"chrono_mcpherson_travel",
         "points.tie_rod_inner.z",
         {figure_at("toe", "travel", -0.04), figure_at("camber", "travel", 0.08)}},
    };
    for (const auto& [name, number, figures] : cases) {
        const std::string file = ELASTOCHECK_SCENES "/" + name + ".yaml";
        const Scene scene = read_scene(file);
        const Model design = compile(trim(scene).scene);
        const VariantSolver solver(design, figures);
        const double nominal = std::ranges::find(scene.numbers, number, &Number::path)->value;
        std::vector<Scene> scenes;
        std::vector<Model> models;
        for (const double by : {-0.002, 0.0, 0.001, 0.003, 0.004}) {
            scenes.push_back(read_scene(file, std::vector{setting(number, nominal + by)}));
            models.push_back(compile(trim(scenes.back()).scene));
        }
        std::vector<Figure> plain;
        for (const auto& figure : figures)
            plain.push_back({.name = figure.output, .branch = figure.branch, .at = figure.at});
        const auto found = solver.solve(models);
        ASSERT_EQ(found.size(), models.size());
        for (std::size_t v = 0; v < models.size(); ++v) {
            EXPECT_EQ(found[v].outcome, VariantOutcome::solved) << found[v].reason;
            const auto reference = figure_values(scenes[v], plain, Leg::equilibrium);
            const auto alone = solver.solve_alone(models[v], Leg::equilibrium);
            for (std::size_t k = 0; k < figures.size(); ++k) {
                const double expected = reference.value[static_cast<Index>(k)];
                EXPECT_NEAR(found[v].values[k], expected, 1e-9 * (1 + std::abs(expected)))
                    << name << " " << figures[k].output;
                EXPECT_NEAR(alone.values[k], expected, 1e-9 * (1 + std::abs(expected)))
                    << name << " " << figures[k].output;
            }
        }
        EXPECT_GT(std::abs(found[4].values[0] - found[0].values[0]), 1e-6) << "nothing varies";
    }
}

// The strut of the design spins freely, which its analysis holds; that of the variant is resisted.
TEST(VariantSolver, ComputesCharacteristicsOfAVariantWithOtherIdleModes) {
    const Model design = compile(read_scene(ELASTOCHECK_SCENES "/mcpherson.yaml"));
    Model resisted = design;
    for (Elastic& elastic : resisted.elastics)
        if (elastic.name == "K2_strut_mount")
            std::get<LinearStiffness>(std::get<Bushing>(elastic.kind).law).K(5, 5) = 100;
    const VariantSolver solver(design, {figure_at("bump_steer", "jounce", 3000)});
    const VariantFigures found = solver.solve(std::vector{resisted}).front(),
                         expected = solver.solve_alone(resisted, Leg::equilibrium);
    ASSERT_EQ(found.outcome, VariantOutcome::solved) << found.reason;
    EXPECT_NEAR(found.values[0], expected.values[0], 1e-9 * std::abs(expected.values[0]));
}

// On the same points the extremes of a branch are those of its curve.
TEST(VariantSolver, FindsExtremesOverABranchOfBothSides) {
    const std::string file = ELASTOCHECK_SCENES "/chrono_mcpherson_travel.yaml";
    const Model design = compile(read_scene(file));
    const std::string branch = design.branches.front().name;
    std::vector<StudyFigure> figures;
    for (const Over over : {Over::least, Over::largest})
        figures.push_back({.name = "toe", .output = "toe", .branch = branch, .over = over});
    const VariantSolver solver(design, figures);
    const auto found = solver.solve(std::vector{design}).front();
    const auto sides = sides_of(design, design.branches.front());
    double least = 1e9, largest = -1e9;
    for (BranchSide side : sides) {
        side.branch.steps = solver.points();
        for (const auto& point : walk(side, {.leg = Leg::equilibrium}).points) {
            const auto all = channels(design);
            const double toe =
                evaluate(design, point)[static_cast<std::size_t>(find_channel(all, "toe"))];
            least = std::min(least, toe), largest = std::max(largest, toe);
        }
    }
    EXPECT_NEAR(found.values[0], least, 1e-9);
    EXPECT_NEAR(found.values[1], largest, 1e-9);
    EXPECT_GT(largest - least, 1);
}

TEST(VariantSolver, SaysWhyABranchEndsAndLeavesTheOtherFigures) {
    const std::string file = ELASTOCHECK_SCENES "/two_spring_arch.yaml";
    Scene scene = read_scene(file);
    const Model design = compile(scene);
    const std::string branch = design.branches.front().name;
    const Branch& of = design.branches.front();
    std::string output;
    for (const Channel& channel : channels(design))
        if (output.empty() && channel.name.ends_with("_z")) output = channel.name;
    const VariantSolver solver(
        design, {figure_at(output, branch, 0),
                 figure_at(output, branch, of.to),
                 {.name = "least", .output = output, .branch = branch, .over = Over::least}});
    Model beyond = design;
    for (auto& driver : beyond.branches.front().drivers) driver.rate *= 50;
    const auto found = solver.solve(std::vector{design, beyond, design});
    EXPECT_EQ(found[0].outcome, VariantOutcome::solved) << found[0].reason;
    EXPECT_EQ(found[1].outcome, VariantOutcome::ended_early);
    EXPECT_NE(found[1].reason.find(branch), std::string::npos) << found[1].reason;
    EXPECT_TRUE(std::isfinite(found[1].values[0]));
    EXPECT_TRUE(std::isnan(found[1].values[1]));
    EXPECT_TRUE(std::isnan(found[1].values[2])) << "an extreme of a part of the branch";
    EXPECT_EQ(found[0].values, found[2].values) << "beside a variant that ends";
}

// A chain of bushings of 46 to 3e8 N/mm, on which series gives up.
TEST(VariantSolver, FallsBackToTheEquilibriumLegWhereSeriesDeclines) {
    const Model design = compile(
        read_scene(ELASTOCHECK_SCENES "/../../tests/compare/scenes/stiff_beside_soft.yaml"));
    const VariantSolver solver(design, {figure_at("tip_z", "pull", 152.4)});
    EXPECT_EQ(solver.solve_alone(design, Leg::series).outcome, VariantOutcome::ended_early);
    const VariantFigures found = solver.solve(std::vector{design}).front();
    EXPECT_EQ(found.outcome, VariantOutcome::solved) << found.reason;
    EXPECT_EQ(found.leg, Leg::equilibrium);
    EXPECT_NE(found.reason.find("by the equilibrium leg, since series: branch 'pull': "),
              std::string::npos)
        << found.reason;
    EXPECT_EQ(found.values, solver.solve_alone(design, Leg::equilibrium).values);
}

TEST(VariantSolver, RefusesWhatTheModelHasNot) {
    const Model design = compile(read_scene(ELASTOCHECK_SCENES "/mcpherson.yaml"));
    const auto make = [&](const StudyFigure& figure) { return VariantSolver(design, {figure}); };
    EXPECT_THROW(make(figure_at("to", "jounce", 0)), std::invalid_argument);
    EXPECT_THROW(make(figure_at("toe", "jump", 0)), std::invalid_argument);
    EXPECT_THROW(make(figure_at("toe", "jounce", 3000 / std::numbers::pi)), std::invalid_argument);
    EXPECT_EQ(make(figure_at("toe", "jounce", 1500)).points(), 2);
    EXPECT_EQ(make(figure_at("toe", "jounce", 1100)).points(), 30);
}

}  // namespace
}  // namespace elastocheck::compare::variants
