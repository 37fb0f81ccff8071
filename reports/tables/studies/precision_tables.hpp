// Floating-point precision study as terminal text and as a part of result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/studies/precision.hpp"
#include "reports/tables/render.hpp"

namespace elastocheck::reports {

// of compare::floor_table, on the terminal and the page
extern const std::vector<ShownColumn> floor_columns;

std::string precision_text(const compare::PrecisionStudy& study);

// {branch, inconclusive, levels, floors}: the tables of compare::precision_table and
// compare::floor_table.
nlohmann::ordered_json precision_json(const compare::PrecisionStudy& study);

}  // namespace elastocheck::reports
