// Curves of external solvers beside the calculated ones.
#pragma once

#include <string>
#include <vector>

#include "reports/page/common.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// Points of every candidate on these branches for one output, over another one or, if `abscissa` is
// empty, over the parameter.
std::vector<DrawnCurve> candidate_curves(const SceneAnalyses& scene, const Sweep& sweep,
                                         const std::string& abscissa, const std::string& channel);

}  // namespace elastocheck::reports
