// Deviation between a scene's interpolant of a table and the interpolant of another program.
#pragma once

#include <utility>
#include <vector>

#include "elastocheck/mechanism.hpp"

namespace elastocheck::importer {

using Rows = std::vector<std::pair<double, double>>;

// Largest difference of the two interpolants between the rows [unit of their force], the
// deformation at which it occurs, and the largest force of the rows.
struct Apart {
    double force = 0, at = 0, of = 0;
};
// Interpolant of the scene: its default, or straight lines (`interpolation: linear`).
enum class Between { monotone, straight };
// The largest difference from the interpolant of the other program: that of Akima (H. Akima, J. ACM
// 17 (1970) 589), the polygon, the natural cubic spline, or factor · x^exponent.
Apart off_akima(const Rows& rows, Between ours = Between::monotone);
Apart off_straight(const Rows& rows);
Apart off_natural(const Rows& rows);
Apart off_power(const Rows& rows, double factor, double exponent);

// Whether every piece of the curve is a straight line.
bool is_straight(const Curve& law);

}  // namespace elastocheck::importer
