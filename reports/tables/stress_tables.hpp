// What became of every leg and method at the extremes: the survival map, its cells, and what is wrong in words.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/stress.hpp"
#include "compare/table.hpp"

namespace elastocheck::reports {

// Raised when a field changes its meaning or vanishes; new fields may appear without.
inline constexpr const char* stress_schema = "elastocheck/stress/1";

// One row a cell.
compare::Table cell_table(const compare::Survival& survival);

// The map as a terminal shows it: a row a scene, a column a sweep, in it one sign a solver; its legend; the digits lost to
// other arithmetic; every wrong cell.
std::string stress_text(const compare::Survival& survival);

// {"solvers", "sweeps", "map": [{"scene", "signs": [text a sweep]}], "extremes": [{"scene", "variant", "signs"}],
// "arithmetic": {"groups", "variants", "rows": [{"scene", "lost": [[text a group] a variant]}], "worst", "worst_right", "gave_up"},
// "counts", "wrong", "skipped", "cells"}
nlohmann::ordered_json stress_json(const compare::Survival& survival);

}  // namespace elastocheck::reports
