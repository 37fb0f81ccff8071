// The comparison as people read it on a terminal.
#pragma once

#include <string>

#include "compare/compare.hpp"
#include "models/model.hpp"

namespace elastocheck::reports {

std::string tables(const Model& model, const compare::Comparison& comparison);

}  // namespace elastocheck::reports
