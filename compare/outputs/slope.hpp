// Straight lines through points.
#pragma once

#include <vector>

#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {

// Slope of the straight line through these points, by least squares; NaN for fewer than two places.
inline double slope(const std::vector<double>& x, const std::vector<double>& y) {
    const double n = static_cast<double>(x.size());
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        mean_x += x[k] / n;
        mean_y += y[k] / n;
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
        xx += (x[k] - mean_x) * (x[k] - mean_x);
        xy += (x[k] - mean_x) * (y[k] - mean_y);
    }
    return xx > 0 ? xy / xx : nan;
}

}  // namespace elastocheck::compare
