// Deviations as terminal text.
#pragma once

#include <string>

#include "elastocheck/compare.hpp"

namespace elastocheck::reports {

// Largest deviation with sign, its place, root mean square and share of the range: 36 characters
// wide.
std::string deviation_cells(const compare::Deviation& deviation);

}  // namespace elastocheck::reports
