// Polynomials of outputs over one or two variables.
#include "compare/design/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace elastocheck::compare {
namespace {

MapTable table_of(int n_x, int n_y, double (*f)(double, double)) {
    MapTable table;
    table.channels.push_back({.name = "toe", .unit = Unit::deg, .reads = Toe{}});
    for (int i = 0; i < n_x; ++i) table.x.push_back(-80 + 160. * i / (n_x - 1));
    for (int j = 0; j < n_y; ++j) table.y.push_back(n_y == 1 ? 0 : -50 + 100. * j / (n_y - 1));
    for (const double y : table.y) {
        auto& row = table.values.emplace_back();
        for (const double x : table.x) row.push_back({f(x, y)});
    }
    return table;
}
const Tolerance tolerance = default_tolerance;

TEST(Maps, OfAPolynomialAreThatPolynomial) {
    const auto cubic = [](double x, double y) {
        return 1 + 1e-2 * x - 2e-6 * x * x * x + 1e-3 * x * y;
    };
    const auto maps = polynomial_maps(table_of(21, 11, cubic), tolerance);
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_TRUE(maps[0].within);
    EXPECT_EQ(maps[0].degree_x, 3);
    EXPECT_LE(maps[0].error, 1e-11);
    EXPECT_NEAR(maps[0].at(33, -17), cubic(33, -17), 1e-11);
    const auto line =
        polynomial_maps(table_of(21, 1, [](double x, double) { return 0.5 * x; }), tolerance);
    EXPECT_EQ(line[0].degree_x, 1);
    EXPECT_EQ(line[0].degree_y, 0);
}

// The error is that at points that were not fitted: a curve that wiggles between them is not within.
TEST(Maps, AreJudgedAtPointsThatWereNotFitted) {
    MapTable table = table_of(21, 1, [](double x, double) { return 1e-4 * x * x; });
    for (std::size_t k = 1; k < table.x.size(); k += 2) table.values[0][k][0] += 0.1;
    const auto maps = polynomial_maps(table, tolerance);
    EXPECT_FALSE(maps[0].within);
    EXPECT_GE(maps[0].error, 0.09);
}

// Judged at eight points for each fitted interval, the error is that of the whole curve: a sampling
// eight times as fine finds no more than 5 % above it.
TEST(Maps, HaveAnErrorThatFinerSamplingDoesNotRaise) {
    for (double (*const f)(double, double) :
         {+[](double x, double) { return std::exp(0.03 * x); },
          +[](double x, double) { return std::sin(0.05 * x + 0.3); },
          +[](double x, double) { return 1 / (1 + 1e-3 * x * x); }}) {
        const MapTable table = table_of(161, 1, f), fine = table_of(1281, 1, f);
        const PolynomialMap map = polynomial_maps(table, tolerance, 8)[0];
        double worst = 0;
        for (const double x : fine.x) worst = std::max(worst, std::abs(map.at(x, 0) - f(x, 0)));
        EXPECT_LE(worst, 1.05 * map.error) << map.degree_x;
        EXPECT_GT(worst, 0);
    }
    EXPECT_THROW(
        (void)polynomial_maps(table_of(163, 1, [](double x, double) { return x; }), tolerance, 8),
        std::invalid_argument);
}

TEST(Maps, OfACurveWithACornerAreNotWithin) {
    const auto maps = polynomial_maps(
        table_of(41, 1, [](double x, double) { return std::abs(x - 13); }), tolerance);
    EXPECT_FALSE(maps[0].within);
    EXPECT_LE(maps[0].degree_x, most_map_degree);
}

TEST(Maps, OfATableWithoutAllItsValuesAreRefused) {
    const auto flat = [](double, double) { return 0.; };
    EXPECT_THROW((void)polynomial_maps(table_of(20, 1, flat), tolerance), std::invalid_argument);
    EXPECT_THROW((void)polynomial_maps(table_of(21, 4, flat), tolerance), std::invalid_argument);
    MapTable table = table_of(21, 1, flat);
    table.values[0][7][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)polynomial_maps(table, tolerance), std::invalid_argument);
}

}  // namespace
}  // namespace elastocheck::compare
