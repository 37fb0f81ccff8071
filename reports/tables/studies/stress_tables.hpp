// Results of the stress test: survival map, cells, and descriptions of the wrong ones.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/stress/stress.hpp"
#include "compare/result/table.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed; new fields do not increment it.
inline constexpr const char* stress_schema = "elastocheck/stress/3";

// One row per cell.
compare::Table cell_table(const compare::Survival& survival);

// One row per scene and sweep, and per variant of an extreme scene, with a sign per solver: the
// worst of the cells.
compare::Table map_table(const compare::Survival& survival);

// The map, its legend, the counts and every wrong cell.
std::string stress_text(const compare::Survival& survival);

// {"solvers", "map", "counts", "cells"}; `map` and `cells` are tables.
nlohmann::ordered_json stress_json(const compare::Survival& survival);

}  // namespace elastocheck::reports
