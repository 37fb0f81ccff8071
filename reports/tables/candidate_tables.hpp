// Judgement of a candidate as terminal text, and the sentence shared by all outputs.
#pragma once

#include <string>
#include <vector>

#include "compare/candidate/candidate.hpp"
#include "compare/tables/table.hpp"

namespace elastocheck::reports {

std::string sentence(const compare::CandidateJudgement& judgement,
                     const compare::Comparison& comparison);

// Cost of a candidate's accuracy: one run of its command.
struct CandidateRun {
    int steps = 0;
    double seconds = 0, cpu = 0;  // of the whole program
    double leg_seconds = 0;  // of the equilibrium leg at the same number of points, in this process
    compare::CandidateJudgement judgement;
};
compare::Table candidate_trade_table(const std::vector<CandidateRun>& runs,
                                     const compare::Comparison& comparison);

std::string candidate_text(const compare::CandidateJudgement& judgement,
                           const compare::Comparison& comparison);

}  // namespace elastocheck::reports
