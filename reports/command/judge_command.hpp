// `elastocheck judge`: another solver's results held against the references.
#pragma once

#include <string>

#include "reports/command/candidate_options.hpp"
#include "reports/command/delivery.hpp"

namespace elastocheck::reports {

struct JudgeRequest {
    std::string scene;
    Settings settings;
    CandidateRequest candidate;
    int steps = 0;  // that the command is asked for, and the references go in; 0: as the scene says
    std::string tolerance = "0.01mm,0.001deg";
};
CLI::App* add_judge_command(CLI::App& app, JudgeRequest& request);

// 0 all pass, 1 one fails, 3 none fails and one could not be judged.
int judge(const JudgeRequest& request, const Delivery& delivery);

}  // namespace elastocheck::reports
