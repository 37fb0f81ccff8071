// Step-size convergence: orders, limits and error bands of exact laws, published examples, and
// sequences that must not get an order.
#include "compare/studies/convergence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Floors exact;

const std::vector<std::vector<double>> step_counts = {
    {10, 20, 40, 80, 160},
    {10, 40, 160, 640},
    {5, 10, 20, 30, 40, 60},
    {7, 8, 11, 19, 23, 40, 41},
    {10, 20, 30},
    {3, 30, 31},
    {10, 13, 16, 20, 25, 31},
    {1, 2, 4, 8, 16, 32, 64, 128},
    {100, 150, 200},
    {1, 2, 3, 4, 5, 6, 7, 8, 9},
    {10, 11, 100, 110, 1000},
};

template <class Law>
std::vector<Level> sequence(const std::vector<double>& steps, Law&& law) {
    std::vector<Level> levels;
    for (const double n : steps) levels.push_back({n, law(1 / n)});
    return levels;
}

// Values at doubling step counts.
std::vector<Level> doubling(const std::vector<double>& values) {
    std::vector<Level> levels;
    for (const double value : values)
        levels.push_back({std::ldexp(10.0, static_cast<int>(levels.size())), value});
    return levels;
}

std::string text(const StepConvergence& c) {
    return std::string(name(c.behaviour)) + ", order " + std::to_string(c.order) + " +- " +
           std::to_string(c.order_error) + ", limit " + std::to_string(c.limit) + " +- " +
           std::to_string(c.band) + ", levels " + std::to_string(c.first) + " + " +
           std::to_string(c.count);
}

void expect_no_order(const StepConvergence& c, Behaviour expected) {
    EXPECT_EQ(c.behaviour, expected) << text(c);
    EXPECT_TRUE(std::isnan(c.order)) << text(c);
    EXPECT_TRUE(std::isnan(c.order_error)) << text(c);
    EXPECT_FALSE(c.as_formal);
}

void expect_nothing(const StepConvergence& c, Behaviour expected) {
    expect_no_order(c, expected);
    EXPECT_TRUE(std::isnan(c.limit) && std::isnan(c.band) && std::isnan(c.finest_error)) << text(c);
    EXPECT_EQ(c.count, 0);
}

// ---- exact laws ----

TEST(Convergence, ExactPowerLawGivesItsOrderAndLimitForAnyStepRatio) {
    for (const auto& steps : step_counts)
        for (const double p : {0.5, 1.0, 2.0, 3.0, 4.0})
            for (const double L : {0.0, -1.68, 113.0})
                for (const double C : {2.0, -0.3}) {
                    const auto levels =
                        sequence(steps, [&](double h) { return L + C * std::pow(h, p); });
                    const auto c = step_convergence(levels, p, exact);
                    ASSERT_EQ(c.behaviour, Behaviour::converging) << text(c) << " expected " << p;
                    EXPECT_TRUE(c.as_formal) << text(c) << " expected " << p;
                    // Rounding of the values, relative to the smallest difference between levels.
                    double smallest = infinity;
                    for (std::size_t k = 1; k < levels.size(); ++k)
                        smallest =
                            std::min(smallest, std::abs(levels[k].value - levels[k - 1].value));
                    const double rounding = 2.3e-16 * (std::abs(L) + 1) / smallest;
                    EXPECT_LE(std::abs(c.order - p), 1e-12 + 20 * rounding)
                        << text(c) << " of " << p;
                    EXPECT_LE(std::abs(c.limit - L), c.band + 1e-15) << text(c) << " of " << L;
                }
}

TEST(Convergence, OrdersNearZeroKeepTheirSign) {
    for (const auto& steps : step_counts)
        for (const double p : {0.005, 0.02, 0.04, 0.06}) {
            const auto c = step_convergence(
                sequence(steps, [p](double h) { return std::pow(h, p); }), nan, exact);
            ASSERT_EQ(c.behaviour, Behaviour::converging) << p;
            EXPECT_NEAR(c.order, p, 1e-9);
            EXPECT_NEAR(c.limit, 0, 1e-6);
            expect_nothing(
                step_convergence(sequence(steps, [p](double h) { return std::pow(h, -p); }), nan,
                                 exact),
                Behaviour::diverging);
        }
}

TEST(Convergence, ScaleSignAndOffsetOfTheValuesDoNotChangeTheResult) {
    const auto law = [](double h) { return 0.4 + h + 3 * h * h; };
    const std::vector<double> steps = {10, 20, 40, 80, 160, 320};
    const auto c = step_convergence(sequence(steps, law), 1, exact);
    for (const double scale : {-1.0, 1e-6, 1e6})
        for (const double offset : {0.0, 5.0}) {
            const auto other = step_convergence(
                sequence(steps, [&](double h) { return scale * (law(h) + offset); }), 1, exact);
            EXPECT_EQ(other.count, c.count);
            EXPECT_NEAR(other.order, c.order, 1e-9);
            EXPECT_NEAR(other.order_error, c.order_error, 1e-9);
            EXPECT_NEAR(other.limit / scale - offset, c.limit, 1e-9);
            EXPECT_NEAR(other.band / std::abs(scale), c.band, 1e-9);
        }
}

// ---- published examples ----

// Celik, Ghia, Roache, Freitas, Coleman, Raad: Procedure for Estimation and Reporting of
// Uncertainty Due to Discretization in CFD Applications, J. Fluids Eng. 130 (2008) 078001, Table 1,
// first two columns. Two-dimensional grids: steps = sqrt(cells). Tolerance: half a unit of the last
// printed digit.
struct Published {
    double cells[3], phi[3];             // finest first
    double p, phi_ext, e_a, e_ext, gci;  // e_a, e_ext, GCI in per cent; NaN: not compared
};
const Published monotone[] = {
    {{18000, 8000, 4500}, {6.063, 5.972, 5.863}, 1.53, 6.1685, 1.5, 1.7, 2.2},
    {{18000, 4500, 980}, {10.7880, 10.7250, 10.6050}, 0.75, 10.8801, 0.6, nan, 1.1},
};
const Published oscillating = {
    {18000, 4500, 980}, {6.0042, 5.9624, 6.0909}, 1.51, 6.0269, 0.7, 0.4, 0.5};

std::vector<Level> levels_of(const Published& example) {
    std::vector<Level> levels;
    for (int k : {2, 1, 0}) levels.push_back({std::sqrt(example.cells[k]), example.phi[k]});
    return levels;
}

// The order as defined there: p = |ln|e32/e21| + q(p)| / ln r21,
// q = ln((r21^p - s) / (r32^p - s)), s = sgn(e32/e21).
double fixed_point(const std::vector<Level>& levels) {
    const double r21 = levels[2].steps / levels[1].steps, r32 = levels[1].steps / levels[0].steps;
    const double ratio = (levels[0].value - levels[1].value) / (levels[1].value - levels[2].value);
    const double s = ratio > 0 ? 1 : -1;
    double p = 1;
    for (int k = 0; k < 2000; ++k)
        p = std::abs(std::log(std::abs(ratio)) +
                     std::log((std::pow(r21, p) - s) / (std::pow(r32, p) - s))) /
            std::log(r21);
    return p;
}

TEST(Convergence, PublishedGridStudiesAreReproduced) {
    for (const auto& example : monotone) {
        const auto levels = levels_of(example);
        const auto c = step_convergence(levels, nan, exact);
        const double finest = levels.back().value, before = levels[1].value;
        ASSERT_EQ(c.behaviour, Behaviour::converging);
        EXPECT_NEAR(c.order, example.p, 0.005);
        EXPECT_NEAR(c.limit, example.phi_ext, 0.00005);
        EXPECT_NEAR(100 * std::abs((finest - before) / finest), example.e_a, 0.05);
        if (std::isfinite(example.e_ext)) {
            EXPECT_NEAR(100 * c.finest_error / c.limit, example.e_ext, 0.05);
        }
        EXPECT_NEAR(100 * 1.25 * c.finest_error / finest, example.gci, 0.05);
        // three levels and no formal order: not 1.25
        EXPECT_NEAR(c.band, 3 * c.finest_error, 1e-12);
    }
}

TEST(Convergence, PublishedOscillatingStudyHasNoOrder) {
    const auto levels = levels_of(oscillating);
    const double p = fixed_point(levels);  // for which the published procedure gives an order
    EXPECT_NEAR(p, oscillating.p, 0.005);
    const double factor = std::pow(2.0, p);
    EXPECT_NEAR((factor * 6.0042 - 5.9624) / (factor - 1), oscillating.phi_ext, 0.00005);
    expect_nothing(step_convergence(levels, 2, exact), Behaviour::oscillating);
}

TEST(Convergence, ThreeLevelsGiveTheOrderOfThePublishedFixedPoint) {
    std::mt19937 random(20080701);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int trial = 0; trial < 500; ++trial) {
        // The iteration contracts while r32 is not far from r21.
        const double r32 = 1.3 + uniform(random), r21 = r32 * (0.9 + 0.3 * uniform(random)),
                     p = 0.3 + 4 * uniform(random);
        const double n = 10;
        const auto levels =
            sequence({n, n * r32, n * r32 * r21}, [p](double h) { return 3 - std::pow(h, p); });
        const auto c = step_convergence(levels, nan, exact);
        ASSERT_EQ(c.behaviour, Behaviour::converging);
        EXPECT_NEAR(c.order, fixed_point(levels), 1e-9);
    }
}

// ---- pollution and noise ----

TEST(Convergence, LimitIsWithinItsBandDespiteHigherOrderTerms) {
    // value = 1 + h^p + D h^(p+q) from D = 0.1 to 1000 of either sign: beyond the asymptotic range,
    // through a turn, and where the levels show the higher term only.
    int formal = 0, compared = 0;
    for (const double p : {1.0, 2.0, 3.0})
        for (const double q : {1.0, 2.0})
            for (const auto& steps :
                 std::vector<std::vector<double>>{{10, 20, 40, 80, 160, 320},
                                                  {10, 15, 20, 30, 40, 60, 80, 120},
                                                  {10, 40, 160, 640},
                                                  {10, 20, 40, 80},
                                                  {10, 20, 40}})
                for (int k = 0; k <= 80; ++k)
                    for (const double sign : {-1.0, 1.0}) {
                        const double D = sign * std::pow(10, -1 + k / 20.0);
                        const auto levels = sequence(steps, [&](double h) {
                            return 1 + std::pow(h, p) + D * std::pow(h, p + q);
                        });
                        const auto c = step_convergence(levels, p, exact);
                        if (c.behaviour != Behaviour::converging) continue;
                        EXPECT_LE(std::abs(c.limit - 1), c.band)
                            << p << " " << q << " D " << D << ": " << text(c);
                        formal += c.as_formal;
                        ++compared;
                    }
    EXPECT_GE(compared, 4500);
    EXPECT_GE(formal, 2000);
}

TEST(Convergence, LevelsOutsideTheAsymptoticRangeAreExcluded) {
    const auto law = [](double h) { return 4 + h + 40 * std::pow(h, 3); };
    const auto c = step_convergence(sequence({2, 4, 8, 16, 32, 64, 128, 256}, law), 1, exact);
    ASSERT_EQ(c.behaviour, Behaviour::converging);
    EXPECT_EQ(c.first, 4) << text(c);
    EXPECT_EQ(c.count, 4) << text(c);
    EXPECT_TRUE(c.as_formal) << text(c);
    EXPECT_LE(std::abs(c.order - 1), 0.06) << text(c);
    EXPECT_LE(std::abs(c.limit - 4), (law(1 / 256.0) - 4) / 10) << text(c);
    for (const double p : {1.0, 2.0}) {  // an exact law keeps all its levels
        const auto all = step_convergence(
            sequence({2, 4, 8, 16, 32, 64, 128}, [p](double h) { return 4 + std::pow(h, p); }), p,
            exact);
        EXPECT_EQ(all.first, 0) << text(all);
        EXPECT_EQ(all.count, 7) << text(all);
    }
}

TEST(Convergence, StandardErrorAndBandCoverNoiseOfKnownSize) {
    std::mt19937 random(4711);
    for (const double p : {1.0, 2.0})
        for (const double sigma : {1e-3, 1e-4, 1e-5}) {
            std::normal_distribution<double> noise(0, sigma);
            int converging = 0, order = 0, limit = 0;
            for (int trial = 0; trial < 200; ++trial) {
                const auto levels =
                    sequence({2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64},
                             [&](double h) { return -1.7 + std::pow(h, p) + noise(random); });
                const auto c = step_convergence(levels, p, {4 * sigma, 0});
                if (c.behaviour != Behaviour::converging) continue;
                ++converging;
                order += std::abs(c.order - p) <= 3 * c.order_error;
                limit += std::abs(c.limit + 1.7) <= c.band;
            }
            EXPECT_GE(converging, 190);
            EXPECT_GE(order, 180);
            EXPECT_GE(limit, 190);
        }
}

TEST(Convergence, FalsePositivesOfPureNoiseFallWithTheNumberOfLevels) {
    // No floor is given: three random numbers are monotone one time in three by chance.
    std::mt19937 random(99);
    std::normal_distribution<double> noise(0, 1);
    const auto taken = [&](int count) {
        int converging = 0, formal = 0;
        for (int trial = 0; trial < 1000; ++trial) {
            std::vector<double> values;
            for (int k = 0; k < count; ++k) values.push_back(noise(random));
            const auto c = step_convergence(doubling(values), 1, exact);
            converging += c.behaviour == Behaviour::converging;
            formal += c.as_formal;
        }
        EXPECT_LE(formal, 25);
        return converging;
    };
    EXPECT_LE(taken(3), 170);
    EXPECT_LE(taken(4), 200);
    EXPECT_LE(taken(6), 80);
    EXPECT_LE(taken(12), 45);
}

TEST(Convergence, StandardErrorsEqualThoseOfPerturbedValues) {
    // A poor fit, whose scatter determines the band. Standard errors are σ |J| with J the
    // sensitivity to every value, so that of the limit is the order's times |J_limit| / |J_order|.
    const auto levels = sequence({10, 40, 160, 640}, [](double h) { return 1 + h + 66 * h * h; });
    const auto c = step_convergence(levels, nan, exact);
    ASSERT_EQ(c.count, 4);
    ASSERT_GT(c.band, 3.01 * c.finest_error);
    double of_order = 0, of_limit = 0;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        auto up = levels, down = levels;
        up[k].value += 1e-6;
        down[k].value -= 1e-6;
        const auto above = step_convergence(up, nan, exact),
                   below = step_convergence(down, nan, exact);
        of_order = std::hypot(of_order, above.order - below.order);
        of_limit = std::hypot(of_limit, above.limit - below.limit);
    }
    EXPECT_NEAR(c.band / (2 * c.order_error) / (of_limit / of_order), 1, 0.05) << text(c);
}

// ---- safety factor ----

TEST(Convergence, TheSafetyFactorIsSmallOnlyForTheFormalOrderOnFourLevels) {
    const auto law = [](double h) { return 2 + h; };
    const auto four = sequence({10, 20, 40, 80}, law), three = sequence({10, 20, 40}, law);
    const auto factor = [](const StepConvergence& c) { return c.band / c.finest_error; };
    EXPECT_NEAR(factor(step_convergence(four, 1, exact)), 1.25, 1e-9);
    EXPECT_NEAR(factor(step_convergence(three, 1, exact)), 3, 1e-9);
    EXPECT_NEAR(factor(step_convergence(four, 2, exact)), 3, 1e-9);
    EXPECT_NEAR(factor(step_convergence(four, nan, exact)), 3, 1e-9);
    EXPECT_TRUE(step_convergence(three, 1, exact).as_formal);
    EXPECT_FALSE(step_convergence(four, 2, exact).as_formal);
    EXPECT_FALSE(step_convergence(four, nan, exact).as_formal);
    // A higher order than the formal one may hide it: the band is wider than three times
    // the step error.
    EXPECT_GT(factor(step_convergence(four, 0.5, exact)), 3.5);
}

TEST(Convergence, OrderWithinTenPercentOfTheFormalOrderCountsAsFormal) {
    const std::vector<double> steps = {10, 20, 40, 80, 160};
    const auto as_formal = [&](double order, double formal) {
        return step_convergence(sequence(steps, [&](double h) { return std::pow(h, order); }),
                                formal, exact)
            .as_formal;
    };
    for (const double formal : {0.5, 1.0, 2.0, 3.0, 4.0})
        for (const double sign : {-1.0, 1.0}) {
            const double allowed = std::min(0.25, 0.1 * formal);
            EXPECT_TRUE(as_formal(formal + 0.98 * sign * allowed, formal)) << formal;
            EXPECT_FALSE(as_formal(formal + 1.02 * sign * allowed, formal)) << formal;
        }
}

// ---- classification of short sequences ----

// Values at doubling step counts, and what is read from them at the formal order 1.
TEST(Convergence, SequencesAreClassifiedByTheirFinestLevels) {
    using enum Behaviour;
    const double next = std::nextafter(113.0, 200.0);
    const std::vector<double> near{1.0008, 1.0004, 1.0002, 1.0001};
    const struct {
        const char* why;
        std::vector<double> values;
        Floors floors;
        Behaviour behaviour;
        double limit = nan, order = nan;  // NaN: none
        int first = -1;                   // -1: not compared
    } cases[] = {
        {"no levels", {}, exact, too_few_levels},
        {"one level", {1}, exact, too_few_levels},
        {"two levels", {1, 0.5}, exact, too_few_levels},
        {"two equal levels", {1, 1}, exact, too_few_levels},
        // by the published formula, |ln ratio|, these have the orders 0.58, 1 and 5
        {"differences grow slowly", {0, 1, 2.5}, exact, diverging},
        {"differences double", {0, 1, 3}, exact, diverging},
        {"differences grow by 32", {0, 1, 33}, exact, diverging},
        {"growth at the end only", {1, 0.5, 0.25, 0.125, 0.0625, -0.2}, exact, diverging},
        {"growth after a difference at rounding", {0, 1, 1 + 1e-9, 2}, exact, diverging},
        {"growth at the coarse end only", {0, 0.05, 0.25, 0.35}, exact, converging, 0.45, 1, 1},
        {"a turn at the finest level", {4, 3, 2.5, 2.25, 2.5}, exact, oscillating},
        {"a turn in between", {1, 0.5, 0.5 + 1e-10, 0.3, 0.2}, exact, oscillating},
        {"several turns, then three levels", {0, 1, 0, 1, 1.5}, exact, oscillating},
        {"several turns, then four", {1, 0, 2, 1, 0.5, 0.25}, exact, converging, 0, 1, 2},
        {"rounding of the values", {113, next, 113, next}, exact, round_off_floor, next},
        {"the same without floors", {113, next, 113, next}, {nan, nan}, round_off_floor, next},
        {"equal after turns", {1, -1, 0.5, 0.2, 0.2, 0.2}, exact, round_off_floor, 0.2},
        {"equal after growth", {0, 1, 3, 3, 3}, exact, round_off_floor, 3},
        {"three levels, two equal", {1, 2, 2}, exact, round_off_floor, 2},
        {"within the reference's uncertainty", near, {0, 1e-3}, reference_floor, 1.0001},
        {"above it", near, {0, 1e-4}, converging, 1, 1, 0},
        {"without a reference", near, {0, nan}, converging, 1, 1, 0},
        {"growth within it", {1, 1.0001, 1, 1.0003}, {0, 1e-3}, reference_floor, 1.0003},
    };
    for (const auto& [why, values, floors, behaviour, limit, order, first] : cases) {
        const auto c = step_convergence(doubling(values), 1, floors);
        EXPECT_EQ(c.behaviour, behaviour) << why << ": " << text(c);
        if (std::isnan(order)) expect_no_order(c, behaviour);
        if (std::isnan(limit)) expect_nothing(c, behaviour);
        const auto same = [](double a, double b) {
            return std::isnan(b) ? std::isnan(a) : std::abs(a - b) <= 1e-9;
        };
        EXPECT_TRUE(same(c.limit, limit) && same(c.order, order)) << why << ": " << text(c);
        EXPECT_TRUE(first < 0 || c.first == first) << why << ": " << text(c);
    }
    EXPECT_EQ(step_convergence(doubling(near), 1, {0, 1e-3}).band, 1e-3);
    // A difference below the stated rounding is no turn.
    EXPECT_EQ(step_convergence(doubling({1, 0.5, 0.5 + 1e-10, 0.3, 0.2}), 1, {1e-9, 0}).behaviour,
              converging);
}

// ---- sequences without an order ----

TEST(Convergence, DivergenceNeverHasAPositiveOrder) {
    for (const auto& steps : step_counts)
        for (const double p : {-0.05, -0.5, -1.0, -2.0, -5.0})
            for (const double C : {1.0, -1e-3}) {
                const auto c = step_convergence(
                    sequence(steps, [&](double h) { return 7 + C * std::pow(h, p); }), 1, exact);
                expect_nothing(c, Behaviour::diverging);
            }
    for (const auto& steps : step_counts)  // logarithmic drift, p = 0: grows past any limit too
        expect_nothing(
            step_convergence(sequence(steps, [](double h) { return std::log(h) - 1e-3 / h; }), 1,
                             exact),
            Behaviour::diverging);
}

TEST(Convergence, NoisyDivergenceIsNotClassifiedAsConverging) {
    std::mt19937 random(31);
    std::normal_distribution<double> noise(0, 1);
    int converging = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const auto levels =
            sequence({1, 2, 4, 8, 16, 32}, [&](double h) { return 1 / h + 0.5 * noise(random); });
        converging += step_convergence(levels, 1, exact).behaviour == Behaviour::converging;
    }
    EXPECT_EQ(converging, 0);
}

TEST(Convergence, OscillationHasNoOrder) {
    for (const double ratio : {-0.1, -0.5, -0.9, -1.0, -1.5})
        for (const int count : {3, 4, 5, 8}) {
            std::vector<double> values;
            for (int k = 0; k < count; ++k) values.push_back(3 + std::pow(ratio, k));
            expect_nothing(step_convergence(doubling(values), 1, exact), Behaviour::oscillating);
        }
}

TEST(Convergence, CoarseLevelsBeforeATurnOfTheErrorAreExcluded) {
    // Step error and higher terms cancel at the coarse end: 10 steps look better than 80.
    const auto law = [](double h) { return 2 + h - 10 * h * h; };
    const auto levels = sequence({10, 20, 40, 80, 160, 320, 640, 1280}, law);
    EXPECT_LT(std::abs(levels[0].value - 2), std::abs(levels[3].value - 2));
    const auto c = step_convergence(levels, 1, exact);
    ASSERT_EQ(c.behaviour, Behaviour::converging);
    EXPECT_GE(c.first, 1);
    EXPECT_TRUE(c.as_formal) << text(c);
    EXPECT_LE(std::abs(c.limit - 2), c.band) << text(c);
}

TEST(Convergence, ConstantSequenceIsAtTheRoundOffFloor) {
    for (const double value : {0.0, -1.68, 1e12}) {
        const auto c = step_convergence(doubling({value, value, value, value}), 1, exact);
        expect_no_order(c, Behaviour::round_off_floor);
        EXPECT_EQ(c.limit, value);
        EXPECT_TRUE(c.band >= 0 && c.band <= 1e-15 * std::abs(value));
    }
    std::mt19937 random(5);
    std::uniform_real_distribution<double> jitter(-0.5e-9, 0.5e-9);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> values;
        for (int k = 0; k < 6; ++k) values.push_back(3 + jitter(random));
        const auto c = step_convergence(doubling(values), 1, {1e-9, 0});
        expect_no_order(c, Behaviour::round_off_floor);
        EXPECT_LE(std::abs(c.limit - 3), c.band);
        EXPECT_LE(c.band, 1e-9);
    }
}

TEST(Convergence, LevelsAtRoundOffAreExcludedFromTheOrderAndGiveTheLimit) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> jitter(-0.5e-10, 0.5e-10);
    for (const double p : {3.0, 4.0}) {
        const auto levels =
            sequence({4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768, 65536},
                     [&](double h) { return 5 + std::pow(h, p) + jitter(random); });
        const auto c = step_convergence(levels, p, {1e-10, 0});
        ASSERT_EQ(c.behaviour, Behaviour::converging) << text(c);
        EXPECT_LT(c.first + c.count, static_cast<int>(levels.size()));
        EXPECT_TRUE(c.as_formal) << text(c);
        EXPECT_NEAR(c.order, p, 1e-3);
        EXPECT_EQ(c.limit, levels.back().value);
        EXPECT_LE(std::abs(c.limit - 5), c.band);
        EXPECT_LE(c.band, 3e-10);
    }
}

TEST(Convergence, NonFiniteLevelIsReported) {
    for (const double bad : {nan, infinity, -infinity})
        for (int count = 1; count <= 6; ++count)
            for (int at = 0; at < count; ++at) {
                auto levels = sequence({10, 20, 40, 80, 160, 320}, [](double h) { return 1 + h; });
                levels.resize(static_cast<std::size_t>(count));
                const auto sound = levels;
                levels[static_cast<std::size_t>(at)].value = bad;
                expect_nothing(step_convergence(levels, 1, {1, 1}), Behaviour::not_finite);
                EXPECT_TRUE(std::isnan(order_of(levels, 0).order));
                EXPECT_EQ(order_of(levels, 0).count, 0);
                levels = sound;
                levels[static_cast<std::size_t>(at)].steps = bad;
                expect_nothing(step_convergence(levels, 1, exact), Behaviour::not_finite);
                EXPECT_TRUE(std::isnan(order_of(levels, 0).order));
            }
}

TEST(Convergence, StepsMustBePositiveAndIncrease) {
    for (const auto& steps :
         std::vector<std::vector<double>>{{10, 10, 20}, {40, 20, 10}, {0, 1, 2}, {-1, 1, 2}}) {
        const auto levels = sequence(steps, [](double h) { return std::isfinite(h) ? h : 0; });
        EXPECT_THROW(step_convergence(levels, 1, exact), std::invalid_argument);
        EXPECT_THROW(order_of(levels, 0), std::invalid_argument);
    }
}

TEST(Convergence, OrderBeyondTheSearchRangeIsReportedAsTenWithoutAnError) {
    for (const auto& values :
         std::vector<std::vector<double>>{{1, 1e-5, 1e-10}, {1, 1e-4, 1e-8, 1e-11}}) {
        const auto c = step_convergence(doubling(values), 1, {1e-13, 0});
        ASSERT_EQ(c.behaviour, Behaviour::converging);
        EXPECT_NEAR(c.order, 10, 1e-6);
        EXPECT_TRUE(std::isnan(c.order_error));
        EXPECT_FALSE(c.as_formal);
        EXPECT_LE(std::abs(c.limit), c.band);
    }
}

// ---- order against a known truth ----

TEST(FittedOrder, PowerLawHasItsSignedExponent) {
    for (const auto& steps : step_counts)
        for (const double p : {-2.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0})
            for (const double C : {3.0, -1e-6}) {
                const auto fit =
                    order_of(sequence(steps, [&](double h) { return C * std::pow(h, p); }), 0);
                EXPECT_NEAR(fit.order, p, 1e-12);
                EXPECT_LE(fit.order_error, 1e-12);
                EXPECT_EQ(fit.count, static_cast<int>(steps.size()));
            }
}

TEST(FittedOrder, ErrorsBelowTheFloorOrBeforeAZeroCrossingAreNotUsed) {
    auto errors = sequence({10, 20, 40, 80, 160, 320}, [](double h) { return h * h; });
    errors[4].value = 1e-9;
    errors[5].value = -3e-9;
    const auto fit = order_of(errors, 1e-8);
    EXPECT_NEAR(fit.order, 2, 1e-12);
    EXPECT_EQ(fit.first, 0);
    EXPECT_EQ(fit.count, 4);
    errors[1].value = 0;  // a zero crossing: only finer levels count
    const auto later = order_of(errors, 1e-8);
    EXPECT_EQ(later.first, 2);
    EXPECT_EQ(later.count, 2);
    EXPECT_NEAR(later.order, 2, 1e-12);
    EXPECT_TRUE(std::isnan(later.order_error));
    for (const double floor : {1.0, nan}) {
        EXPECT_TRUE(std::isnan(order_of(errors, floor).order));
        EXPECT_EQ(order_of(errors, floor).count, 0);
    }
    EXPECT_TRUE(std::isnan(order_of({}, 0).order));
}

TEST(FittedOrder, StandardErrorCoversNoise) {
    std::mt19937 random(17);
    std::normal_distribution<double> noise(0, 0.05);
    int covered = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const auto fit =
            order_of(sequence({10, 20, 40, 80, 160, 320, 640},
                              [&](double h) { return std::pow(h, 1.5) * std::exp(noise(random)); }),
                     0);
        covered += std::abs(fit.order - 1.5) <= 3 * fit.order_error;
    }
    EXPECT_GE(covered, 185);
}

}  // namespace
}  // namespace elastocheck::compare
