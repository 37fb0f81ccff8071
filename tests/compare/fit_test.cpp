// compare/design/fit: intervals, undetermined combinations, and a wrong hardpoint.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "compare/design/fit.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double unlimited = std::numeric_limits<double>::infinity();

// Quantiles of Student's distribution from tables.
TEST(Fit, KnowsStudentsDistribution) {
    EXPECT_NEAR(student_95(1), 12.7062, 1e-4);
    EXPECT_NEAR(student_95(2), 4.30265, 1e-5);
    EXPECT_NEAR(student_95(5), 2.57058, 1e-5);
    EXPECT_NEAR(student_95(10), 2.22814, 1e-5);
    EXPECT_NEAR(student_95(30), 2.04227, 1e-5);
    EXPECT_NEAR(student_95(1000), 1.96234, 1e-5);
    EXPECT_NEAR(student_95(1000000), 1.95996, 1e-5);
    EXPECT_EQ(student_95(0), unlimited);
}

// y = a exp(-b t) at 20 times.
Figures decay() {
    const auto rate = [](const VectorXd& p) {
        MatrixXd J(20, 2);
        for (Index k = 0; k < 20; ++k) {
            const double t = 0.1 * static_cast<double>(k), e = std::exp(-p[1] * t);
            J.row(k) << e, -p[0] * t * e;
        }
        return J;
    };
    return {[](const VectorXd& p) {
                return VectorXd(VectorXd::NullaryExpr(20, [&](Index k) {
                    return p[0] * std::exp(-p[1] * 0.1 * static_cast<double>(k));
                }));
            },
            [rate](const VectorXd& p) { return FigureGradient{rate(p)}; }};
}

Measured measured(VectorXd value, std::vector<int> column, VectorXd start, VectorXd step) {
    const auto n = start.size();
    return {.value = std::move(value),
            .column = std::move(column),
            .start = std::move(start),
            .low = VectorXd::Constant(n, -unlimited),
            .high = VectorXd::Constant(n, unlimited),
            .step = std::move(step)};
}

// A straight line a + b t: the intervals of the textbook.
TEST(Fit, OfAStraightLineHasTheIntervalsOfTheTextbook) {
    const VectorXd t = VectorXd::LinSpaced(12, 0, 11);
    VectorXd y = 2 + 0.5 * t.array();
    for (Index k = 0; k < 12; ++k) y[k] += k % 3 == 0 ? 0.2 : -0.1;
    MatrixXd J(12, 2);
    J << VectorXd::Ones(12), t;
    const Figures line{[&](const VectorXd& p) { return VectorXd(J * p); },
                       [&](const VectorXd&) { return FigureGradient{J}; }};
    const Fitted found =
        fit(line, measured(y, std::vector<int>(12, 0), VectorXd::Zero(2), VectorXd::Ones(2)));
    const double mean = t.mean(), sxx = (t.array() - mean).square().sum();
    const double b = ((t.array() - mean) * y.array()).sum() / sxx, a = y.mean() - b * mean;
    const double s = std::sqrt((y.array() - a - b * t.array()).square().sum() / 10);
    EXPECT_TRUE(found.converged);
    EXPECT_EQ(found.freedom, 10);
    EXPECT_NEAR(found.p[0], a, 1e-9);
    EXPECT_NEAR(found.p[1], b, 1e-9);
    EXPECT_NEAR(found.noise[0], s, 1e-9);
    EXPECT_NEAR(found.interval[1], 2.22814 * s / std::sqrt(sxx), 1e-6);
    EXPECT_NEAR(found.interval[0], 2.22814 * s * std::sqrt(1 / 12.0 + mean * mean / sxx), 1e-6);
}

// Share of the intervals that contain the true number.
double coverage(const Figures& figures, const VectorXd& truth, const VectorXd& start,
                const VectorXd& step, const std::vector<int>& column,
                const std::vector<double>& noise, int rigs) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    const VectorXd exact = figures.value(truth);
    int inside = 0;
    for (int rig = 0; rig < rigs; ++rig) {
        VectorXd y = exact;
        for (Index k = 0; k < y.size(); ++k)
            y[k] += noise[static_cast<std::size_t>(column[static_cast<std::size_t>(k)])] *
                    normal(random);
        const Fitted found = fit(figures, measured(y, column, start, step));
        EXPECT_TRUE(found.converged) << rig;
        for (Index i = 0; i < truth.size(); ++i)
            inside += std::abs(found.p[i] - truth[i]) <= found.interval[i];
    }
    return static_cast<double>(inside) / static_cast<double>(rigs * truth.size());
}

TEST(Fit, IntervalsContainTheTruthInNinetyFiveOfAHundredDecays) {
    VectorXd truth(2), start(2);
    truth << 3, 1.5;
    start << 2, 1;
    const double share = coverage(decay(), truth, start, VectorXd::Constant(2, 0.01),
                                  std::vector<int>(20, 0), {0.05}, 1000);
    EXPECT_GE(share, 0.93);
    EXPECT_LE(share, 0.97);
}

// ---- Robust fits.

Measured decaying(const VectorXd& y, bool robust) {
    VectorXd start(2);
    start << 2, 1;
    Measured all = measured(y, std::vector<int>(20, 0), start, VectorXd::Constant(2, 0.01));
    all.robust = robust;
    return all;
}

// Share of the intervals of robust fits that contain the true numbers; of the 20 values `spoiled`
// are a hundred standard deviations too large.
double robust_coverage(int spoiled) {
    std::mt19937_64 random(6);
    std::normal_distribution<double> normal;
    VectorXd truth(2);
    truth << 3, 1.5;
    const VectorXd exact = decay().value(truth);
    constexpr int rigs = 500;
    int inside = 0;
    for (int rig = 0; rig < rigs; ++rig) {
        VectorXd y = exact;
        for (Index k = 0; k < y.size(); ++k) y[k] += 0.02 * normal(random);
        for (int k = 0; k < spoiled; ++k) y[(7 * k + rig) % 20] += 2;
        const Fitted found = fit(decay(), decaying(y, true));
        EXPECT_TRUE(found.converged) << rig;
        for (Index i = 0; i < 2; ++i)
            inside += std::abs(found.p[i] - truth[i]) <= found.interval[i];
        EXPECT_GE(found.outliers[0], spoiled) << rig;
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

TEST(Fit, PlainIsOffByOutliersWhereTheRobustOneIsWithinItsInterval) {
    std::mt19937_64 random(8);
    std::normal_distribution<double> normal;
    VectorXd truth(2);
    truth << 3, 1.5;
    VectorXd y = decay().value(truth);
    for (Index k = 0; k < y.size(); ++k) y[k] += 0.02 * normal(random);
    y[5] += 2, y[13] += 2, y[17] += 2;
    const Fitted plain = fit(decay(), decaying(y, false)), robust = fit(decay(), decaying(y, true));
    EXPECT_GT(std::abs(plain.p[1] - truth[1]), 0.3);
    for (Index i = 0; i < 2; ++i) {
        EXPECT_LE(std::abs(robust.p[i] - truth[i]), robust.interval[i]);
        EXPECT_LE(robust.interval[i], 0.1 * plain.interval[i]);
    }
    EXPECT_EQ(robust.outliers[0], 3);
    EXPECT_NEAR(robust.noise[0], 0.02, 0.01);
}

// ---- Proposals.

// Gradients (1, 1) measured; (1, -1) is not determined. Of an extent of 10, and of 1, the second
// figure moves by 3 and 2 with it; the third only with the sum.
TEST(Fit, ProposesTheFigureThatMovesMostWithAnUndeterminedCombination) {
    const FigureGradient gradient{MatrixXd{{3, 0}, {1, -1}, {5, 5}}};
    const VectorXd value = VectorXd::Zero(3), step = VectorXd::Ones(2);
    VectorXd extent(3);
    extent << 10, 1, 1;
    const MatrixXd open = std::sqrt(0.5) * MatrixXd{{1}, {-1}};
    const auto found = proposals(gradient, value, extent, step, open);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].figure, 1);
    EXPECT_NEAR(found[0].movement, 2, 1e-14);
    EXPECT_NEAR(found[0].share, 2, 1e-14);
    EXPECT_EQ(
        proposals({gradient.rate.row(2)}, value.head(1), extent.tail(1), step, open)[0].figure, -1);
}

// ---- Fits to the references.

struct Rig {
    SceneAt scene;
    std::vector<Number> numbers;
    VectorXd start, step;
};
Rig rig(const std::string& name, const std::vector<std::string>& paths) {
    Rig made;
    const std::string file = std::string(ELASTOCHECK_SCENES "/") + name + ".yaml";
    const auto settings = [paths](const VectorXd& p) {
        std::vector<Setting> all;
        for (std::size_t k = 0; k < paths.size(); ++k)
            all.push_back(setting(paths[k], p[static_cast<Index>(k)]));
        return all;
    };
    made.scene = [file, settings](const VectorXd& p) { return read_scene(file, settings(p)); };
    for (const auto& path : paths)
        for (const auto& number : support::scene(name).numbers)
            if (number.path == path) made.numbers.push_back(number);
    EXPECT_EQ(made.numbers.size(), paths.size());
    const auto n = static_cast<Index>(made.numbers.size());
    made.start.resize(n), made.step.resize(n);
    for (Index k = 0; k < n; ++k) {
        made.start[k] = made.numbers[static_cast<std::size_t>(k)].value;
        made.step[k] = step_of(made.numbers[static_cast<std::size_t>(k)]);
    }
    return made;
}

// Curves of `outputs` on `branch` at `points` values of the parameter up to `to`.
struct Curves {
    std::vector<Figure> figures;
    std::vector<int> column;
};
void add(Curves& curves, const std::string& branch, double to, int points,
         const std::vector<std::string>& outputs) {
    for (std::size_t c = 0; c < outputs.size(); ++c)
        for (int k = 1; k <= points; ++k) {
            curves.figures.push_back({.name = outputs[c], .branch = branch, .at = to * k / points});
            curves.column.push_back(static_cast<int>(c));
        }
}

// The rates of a bushing from its displacements, with noise of 0.02 mm.
double coverage_of_a_bushing(int rigs) {
    const Rig of = rig("single_bushing", {"bushings.mount.rates.x", "bushings.mount.rates.y",
                                          "bushings.mount.rates.z"});
    Curves curves;
    add(curves, "pull", 4000, 5, {"centre_x", "centre_y", "centre_z"});
    add(curves, "push", -4000, 5, {"centre_x", "centre_y", "centre_z"});
    return coverage(solved_figures(of.scene, of.numbers, curves.figures), of.start, 1.1 * of.start,
                    of.step, curves.column, {0.02, 0.02, 0.02}, rigs);
}
TEST(Fit, IntervalsOfTheRatesOfABushingContainTheTruth) {
    const double share = coverage_of_a_bushing(40);
    EXPECT_GE(share, 0.88);  // 0.95 less three standard deviations of 120 trials
}
TEST(NightlyFit, IntervalsOfAThousandRigsContainTheTruthInNinetyFiveOfAHundred) {
    const double share = coverage_of_a_bushing(1000);
    EXPECT_GE(share, 0.93);
    EXPECT_LE(share, 0.97);
}

// A hardpoint that is 2 mm from its place, among the coordinates of both ends of the tie rod that
// curves of toe determine, with noise of a measurement.
TEST(Fit, FindsAHardpointThatIsTwoMillimetresAway) {
    const std::vector<std::string> paths{"points.tie_rod_inner.x", "points.tie_rod_inner.y",
                                         "points.tie_rod_inner.z", "points.arm_rear.z",
                                         "points.strut_top.y"};
    const Rig of = rig("mcpherson", paths);
    Curves curves;
    add(curves, "jounce", 3000, 10, {"toe", "camber", "wheel_centre_y", "wheel_centre_z"});
    add(curves, "rebound", -3000, 10, {"toe", "camber", "wheel_centre_y", "wheel_centre_z"});
    const Figures figures = solved_figures(of.scene, of.numbers, curves.figures);
    VectorXd truth = of.start;
    truth[2] += 2e-3;
    VectorXd y = figures.value(truth);
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    const double noise[]{1e-3, 1e-3, 0.01, 0.01};  // deg, deg, mm, mm
    for (Index k = 0; k < y.size(); ++k)
        y[k] += noise[curves.column[static_cast<std::size_t>(k)]] * normal(random);
    const Fitted found = fit(figures, measured(y, curves.column, of.start, of.step));
    EXPECT_TRUE(found.converged);
    EXPECT_EQ(found.undetermined.cols(), 0) << found.singular_values.transpose();
    EXPECT_LE(found.interval[2], 5e-4);
    EXPECT_NEAR(found.p[2] - of.start[2], 2e-3, found.interval[2]);
    for (Index k = 0; k < truth.size(); ++k)
        EXPECT_LE(std::abs(found.p[k] - truth[k]), 1.5 * found.interval[k])
            << paths[static_cast<std::size_t>(k)];
    // Only that one is away from its place.
    for (Index k = 0; k < truth.size(); ++k)
        EXPECT_EQ(std::abs(found.p[k] - of.start[k]) > 1.5 * found.interval[k], k == 2)
            << paths[static_cast<std::size_t>(k)];
}

// A hardpoint that is 2 mm from its place among all 24 coordinates of the McPherson strut at once, by
// curves of five load cases with noise of 0.1 mdeg and 1 μm. Along the strut's axis its lower point
// moves nothing: that combination is undetermined, and no other.
TEST(NightlyFit, FindsAHardpointThatIsTwoMillimetresAwayAmongTwentyFourCoordinates) {
    std::ifstream in(ELASTOCHECK_SCENES "/mcpherson.yaml");
    std::stringstream text;
    text << in.rdbuf();
    std::string yaml = text.str();
    const auto insert_before = [&](const std::string& line, const std::string& added) {
        const auto at = yaml.find(line);
        ASSERT_NE(at, std::string::npos) << line;
        yaml.insert(at, added);
    };
    insert_before("\nbranches:\n",
                  "  lateral: {on: wheel, at: contact, force: [0, 1, 0]}\n"
                  "  brake: {on: wheel, at: contact, force: [-1, 0, 0]}\n"
                  "  aligning: {on: wheel, moment: [0, 0, 1]}\n");
    insert_before("\nwheel: {body: wheel",
                  "  lateral: {load: lateral, from: -3000, to: 3000, steps: 60}\n"
                  "  braking: {load: brake, from: -3000, to: 3000, steps: 60}\n"
                  "  aligning: {load: aligning, from: -150, to: 150, steps: 60}\n");
    Rig of;
    std::vector<std::string> paths;
    for (const char* point : {"arm_front", "arm_rear", "ball_joint", "tie_rod_inner",
                              "tie_rod_outer", "strut_top", "strut_lower", "wheel_centre"})
        for (const char* axis : {".x", ".y", ".z"})
            paths.push_back(std::string("points.") + point + axis);
    of.scene = [&](const VectorXd& p) {
        std::vector<Setting> settings;
        for (std::size_t k = 0; k < paths.size(); ++k)
            settings.push_back(setting(paths[k], p[static_cast<Index>(k)]));
        return parse_scene(yaml, "mcpherson.yaml", settings);
    };
    const auto n = static_cast<Index>(paths.size());
    of.start.resize(n), of.step.resize(n);
    for (const auto& path : paths)
        for (const auto& number : parse_scene(yaml, "mcpherson.yaml").numbers)
            if (number.path == path) {
                const auto k = static_cast<Index>(of.numbers.size());
                of.start[k] = number.value, of.step[k] = step_of(number);
                of.numbers.push_back(number);
            }
    ASSERT_EQ(of.numbers.size(), 24u);
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
    Curves curves;
    add(curves, "jounce", 3000, 6, outputs);
    add(curves, "rebound", -3000, 6, outputs);
    for (const double sign : {-1.0, 1.0}) {
        add(curves, "lateral", sign * 3000, 4, outputs);
        add(curves, "braking", sign * 3000, 4, outputs);
        add(curves, "aligning", sign * 150, 4, outputs);
    }
    const Figures figures = solved_figures(of.scene, of.numbers, curves.figures, 2);
    const auto wrong =
        static_cast<Index>(std::ranges::find(paths, "points.tie_rod_inner.z") - paths.begin());
    VectorXd truth = of.start;
    truth[wrong] += 2e-3;
    VectorXd y = figures.value(truth);
    ASSERT_TRUE(y.allFinite());
    std::mt19937_64 random(9);
    std::normal_distribution<double> normal;
    for (Index k = 0; k < y.size(); ++k)
        y[k] += (curves.column[static_cast<std::size_t>(k)] < 4 ? 1e-4 : 1e-3) * normal(random);
    const Fitted found = fit(figures, measured(y, curves.column, of.start, of.step));
    EXPECT_TRUE(found.converged);
    ASSERT_EQ(found.undetermined.cols(), 1) << found.singular_values.transpose();
    EXPECT_LE(found.interval[wrong], 5e-4);
    for (Index k = 0; k < n; ++k) {
        const std::string& path = paths[static_cast<std::size_t>(k)];
        EXPECT_EQ(std::isfinite(found.interval[k]), !path.starts_with("points.strut_lower."))
            << path;
        if (!std::isfinite(found.interval[k])) continue;
        EXPECT_LE(std::abs(found.p[k] - truth[k]), 1.5 * found.interval[k]) << path;
        EXPECT_EQ(std::abs(found.p[k] - of.start[k]) > 1.5 * found.interval[k], k == wrong) << path;
    }
}

// Of two parallel springs the data determine the sum of the rates: the difference has no interval
// and is named.
TEST(Fit, NamesACombinationThatTheDataDoNotDetermine) {
    const Rig of = rig("parallel_springs", {"springs.first.rate", "springs.second.rate"});
    Curves curves;
    add(curves, "up", 3000, 8, {"centre_z"});
    const Figures figures = solved_figures(of.scene, of.numbers, curves.figures);
    VectorXd truth(2);
    truth << 33, 47;
    const Fitted found =
        fit(figures, measured(figures.value(truth), curves.column, of.start, of.step));
    EXPECT_NEAR(found.p.sum(), 80, 1e-6);
    ASSERT_EQ(found.undetermined.cols(), 1);
    // in steps of 1 % of 30 and of 45
    EXPECT_NEAR(found.undetermined(0, 0) * 0.30 + found.undetermined(1, 0) * 0.45, 0, 1e-6);
    EXPECT_EQ(found.interval[0], unlimited);
    EXPECT_EQ(found.interval[1], unlimited);
}

TEST(Fit, WithoutMoreValuesThanNumbersHasNoInterval) {
    const Rig of = rig("parallel_springs", {"springs.first.rate"});
    Curves curves;
    add(curves, "up", 3000, 1, {"centre_z"});
    const Figures figures = solved_figures(of.scene, of.numbers, curves.figures);
    VectorXd y(1);
    y << 437.5;
    const Fitted found = fit(figures, measured(y, curves.column, of.start, of.step));
    EXPECT_NEAR(found.p[0], 35, 1e-6);
    EXPECT_EQ(found.interval[0], unlimited);
}

}  // namespace
}  // namespace elastocheck::compare
