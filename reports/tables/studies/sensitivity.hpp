// Derivatives of outputs by numbers of the scene as terminal text, table and JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/result/table.hpp"
#include "compare/sensitivity/sensitivity.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed; new fields do not increment it.
inline constexpr const char* sensitivity_schema = "elastocheck/sensitivity/1";

// One row per side of a branch, station, output and number, by the equilibrium leg.
compare::Table sensitivity_table(const compare::Gradients& all);

// For every side and output the numbers with the largest effect, `most` of them (0: all), at the
// start and the end of the side; then how far the legs agree.
std::string sensitivity_text(const compare::Gradients& all, int most);

// {"conclusive", "numbers": [...], "sides": [{"name", "branch", "compared", "worst", "where",
// "legs": [...]}], "derivatives": table}
nlohmann::ordered_json sensitivity_json(const compare::Gradients& all);

}  // namespace elastocheck::reports
