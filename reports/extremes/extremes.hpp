// Extreme scenes of models/extremes/ with the parameters that make them extreme: nearly singular
// geometry, redundant or inconsistent joints, stops at contact, flat or steep curves, limit points.
#pragma once

#include <vector>

#include "compare/stress/stress.hpp"

namespace elastocheck::reports {

// One trial per value, in the order of the table, of the sweep compare::extreme.
std::vector<compare::Trial> extremes();

}  // namespace elastocheck::reports
