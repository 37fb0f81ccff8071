// The arithmetic's share, as people read it on a terminal and as a part of result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/precision.hpp"
#include "reports/tables/render.hpp"

namespace elastocheck::reports {

extern const std::vector<Shown> floor_columns;  // of compare::floor_table, on the terminal and the page

std::string precision_text(const compare::PrecisionStudy& study);

// {branch, inconclusive, levels, floors}: the tables of compare::precision_table and compare::floor_table.
nlohmann::ordered_json precision_json(const compare::PrecisionStudy& study);

}  // namespace elastocheck::reports
