// Judged candidate as a part of result.json.
#pragma once

#include <nlohmann/json.hpp>

#include "compare/candidate/candidate.hpp"

namespace elastocheck::reports {

// Entry of the list "candidates" of a scene; format in reports/README.md.
nlohmann::ordered_json candidate_json(const compare::CandidateJudgement& judgement,
                                      const compare::Comparison& comparison,
                                      const std::string& sentence);

}  // namespace elastocheck::reports
