// Command-line options of the recursion.
#pragma once

#include <string>

#include "elastocheck/recursive.hpp"

namespace elastocheck::reports {

struct RecursionRequest {
    std::string method = "published";
    int steps = 0, order = 0, expansions = 0;  // 0: the scene's steps, the method's defaults
    std::string tolerance = {};                // "0.01mm,0.001deg"; empty: the method's default
    bool arc_length = false;
};

// The options of the solver; the method is the name of one. Throws std::invalid_argument for an option
// that does not apply to the method.
recursive::Options recursion(const RecursionRequest& request);

}  // namespace elastocheck::reports
