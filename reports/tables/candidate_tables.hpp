// Judgement of a candidate as a result for readers.
#pragma once

#include "compare/candidate/candidate.hpp"
#include "compare/result/result.hpp"

namespace elastocheck::reports {

compare::Result result_of(const compare::CandidateJudgement& judgement,
                          const compare::Comparison& comparison);

}  // namespace elastocheck::reports
