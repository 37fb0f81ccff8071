// The options of a command that say how the recursion goes.
#pragma once

#include <string>

#include "recursive/solve.hpp"

namespace CLI {
class App;
}

namespace elastocheck::reports {

struct RecursionRequest {
    std::string method = "published";
    int steps = 0, order = 0, expansions = 0;
    std::string tolerance;
    bool arc_length = false;
};

// --steps, --tolerance, --order, --expansions; they write into `request`, which must outlive the parsing.
void add_recursion_options(CLI::App& command, RecursionRequest& request);

// Throws std::invalid_argument for an option that the method does not have.
recursive::Options recursion(const RecursionRequest& request);

}  // namespace elastocheck::reports
