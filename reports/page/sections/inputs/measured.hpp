// Measured curves beside the calculated curves.
#pragma once

#include <optional>
#include <string>

#include "reports/page/common.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// Whether the points of these branches give their parameter but no travel; figures with them use
// the parameter then.
bool measured_over_parameter(const SceneAnalyses& scene, const Sweep& sweep);

// Points of these branches for a channel, over another channel or, if `by` is empty or was not
// measured, over the parameter. Empty if it was not measured.
std::vector<DrawnCurve> measured_curves(const SceneAnalyses& scene, const Sweep& sweep,
                                        const std::string& by, const std::string& channel);

}  // namespace elastocheck::reports
