// Polynomials of outputs over one or two variables, as vehicle models take them: fitted to half of
// the points of a table, judged at all of them.
#pragma once

#include <string>
#include <vector>

#include "compare/deviation/tolerance.hpp"
#include "elastocheck/channels.hpp"

namespace elastocheck::compare {

// Outputs on a grid: the parameter of a branch, and values at which something is held on it.
struct MapTable {
    std::vector<Channel> channels;
    std::vector<double> x;  // parameter, in the branch's unit, increasing; an odd number
    std::vector<double> y;  // held values, increasing, an odd number; one: no second variable
    // [y][x][channel]; NaN where the branch does not reach the parameter
    std::vector<std::vector<std::vector<double>>> values;
};

// Σ c_ij u^i v^j,  u = (x - x_0) / x_1, v = (y - y_0) / y_1, both in [-1, 1].
struct PolynomialMap {
    std::size_t channel = 0;
    int degree_x = 0, degree_y = 0;
    std::vector<double> c;  // c_00, c_01, ..., c_10, ...
    double x_0 = 0, x_1 = 1, y_0 = 0, y_1 = 1;
    // largest difference at the points of the table, of which every second one of each variable was
    // fitted; in the channel's unit
    double error = 0;
    bool within = false;  // error is at most the limit of the output

    double at(double x, double y) const;
};

inline constexpr int most_map_degree = 9;

// For each output the polynomial of the least degree whose error is within its limit (limit_of() its
// range in the table), else that of the least error.
// Of x every `every`-th value is fitted, of y every second one; the first and the last one are.
// Throws std::invalid_argument for a table with fewer than three values of x, where the last value is
// not fitted, or with values missing.
std::vector<PolynomialMap> polynomial_maps(const MapTable& table, const Tolerance& tolerance,
                                           std::size_t every = 2);

}  // namespace elastocheck::compare
