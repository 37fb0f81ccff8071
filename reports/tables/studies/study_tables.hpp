// Studies of methods as terminal text and as parts of result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/studies/formulations.hpp"
#include "compare/studies/study.hpp"
#include "compare/studies/work_precision.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reports {

// Convergence over the number of steps, and attribution of the formulation gap.
std::string study_text(const Model& model, const compare::Study& study,
                       const std::vector<compare::BranchAttribution>& attribution);
nlohmann::ordered_json study_json(const compare::Study& study,
                                  const std::vector<compare::BranchAttribution>& attribution);

// The series over its order.
std::string order_text(const std::vector<compare::OrderRow>& orders);

// Work-precision. JSON: {tolerance, output_points, rounds, reference_uncertainty, time_noise,
// points, recommendation, not_confirmed, inconclusive}: `points` is of compare::TradeRow,
// `position` in the recommendation is a row of it.
std::string trade_text(const Model& model, const compare::Trade& trade);
nlohmann::ordered_json trade_json(const compare::Trade& trade);

// Differences of the figures by other definitions.
std::string definition_text(const std::vector<compare::DefinitionRow>& rows);

// Spread of the outputs over the bushing formulations; `comparison` is of the same scene.
std::string formulation_text(const compare::FormulationStudy& study,
                             const compare::Comparison& comparison);

}  // namespace elastocheck::reports
