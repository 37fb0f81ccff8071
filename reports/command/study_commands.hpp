// The commands that look at one scene: inspect, compare, converge, trade; `solve` is beside. Each returns the exit code;
// what can be wrong with where it writes is said before the work.
#pragma once

#include <string>
#include <vector>

#include "compare/compare.hpp"
#include "recursive/solve.hpp"
#include "reports/command/arguments.hpp"
#include "reports/command/candidate_options.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/load_scene.hpp"

namespace elastocheck::reports {

int inspect(const std::string& scene, const Settings& settings, Detail detail, bool verbose,
            const Delivery& delivery);

struct CompareRequest {
    recursive::Options recursion;
    int every = 1;  // of its steps, each of which is compared
    Detail detail = Detail::required;
    std::string within = "0.01mm,0.001deg";  // what the verdict holds the deviations against
    CandidateRequest candidate = {};         // somebody else's solver, beside the legs
    bool formulations = false;  // how much the outputs depend on what a bushing is taken to measure, as well
};
// As text, or the document; in a folder with CSV files beside it.
int compare_legs(const std::string& scene, const Settings& settings, const CompareRequest& request,
                 const Delivery& delivery);
int converge(const std::string& scene, const Settings& settings, const std::vector<std::string>& methods,
             const std::vector<int>& steps, const CandidateRequest& candidate, const Delivery& delivery);
int trade(const std::string& scene, const Settings& settings, const std::string& tolerance,
          const CandidateRequest& candidate, const Delivery& delivery);

}  // namespace elastocheck::reports
