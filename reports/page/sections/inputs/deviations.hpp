// Worst deviations of the recursion at points of a sweep.
#pragma once

#include <vector>

#include "reports/page/common.hpp"

namespace elastocheck::reports {

// The worst deviations of the main outputs of a unit at one point of a sweep; NaN without a comparison.
struct DeviationAt {
    double a, load, travel, recommended, references;
};

// In ascending order of the parameter, up to 60 a branch.
std::vector<DeviationAt> deviations_over(const SceneAnalyses& scene, const Sweep& sweep,
                                         compare::Unit unit);

// The parameter, then a column a comparison.
Table table_of(const std::vector<DeviationAt>& deviations, const SceneAnalyses& scene,
               const Sweep& sweep, compare::Unit unit);

}  // namespace elastocheck::reports
