// Deviations between curves: NaN, empty curves and wrong abscissas never pass.
#include "compare/deviation/deviation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

// y = shape(travel) with travel = rate · load, at 0 ... 10.
template <class F>
Curve made(double rate, F&& shape, int points = 41) {
    Curve curve;
    for (int k = 0; k < points; ++k) {
        const double load = 10.0 * k / (points - 1), travel = rate * load;
        curve.a.push_back(load);
        curve.values.push_back({travel, shape(travel)});
    }
    return curve;
}

const std::vector<Channel> outputs{{.name = "travel", .main = false, .reads = Coordinate{}},
                                   {.name = "y", .reads = Coordinate{}}};

Reading at_equal_travel(const Curve& a, const Curve& b) {
    return at_equal_abscissa(a, b, abscissa(outputs, 0, a, b));
}

TEST(Deviation, WrongRateAppearsAtEqualLoadAndNotAtEqualTravel) {
    const auto shape = [](double x) { return std::sin(0.2 * x) + 0.01 * x * x; };
    const Curve a = made(1, shape), b = made(1.04, shape);
    const auto load = at_equal_parameter(a, b), travel = at_equal_travel(a, b);
    EXPECT_NEAR(load.channels[0].max, 0.4, 1e-12);
    EXPECT_NEAR(load.channels[0].signed_max, 0.4, 1e-12);
    EXPECT_EQ(load.channels[0].at, 10);
    EXPECT_NEAR(load.channels[0].range, 10, 1e-12);
    EXPECT_GT(load.channels[1].max, 0.01);
    EXPECT_LE(travel.channels[1].max, 1e-7);
    EXPECT_LE(travel.channels[1].max, 2 * travel.channels[1].interpolation + 1e-15);
    EXPECT_EQ(travel.outside, 0);
    EXPECT_EQ(travel.channels[1].compared, 41);
}

TEST(Deviation, PointsBeyondTheOtherCurveAreNotExtrapolated) {
    const auto shape = [](double x) { return x; };
    const auto reading = at_equal_travel(made(1, shape), made(0.9, shape));
    EXPECT_EQ(reading.outside, 4);
    EXPECT_EQ(reading.channels[1].compared, 37);
}

// An end to which both curves are driven: rounding must not decide whether it is compared.
TEST(Deviation, CommonEndIsComparedDespiteRounding) {
    const auto shape = [](double x) { return x * x; };
    const Curve a = made(1, shape), b = made(1 - 1e-15, shape);
    EXPECT_EQ(at_equal_travel(a, b).outside, 0);
    EXPECT_EQ(at_equal_travel(a, b).channels[1].compared, 41);
    EXPECT_EQ(at_equal_travel(a, made(1 - 1e-6, shape)).outside, 1);
}

TEST(Deviation, CurvesOverADecreasingAbscissaAreCompared) {
    const auto shape = [](double x) { return x * x; };
    const auto reading = at_equal_travel(made(-1, shape), made(-1.1, shape));
    EXPECT_TRUE(reading.not_compared.empty());
    EXPECT_LE(reading.channels[1].max, 1e-12);
}

TEST(Deviation, RmsAndSignAreThoseOfTheDifference) {
    Curve a = made(
              1, [](double) { return 0.0; }, 4),
          b = a;
    b.values[1][1] = -3;
    b.values[2][1] = 1;
    const auto d = at_equal_parameter(a, b).channels[1];
    EXPECT_DOUBLE_EQ(d.rms, std::sqrt(10.0 / 4));
    EXPECT_EQ(d.signed_max, -3);
    EXPECT_EQ(d.max, 3);
    EXPECT_EQ(d.end, 0);
}

TEST(Deviation, DeviationOfCurvesWithANaNIsNaN) {
    for (const std::size_t where : {0u, 20u, 40u}) {
        Curve a = made(1, [](double x) { return x; }), b = a;
        b.values[where][1] = nan;
        const auto load = at_equal_parameter(a, b).channels[1];
        EXPECT_TRUE(std::isnan(load.max)) << where;
        EXPECT_TRUE(std::isnan(load.rms)) << where;
        EXPECT_TRUE(std::isnan(at_equal_travel(a, b).channels[1].max)) << where;
        b = a;
        a.values[where][1] = nan;
        EXPECT_TRUE(std::isnan(at_equal_parameter(a, b).channels[1].max)) << where;
        EXPECT_TRUE(std::isnan(at_equal_parameter(a, b).channels[1].range)) << where;
        b.values[where][0] = nan;
        EXPECT_FALSE(at_equal_travel(made(1, [](double x) { return x; }), b).not_compared.empty())
            << where;
    }
}

TEST(Deviation, ReasonIsGivenWhereNothingIsCompared) {
    const Curve a = made(1, [](double x) { return x; });
    EXPECT_FALSE(at_equal_parameter(a, {}).not_compared.empty());
    EXPECT_FALSE(at_equal_parameter({}, a).not_compared.empty());
    EXPECT_FALSE(at_equal_travel(a, {}).not_compared.empty());
    Curve other = a;
    other.a[7] += 1e-9;
    EXPECT_FALSE(at_equal_parameter(a, other).not_compared.empty());
    Curve folded = a;
    std::swap(folded.values[5][0], folded.values[6][0]);
    EXPECT_FALSE(at_equal_travel(a, folded).not_compared.empty());
    Curve elsewhere = made(1, [](double x) { return x; });
    for (auto& v : elsewhere.values) v[0] += 100;
    const auto reading = at_equal_travel(a, elsewhere);
    EXPECT_EQ(reading.channels[1].compared, 0);
    EXPECT_TRUE(std::isnan(reading.channels[1].max));
}

TEST(Deviation, TwoSidedCurvesAreAlignedAtTheirStartIfOneEndsEarly) {
    Curve a = made(1, [](double x) { return x; }), b = a;
    for (Curve* curve : {&a, &b}) {
        curve->start = 20;
        for (double& x : curve->a) x -= 5;
    }
    // b ended early on the near side: its first seven points are missing.
    b.a.erase(b.a.begin(), b.a.begin() + 7);
    b.values.erase(b.values.begin(), b.values.begin() + 7);
    b.start -= 7;
    b.values[0][1] += 0.5;
    const auto reading = at_equal_parameter(a, b);
    ASSERT_TRUE(reading.not_compared.empty()) << reading.not_compared;
    EXPECT_EQ(reading.channels[1].compared, 34);
    EXPECT_DOUBLE_EQ(reading.channels[1].max, 0.5);
    EXPECT_DOUBLE_EQ(reading.channels[1].at, a.a[7]);
    EXPECT_TRUE(std::isnan(distance(outputs, a, b).mm));  // not the same branch
    EXPECT_EQ(profile_at_equal_parameter(outputs, a, b).deviation.size(), 34u);
}

TEST(Deviation, ProfileIsTheLargestDeviationOfTheMainOutputsAtEachPoint) {
    const Curve a = made(1, [](double x) { return x; });
    Curve b = a;
    b.values[3][0] += 9;  // travel is not a main channel
    b.values[5][1] -= 0.25;
    const auto load = profile_at_equal_parameter(outputs, a, b);
    EXPECT_EQ(load.deviation[3].mm, 0);
    EXPECT_EQ(load.deviation[5].mm, 0.25);
    EXPECT_EQ(distance(outputs, a, b).mm, 0.25);
    const Curve c = made(0.9, [](double x) { return x; });
    const auto travel = profile_at_equal_abscissa(outputs, a, c, abscissa(outputs, 0, a, c));
    EXPECT_LE(travel.deviation[30].mm, 1e-12);
    EXPECT_TRUE(std::isnan(travel.deviation[40].mm));  // not reached
}

TEST(Abscissa, ReasonForHavingNoneNamesTheOutputThatReversesOrDoesNotMove) {
    const Curve a = made(1, [](double x) { return (x - 4) * (x - 4); });
    EXPECT_EQ(abscissa(outputs, 0, a, a).why_not, "");
    EXPECT_EQ(abscissa(outputs, 1, a, a).why_not, "y turns back at 4 N (at 0 mm)");
    const Curve still = made(1, [](double) { return 7.0; });
    EXPECT_EQ(abscissa(outputs, 1, still, still).why_not, "y does not move");
    EXPECT_EQ(abscissa(outputs, 0, a, made(-1, [](double x) { return x; })).why_not,
              "travel has opposite directions on the two curves");
    Curve nowhere = a;
    nowhere.values[6][0] = nan;
    EXPECT_EQ(abscissa(outputs, 0, a, nowhere).why_not, "travel is not a number at 1.5 N");
    EXPECT_EQ(abscissa(outputs, 0, a, {}).why_not, "a curve has fewer than two points");
    EXPECT_EQ(at_equal_abscissa(a, a, abscissa(outputs, 1, a, a)).not_compared,
              "y turns back at 4 N (at 0 mm)");
}

TEST(Abscissa, DefaultIsTravelOrTheChannelWithTheLargestRange) {
    const Curve a = made(0.5, [](double x) { return -3 * x; });
    std::vector<Channel> of_wheel = outputs;
    of_wheel[0].reads = Catalogued{find_entry(figure::travel)};
    EXPECT_EQ(default_abscissa(of_wheel, a), 0);
    const std::vector<Channel> probes{{.name = "x", .reads = Coordinate{}},
                                      {.name = "y", .reads = Coordinate{}}};
    EXPECT_EQ(default_abscissa(probes, a), 1);
    const std::vector<Channel> forces{
        {.name = "f", .unit = Unit::newton, .main = false, .reads = Reaction{}}};
    EXPECT_EQ(default_abscissa(forces, a), -1);
    EXPECT_FALSE(abscissa(forces, -1, a, a).why_not.empty());
}

TEST(Interpolation, PolynomialsUpToItsDegreeAreExactOverRisingAndFallingAbscissas) {
    for (const double direction : {1.0, -1.0}) {
        std::vector<double> x, y;
        const auto p = [](double t) {
            return 1 + t * (2 + t * (-0.5 + t * (0.3 + t * (0.1 - 0.02 * t))));
        };
        for (int k = 0; k < 12; ++k) {
            x.push_back(direction * (k + 0.3 * std::sin(3.0 * k)));
            y.push_back(p(x.back()));
        }
        for (double t = 0; t <= 11; t += 0.37) {
            const double at = direction * t;
            EXPECT_NEAR(interpolate(x, y, at, 6), p(at), 1e-9 * (1 + std::abs(p(at))));
        }
        for (std::size_t k = 0; k < x.size(); ++k)
            EXPECT_DOUBLE_EQ(interpolate(x, y, x[k], 6), y[k]);
    }
}

}  // namespace
}  // namespace elastocheck::compare
