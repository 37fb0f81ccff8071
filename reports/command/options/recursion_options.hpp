// Command-line options of the recursion.
#pragma once

#include <string>
#include <vector>

#include "elastocheck/recursive.hpp"
#include "reports/command/grammar/command.hpp"

namespace elastocheck::reports {

struct RecursionRequest {
    std::string method = "published";
    int steps = 0, order = 0, expansions = 0;
    std::string tolerance = {};
    bool arc_length = false;
};

// --steps, --tolerance, --order, --expansions; they write into `request`, which must outlive the
// parsing.
void add_recursion_options(std::vector<Option>& options, RecursionRequest& request);

// Throws std::invalid_argument for an option that does not apply to the method.
recursive::Options recursion(const RecursionRequest& request);

}  // namespace elastocheck::reports
