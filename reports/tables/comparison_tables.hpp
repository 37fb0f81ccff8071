// The comparison as people read it on a terminal.
#pragma once

#include <string>

#include "compare/compare.hpp"
#include "models/model.hpp"

namespace elastocheck::reports {

// Its largest with its sign, where, its root mean square and its share of the range: 36 wide.
std::string deviation_cells(const compare::Deviation& deviation);

std::string tables(const Model& model, const compare::Comparison& comparison);

}  // namespace elastocheck::reports
