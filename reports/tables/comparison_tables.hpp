// Comparison of the legs as terminal text.
#pragma once

#include <string>

#include "compare/comparison/compare.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reports {

// Largest deviation with sign, its place, root mean square and share of the range: 36 characters
// wide.
std::string deviation_cells(const compare::Deviation& deviation);

std::string tables(const Model& model, const compare::Comparison& comparison);

}  // namespace elastocheck::reports
