// Convergence study and gap attribution as terminal text and in result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/studies/study.hpp"
#include "elastocheck/model.hpp"
#include "reports/tables/render.hpp"

namespace elastocheck::reports {

extern const std::vector<ShownColumn> study_columns;  // displayed columns of study_table
extern const std::vector<ShownColumn> gap_columns;    // of gap_table

std::string study_text(const Model& model, const compare::Study& study,
                       const std::vector<compare::BranchAttribution>& attribution);
nlohmann::ordered_json study_json(const compare::Study& study,
                                  const std::vector<compare::BranchAttribution>& attribution);

}  // namespace elastocheck::reports
