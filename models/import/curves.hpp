// Deviation between a scene's interpolant of a table and the interpolant of another program.
#pragma once

#include <utility>
#include <vector>

#include "elastocheck/mechanism.hpp"

namespace elastocheck::importer {

using Rows = std::vector<std::pair<double, double>>;  // deformation, force

// Largest difference between two interpolants of the same rows, in units of the rows; 0 unless both
// ascend.
struct InterpolantDeviation {
    double force = 0;          // absolute difference
    double at = 0;             // deformation at which it occurs
    double largest_force = 0;  // of the rows
};
// Interpolant of the scene: its default, or straight lines (`interpolation: linear`).
enum class Interpolation { monotone, linear };
// Deviation of the scene's interpolant from that of the other program: Akima's (H. Akima, J. ACM 17
// (1970) 589), straight lines, the natural cubic spline, or factor · x^exponent.
InterpolantDeviation deviation_from_akima(const Rows& rows,
                                          Interpolation own = Interpolation::monotone);
InterpolantDeviation deviation_from_lines(const Rows& rows);
InterpolantDeviation deviation_from_natural_spline(const Rows& rows);
InterpolantDeviation deviation_from_power(const Rows& rows, double factor, double exponent);

// Whether every piece of the curve is a straight line.
bool is_straight(const Curve& law);

}  // namespace elastocheck::importer
