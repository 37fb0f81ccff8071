// Measured curves beside the calculated ones.
#pragma once

#include <optional>
#include <string>

#include "reports/document/field.hpp"
#include "reports/page/page.hpp"
#include "reports/page/sections/common.hpp"

namespace elastocheck::reports {

// Whether the points of these branches say their parameter and no travel: figures with them go over the parameter then.
bool measured_over_parameter(const Field& scene, const Sweep& sweep);

// The points of these branches, of a channel (or of the parameter where `channel` is empty), to be drawn over its
// curves: a change counts from where those begin. Nothing where it was not measured.
std::optional<Series> measured_series(const Field& scene, const Sweep& sweep, const std::string& channel,
                                      bool change);

// The points that bear on one branch: its own where the measurement says of which branch each is, else all.
std::optional<Series> measured_for(const Field& scene, const Sweep& sweep, const Field& branch,
                                   const std::string& channel, bool change);

// Between its points, straight; NaN outside them, and beside a point at which it was not measured.
double value_between(const Series& measured, double x);

}  // namespace elastocheck::reports
