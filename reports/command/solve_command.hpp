// `elastocheck solve`: one scene, one way, its curves as CSV.
#pragma once

#include <string>
#include <vector>

#include "compare/legs.hpp"
#include "reports/command/arguments.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/load_scene.hpp"

namespace elastocheck::reports {

struct SolveRequest {
    compare::Gait gait;
    Detail detail = Detail::required;
    std::vector<std::string> channels;  // names, or patterns with *; none: all
    std::string rates;                  // CSV of the derivatives, by the series; empty: none
    std::string states = {};            // JSON lines of the poses, as a candidate writes them; empty: none
};

// Each row is written as its point is found, but for the way that comes reversed. What is wrong with the request is said
// before the work. The exit code; where a branch does not converge, the rows are those that it reached.
// The CSV goes to the file of `delivery` or to standard output; the document holds every point, so all are kept for it.
int solve(const std::string& scene, const Settings& settings, const SolveRequest& request,
          const Delivery& delivery);

// The channels that are asked for, in that order, each once. Throws std::invalid_argument for a pattern that fits none,
// with the nearest name.
std::vector<compare::Channel> chosen(const std::vector<compare::Channel>& all,
                                     const std::vector<std::string>& patterns);

}  // namespace elastocheck::reports
