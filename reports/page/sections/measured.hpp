// Measured curves beside the calculated ones.
#pragma once

#include <optional>
#include <string>

#include "reports/document/field.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// The measured points of a channel (or "load") over the travel, to be drawn over its curves; as change since
// travel 0 where asked for. Nothing where it was not measured.
std::optional<Series> measured_series(const Field& scene, const std::string& channel, bool change);

// Between its points, straight; NaN outside them.
double value_between(const Series& measured, double x);

}  // namespace elastocheck::reports
