// Judgement of a candidate as terminal text, and the sentence shared by all outputs.
#pragma once

#include <string>

#include "compare/candidate/candidate.hpp"

namespace elastocheck::reports {

std::string sentence(const compare::CandidateJudgement& judgement,
                     const compare::Comparison& comparison);

std::string candidate_text(const compare::CandidateJudgement& judgement,
                           const compare::Comparison& comparison);

}  // namespace elastocheck::reports
