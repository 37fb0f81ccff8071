// Floating-point precision study as terminal text and as a part of result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/studies/precision.hpp"

namespace elastocheck::reports {

std::string precision_text(const compare::PrecisionStudy& study);

// {branch, inconclusive, levels, floors}: tables of compare::PrecisionRow and compare::FloorRow.
nlohmann::ordered_json precision_json(const compare::PrecisionStudy& study);

}  // namespace elastocheck::reports
