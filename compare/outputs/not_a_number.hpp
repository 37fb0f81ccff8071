// NaN as the value of an output that does not exist or could not be computed.
#pragma once

#include <cmath>
#include <limits>

namespace elastocheck::compare {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

inline double finite_or_nan(double value) { return std::isfinite(value) ? value : nan; }

}  // namespace elastocheck::compare
