// A convergence study and a gap attribution: as people read them, as CSV, and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/study.hpp"
#include "models/model.hpp"

namespace elastocheck::reports {

std::string study_tables(const Model& model, const compare::Study& study,
                         const std::vector<compare::BranchAttribution>& attribution);

// One row per branch, method, reading, channel and level; the numbers of the fit repeated in each.
std::string study_csv(const Model& model, const compare::Study& study);
std::string attribution_csv(const Model& model, const compare::Study& study,
                            const std::vector<compare::BranchAttribution>& attribution);

nlohmann::ordered_json study_json(const Model& model, const compare::Study& study,
                                  const std::vector<compare::BranchAttribution>& attribution);

}  // namespace elastocheck::reports
