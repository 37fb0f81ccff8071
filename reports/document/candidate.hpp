// A judged candidate in result.json.
#pragma once

#include <nlohmann/json.hpp>

#include "compare/candidate.hpp"

namespace elastocheck::reports {

// "candidates" of a scene is a list of these; reports/README.md says what is in one.
nlohmann::ordered_json candidate_json(const compare::CandidateJudgement& judgement,
                                      const compare::Comparison& comparison, const std::string& sentence);

}  // namespace elastocheck::reports
