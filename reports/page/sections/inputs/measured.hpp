// Measured curves beside the calculated curves.
#pragma once

#include <optional>
#include <string>

#include "reports/json/json_cursor.hpp"
#include "reports/page/common.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// Whether the points of these branches give their parameter but no travel; figures with them use
// the parameter then.
bool measured_over_parameter(const JsonCursor& scene, const Sweep& sweep);

// Points of these branches for a channel (or for the parameter if `channel` is empty), drawn over
// its curves: a change is relative to the start of the curves. Empty if it was not measured.
std::optional<Series> measured_series(const JsonCursor& scene, const Sweep& sweep,
                                      const std::string& channel, bool change);

// The points of one branch: its own if the measurement names the branches, else all.
std::optional<Series> measured_for(const JsonCursor& scene, const Sweep& sweep,
                                   const JsonCursor& branch, const std::string& channel,
                                   bool change);

// Linear interpolation; NaN outside the points, and beside a point without a value.
double value_between(const Series& measured, double x);

}  // namespace elastocheck::reports
