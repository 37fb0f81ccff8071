// Multiple equilibria at one parameter value as terminal text, table and JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/proofs/multiple_equilibria.hpp"
#include "compare/tables/table.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed; new fields do not increment it.
inline constexpr const char* equilibria_schema = "elastocheck/equilibria/1";

std::string equilibria_text(const compare::AllEquilibria& all);

// {"branch", "at", "unit", "outcome", "detail", "proved", "starts", "other_way_round",
// "equilibria": table, "poses"}
nlohmann::ordered_json equilibria_json(const Model& model, const compare::AllEquilibria& all);

}  // namespace elastocheck::reports
