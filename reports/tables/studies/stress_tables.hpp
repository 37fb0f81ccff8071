// Results of the stress test: survival map, cells, and descriptions of the wrong ones.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/stress/stress.hpp"
#include "compare/tables/table.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed; new fields do not increment it.
inline constexpr const char* stress_schema = "elastocheck/stress/1";

// One row per cell.
compare::Table cell_table(const compare::Survival& survival);

// Terminal map: one row per scene, one column per sweep, one sign per solver; legend; digits lost
// to other arithmetic; every wrong cell.
std::string stress_text(const compare::Survival& survival);

// {"solvers", "sweeps", "map": [{"scene", "signs": [text per sweep]}],
//  "extremes": [{"scene", "variant", "signs"}],
//  "arithmetic": {"groups", "variants",
//                 "rows": [{"scene", "lost": [[text per group] per variant]}],
//                 "worst", "worst_right", "gave_up"},
//  "counts", "wrong", "skipped", "cells"}
nlohmann::ordered_json stress_json(const compare::Survival& survival);

}  // namespace elastocheck::reports
