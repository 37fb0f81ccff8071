// compare/design/fit: intervals, undetermined combinations, and a wrong hardpoint.
#include "compare/design/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/compare/design.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/mistakes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(Fit, QuantilesOfStudentsDistributionEqualTheTable) {
    EXPECT_NEAR(student_95(1), 12.7062, 1e-4);
    EXPECT_NEAR(student_95(2), 4.30265, 1e-5);
    EXPECT_NEAR(student_95(5), 2.57058, 1e-5);
    EXPECT_NEAR(student_95(10), 2.22814, 1e-5);
    EXPECT_NEAR(student_95(30), 2.04227, 1e-5);
    EXPECT_NEAR(student_95(1000), 1.96234, 1e-5);
    EXPECT_NEAR(student_95(1000000), 1.95996, 1e-5);
    EXPECT_EQ(student_95(0), infinity);
}

// y = a exp(-b t) at 20 times.
const Figures decay = closed(
    [](const VectorXd& p) {
        return VectorXd(p[0] * (-p[1] * VectorXd::LinSpaced(20, 0, 1.9)).array().exp());
    },
    2);

SearchRange unlimited(const VectorXd& start) {
    const VectorXd high = VectorXd::Constant(start.size(), infinity);
    return {start, -high, high};
}

// A straight line a + b t: the intervals of the textbook.
TEST(Fit, StraightLineHasTheIntervalsOfTheTextbook) {
    const VectorXd t = VectorXd::LinSpaced(12, 0, 11);
    VectorXd y = 2 + 0.5 * t.array();
    for (Index k = 0; k < 12; ++k) y[k] += k % 3 == 0 ? 0.2 : -0.1;
    const Figures line =
        closed([&](const VectorXd& p) { return VectorXd(p[0] + p[1] * t.array()); }, 2);
    const Fitted found =
        fit(line, {y, std::vector<int>(12, 0), VectorXd::Ones(2)}, unlimited(VectorXd::Zero(2)));
    const double mean = t.mean(), sxx = (t.array() - mean).square().sum();
    const double b = ((t.array() - mean) * y.array()).sum() / sxx, a = y.mean() - b * mean;
    const double s = std::sqrt((y.array() - a - b * t.array()).square().sum() / 10);
    EXPECT_TRUE(found.converged);
    EXPECT_EQ(found.freedom, 10);
    EXPECT_NEAR(found.p[0], a, 1e-9);
    EXPECT_NEAR(found.p[1], b, 1e-9);
    EXPECT_NEAR(found.columns[0].noise, s, 1e-9);
    EXPECT_NEAR(found.interval[1], student_95(10) * s / std::sqrt(sxx), 1e-7);
    EXPECT_NEAR(found.interval[0], student_95(10) * s * std::sqrt(1. / 12 + mean * mean / sxx),
                1e-7);
}

// The share of the intervals of fits to simulated rigs that contain the true number.
double coverage(const Figures& figures, const VectorXd& truth, const VectorXd& start,
                const VectorXd& step, const std::vector<int>& column, double noise, int rigs) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    const VectorXd exact = figures.value(truth);
    int inside = 0;
    for (int rig = 0; rig < rigs; ++rig) {
        VectorXd y = exact;
        for (double& value : y) value += noise * normal(random);
        const Fitted found = fit(figures, {y, column, step}, unlimited(start));
        EXPECT_TRUE(found.converged) << rig;
        inside += static_cast<int>(
            ((found.p - truth).cwiseAbs().array() <= found.interval.array()).count());
    }
    return static_cast<double>(inside) / static_cast<double>(rigs * truth.size());
}

TEST(Fit, IntervalsContainTheTruthInNinetyFiveOfAHundredDecays) {
    const double share = coverage(decay, list_of({3, 1.5}), list_of({2, 1}),
                                  VectorXd::Constant(2, 0.01), std::vector<int>(20, 0), 0.05, 1000);
    EXPECT_GE(share, 0.93);
    EXPECT_LE(share, 0.97);
}

// ---- Robust fits.

Fitted fit_decay(const VectorXd& y, bool robust) {
    return fit(decay, {y, std::vector<int>(20, 0), VectorXd::Constant(2, 0.01), robust},
               unlimited(list_of({2, 1})));
}

// Share of the intervals of robust fits that contain the true numbers; of the 20 values `spoiled`
// are a hundred standard deviations too large.
double robust_coverage(int spoiled) {
    std::mt19937_64 random(6);
    std::normal_distribution<double> normal;
    const VectorXd truth = list_of({3, 1.5}), exact = decay.value(truth);
    constexpr int rigs = 500;
    int inside = 0;
    for (int rig = 0; rig < rigs; ++rig) {
        VectorXd y = exact;
        for (double& value : y) value += 0.02 * normal(random);
        for (int k = 0; k < spoiled; ++k) y[(7 * k + rig) % 20] += 2;
        const Fitted found = fit_decay(y, true);
        EXPECT_TRUE(found.converged) << rig;
        for (Index i = 0; i < 2; ++i)
            inside += std::abs(found.p[i] - truth[i]) <= found.interval[i];
        EXPECT_GE(found.columns[0].outliers, spoiled) << rig;
    }
    return inside / (2.0 * rigs);
}
TEST(Fit, RobustIntervalsContainTheTruthWithAndWithoutOutliers) {
    for (const int spoiled : {0, 2}) {
        const double share = robust_coverage(spoiled);
        EXPECT_GE(share, 0.92) << spoiled;
        EXPECT_LE(share, 0.98) << spoiled;
    }
}

TEST(Fit, OutliersMisleadThePlainFitAndNotTheRobustOne) {
    std::mt19937_64 random(8);
    std::normal_distribution<double> normal;
    const VectorXd truth = list_of({3, 1.5});
    VectorXd y = decay.value(truth);
    for (double& value : y) value += 0.02 * normal(random);
    y[5] += 2, y[13] += 2, y[17] += 2;
    const Fitted plain = fit_decay(y, false), robust = fit_decay(y, true);
    EXPECT_GT(std::abs(plain.p[1] - truth[1]), 0.3);
    for (Index i = 0; i < 2; ++i) {
        EXPECT_LE(std::abs(robust.p[i] - truth[i]), robust.interval[i]);
        EXPECT_LE(robust.interval[i], 0.1 * plain.interval[i]);
    }
    EXPECT_EQ(robust.columns[0].outliers, 3);
    EXPECT_NEAR(robust.columns[0].noise, 0.02, 0.01);
}

// Gradients (1, 1) measured; (1, -1) is not determined. Of an extent of 10, and of 1, the second
// figure moves by 3 and 2 with it; the third only with the sum.
TEST(Fit, ProposesTheFigureThatMovesMostWithAnUndeterminedCombination) {
    const MatrixXd gradient{{3, 0}, {1, -1}, {5, 5}};
    const VectorXd open = std::sqrt(0.5) * list_of({1, -1});
    const Proposal found = proposal(gradient, list_of({10, 1, 1}), open);
    EXPECT_EQ(found.figure, 1);
    EXPECT_NEAR(found.movement, 2, 1e-14);
    EXPECT_NEAR(found.share, 2, 1e-14);
    EXPECT_EQ(proposal(gradient.row(2), list_of({1}), open).figure, -1);
}

// ---- Fits to the references.

// Curves of outputs on branches of a scene: of `outputs` at `points` values of the parameter up to `to`.
struct Curves {
    Varied varied;
    std::vector<Figure> figures = {};
    std::vector<int> column = {};

    Curves& add(const std::string& branch, double to, int points,
                const std::vector<std::string>& outputs) {
        for (std::size_t c = 0; c < outputs.size(); ++c)
            for (int k = 1; k <= points; ++k) {
                figures.push_back(
                    {.name = outputs[c], .branch = branch, .station = to * k / points});
                column.push_back(static_cast<int>(c));
            }
        return *this;
    }
    VectorXd step() const {
        return VectorXd::NullaryExpr(varied.start.size(), [&](Index k) {
            return step_of(varied.numbers[static_cast<std::size_t>(k)]);
        });
    }
    Figures solved() const { return solved_figures(varied, figures, 2); }
    // of numbers, with noise of the standard deviation of each column
    VectorXd measured(const VectorXd& truth, const std::vector<double>& noise) const {
        VectorXd y = solved().value(truth);
        std::mt19937_64 random(7);
        std::normal_distribution<double> normal;
        for (std::size_t k = 0; k < column.size(); ++k)
            y[static_cast<Index>(k)] += noise[static_cast<std::size_t>(column[k])] * normal(random);
        return y;
    }
    Fitted fit(const VectorXd& y) const {
        return compare::fit(solved(), {y, column, step()}, varied);
    }
};

// The rates of a bushing from its displacements, with noise of 0.02 mm.
double coverage_of_a_bushing(int rigs) {
    Curves of{varied_of("single_bushing", {"bushings.mount.rates.x", "bushings.mount.rates.y",
                                           "bushings.mount.rates.z"})};
    of.add("pull", 4000, 5, {"centre_x", "centre_y", "centre_z"});
    of.add("push", -4000, 5, {"centre_x", "centre_y", "centre_z"});
    return coverage(of.solved(), of.varied.start, 1.1 * of.varied.start, of.step(), of.column, 0.02,
                    rigs);
}
TEST(Fit, IntervalsOfTheRatesOfABushingContainTheTruth) {
    EXPECT_GE(coverage_of_a_bushing(40), 0.88);  // 0.95 less three deviations of 120 trials
}
TEST(NightlyFit, IntervalsOfAThousandRigsContainTheTruthInNinetyFiveOfAHundred) {
    const double share = coverage_of_a_bushing(1000);
    EXPECT_GE(share, 0.93);
    EXPECT_LE(share, 0.97);
}

// Every number of a fit is the true one, within half more than its interval, and of those that are
// determined the wrong one alone is away from its start.
void expect_one_is_wrong(const Fitted& found, const Varied& varied, const VectorXd& truth,
                         Index wrong) {
    EXPECT_TRUE(found.converged);
    EXPECT_LE(found.interval[wrong], 5e-4);
    for (Index k = 0; k < truth.size(); ++k) {
        if (!std::isfinite(found.interval[k])) continue;
        const std::string& path = varied.numbers[static_cast<std::size_t>(k)].path;
        EXPECT_LE(std::abs(found.p[k] - truth[k]), 1.5 * found.interval[k]) << path;
        EXPECT_EQ(std::abs(found.p[k] - varied.start[k]) > 1.5 * found.interval[k], k == wrong)
            << path;
    }
}

// A hardpoint that is 2 mm from its place, among the coordinates of both ends of the tie rod that
// curves of toe determine, with noise of a measurement.
TEST(Fit, FindsAHardpointThatIsTwoMillimetresAway) {
    Curves of{varied_of(
        "mcpherson", {"points.tie_rod_inner.x", "points.tie_rod_inner.y", "points.tie_rod_inner.z",
                      "points.arm_rear.z", "points.strut_top.y"})};
    of.add("jounce", 3000, 10, {"toe", "camber", "wheel_centre_y", "wheel_centre_z"});
    of.add("rebound", -3000, 10, {"toe", "camber", "wheel_centre_y", "wheel_centre_z"});
    VectorXd truth = of.varied.start;
    truth[2] += 2e-3;
    const Fitted found = of.fit(of.measured(truth, {1e-3, 1e-3, 0.01, 0.01}));  // deg, mm
    EXPECT_EQ(found.undetermined.cols(), 0) << found.singular_values.transpose();
    expect_one_is_wrong(found, of.varied, truth, 2);
}

// A hardpoint that is 2 mm from its place among all 24 coordinates of the McPherson strut at once, by
// curves of five load cases with noise of 0.1 mdeg and 1 μm. Along the strut's axis its lower point
// moves nothing: that combination is undetermined, and no other.
TEST(NightlyFit, FindsAHardpointThatIsTwoMillimetresAwayAmongTwentyFourCoordinates) {
    std::string yaml = support::text_of(ELASTOCHECK_SCENES "/mcpherson.yaml");
    yaml = support::replaced(yaml, "\nbranches:\n",
                             "  lateral: {on: wheel, at: contact, force: [0, 1, 0]}\n"
                             "  brake: {on: wheel, at: contact, force: [-1, 0, 0]}\n"
                             "  aligning: {on: wheel, moment: [0, 0, 1]}\n\nbranches:\n");
    yaml = support::replaced(yaml, "\nwheel: {body: wheel",
                             "  lateral: {load: lateral, from: -3000, to: 3000, steps: 60}\n"
                             "  braking: {load: brake, from: -3000, to: 3000, steps: 60}\n"
                             "  aligning: {load: aligning, from: -150, to: 150, steps: 60}\n"
                             "\nwheel: {body: wheel");
    std::vector<std::string> paths;
    for (const char* point : {"tie_rod_inner", "arm_front", "arm_rear", "ball_joint",
                              "tie_rod_outer", "strut_top", "strut_lower", "wheel_centre"})
        for (const char* axis : {".z", ".x", ".y"})
            paths.push_back(std::string("points.") + point + axis);
    Curves of{varied_of(
        [&](std::span<const Setting> settings) {
            return parse_scene(yaml, "mcpherson.yaml", settings);
        },
        paths)};
    const std::vector<std::string> outputs{"toe",
                                           "camber",
                                           "caster",
                                           "kingpin_inclination",
                                           "wheel_centre_x",
                                           "wheel_centre_y",
                                           "wheel_centre_z",
                                           "contact_patch_x",
                                           "contact_patch_y",
                                           "K1_coil.compression"};
    of.add("jounce", 3000, 6, outputs).add("rebound", -3000, 6, outputs);
    for (const double sign : {-1.0, 1.0}) {
        of.add("lateral", sign * 3000, 4, outputs).add("braking", sign * 3000, 4, outputs);
        of.add("aligning", sign * 150, 4, outputs);
    }
    VectorXd truth = of.varied.start;
    truth[0] += 2e-3;
    std::vector<double> noise(outputs.size(), 1e-3);
    std::fill_n(noise.begin(), 4, 1e-4);
    const Fitted found = of.fit(of.measured(truth, noise));
    ASSERT_EQ(found.undetermined.cols(), 1) << found.singular_values.transpose();
    for (Index k = 0; k < truth.size(); ++k)
        EXPECT_EQ(std::isfinite(found.interval[k]),
                  !paths[static_cast<std::size_t>(k)].starts_with("points.strut_lower."))
            << paths[static_cast<std::size_t>(k)];
    expect_one_is_wrong(found, of.varied, truth, 0);
}

// Of two parallel springs the data determine the sum of the rates: the difference has no interval
// and is named.
TEST(Fit, CombinationThatTheDataDoNotDetermineIsNamed) {
    Curves of{varied_of("parallel_springs", {"springs.first.rate", "springs.second.rate"})};
    of.add("up", 3000, 8, {"centre_z"});
    const Fitted found = of.fit(of.measured(list_of({33, 47}), {0}));
    EXPECT_NEAR(found.p.sum(), 80, 1e-6);
    ASSERT_EQ(found.undetermined.cols(), 1);
    // in steps of 1 % of 30 and of 45
    EXPECT_NEAR(found.undetermined(0, 0) * 0.30 + found.undetermined(1, 0) * 0.45, 0, 1e-6);
    EXPECT_EQ(found.interval[0], infinity);
    EXPECT_EQ(found.interval[1], infinity);
}

TEST(Fit, FitOfAsManyValuesAsNumbersHasAnInfiniteInterval) {
    Curves of{varied_of("parallel_springs", {"springs.first.rate"})};
    const Fitted found = of.add("up", 3000, 1, {"centre_z"}).fit(list_of({437.5}));
    EXPECT_NEAR(found.p[0], 35, 1e-6);
    EXPECT_EQ(found.interval[0], infinity);
}

}  // namespace
}  // namespace elastocheck::compare
