// Results of the stress test: survival map, cells, and descriptions of the wrong ones.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/stress/stress.hpp"
#include "compare/tables/table.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed; new fields do not increment it.
inline constexpr const char* stress_schema = "elastocheck/stress/2";

// One row per cell.
compare::Table cell_table(const compare::Survival& survival);

// Terminal map: one row per scene, one column per sweep, one sign per solver; legend;
// every wrong cell.
std::string stress_text(const compare::Survival& survival);

// {"solvers", "sweeps", "map": [{"scene", "signs": [text per sweep]}],
//  "extremes": [{"scene", "variant", "signs"}],
//  "counts", "wrong", "skipped", "cells"}
nlohmann::ordered_json stress_json(const compare::Survival& survival);

}  // namespace elastocheck::reports
