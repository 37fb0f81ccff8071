// The curve through the points of a table.
#pragma once

#include <vector>

#include "models/mechanism.hpp"

namespace elastocheck::reader {

struct TablePoint {
    double x = 0;  // deflection [m] or [rad]
    double f = 0;  // [N] or [N·m]
};

// The piecewise cubic Hermite interpolant with the slopes of Fritsch and Butland (1984), known as PCHIP: through
// every point, C1, monotone where the points are, and on straight lines where they are. Outside it goes on with its
// end slopes. Pre: at least two points, x rising, f not falling, all finite.
Curve interpolant(const std::vector<TablePoint>& points);

}  // namespace elastocheck::reader
