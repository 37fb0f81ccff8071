// Convergence study and gap attribution as terminal text and in result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/studies/study.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reports {

std::string study_text(const Model& model, const compare::Study& study,
                       const std::vector<compare::BranchAttribution>& attribution);
nlohmann::ordered_json study_json(const compare::Study& study,
                                  const std::vector<compare::BranchAttribution>& attribution);

}  // namespace elastocheck::reports
