// Command-line options of the recursion.
#pragma once

#include <string>

#include "elastocheck/recursive.hpp"

namespace elastocheck::reports {

struct RecursionRequest {
    std::string method = "published";
    int steps = 0, order = 0, expansions = 0;
    std::string tolerance = {};
    bool arc_length = false;
};

// Throws std::invalid_argument for an option that does not apply to the method.
recursive::Options recursion(const RecursionRequest& request);

}  // namespace elastocheck::reports
