// The trimmed model of a session with changed numbers, kept for calls about the same numbers: they
// follow a solve() while nothing is moved (proof.hpp, compliance.hpp).
#pragma once

#include <string>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "elastocheck/trim.hpp"
#include "reports/live/engine.hpp"

namespace elastocheck::live {

struct Prepared {
    std::vector<Setting> settings;
    compare::Trimmed trimmed;
    Model model;
    // Of the branch and the number of points requested last, solved by the series.
    struct Station {
        std::size_t side = 0;  // index in `sides`
        Equilibrium state;
    };
    std::string branch;
    int points = 0;
    std::vector<compare::BranchSide> sides;
    std::vector<EquilibriumPath> paths;  // of the sides, without their points
    std::vector<Station> stations;       // in ascending order of the parameter
};

// The trimmed and compiled model. Throws as solve(), and std::invalid_argument for a trim not reached.
Prepared& prepared(Session& session, const std::vector<Setting>& settings);
// Likewise, with the stations of the branch `request.only`, the points of solve(). Throws
// std::invalid_argument for an unknown branch.
Prepared& prepared(Session& session, const Request& request);

}  // namespace elastocheck::live
