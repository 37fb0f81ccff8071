// Interpolants of a table: monotone piecewise cubic (PCHIP) and piecewise linear.
#pragma once

#include <vector>

#include "elastocheck/mechanism.hpp"

namespace elastocheck::reader {

struct TablePoint {
    double x = 0;  // deflection [m] or [rad]
    double f = 0;  // [N] or [N·m]
};

// The piecewise cubic Hermite interpolant with the slopes of Fritsch and Butland (1984), known as PCHIP:
// through every point, C1, monotone where the points are, and linear where they are. Outside the points it is
// linear with the end slopes. Pre: at least two points, x ascending, f non-decreasing, all finite.
Curve interpolant(const std::vector<TablePoint>& points);

// The piecewise linear interpolant: through every point, C0; its slope jumps at the points. Outside
// the points it is linear with the end slopes. Pre: as above.
Curve piecewise_linear(const std::vector<TablePoint>& points);

}  // namespace elastocheck::reader
