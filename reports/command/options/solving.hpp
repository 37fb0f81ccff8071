// Solving a scene by one leg or method, and reading its outputs: for `solve` and the Python module.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "elastocheck/channels.hpp"
#include "elastocheck/legs.hpp"
#include "reports/command/options/recursion_options.hpp"

namespace elastocheck::reports {

struct SolverRequest {
    std::string method = compare::name(compare::Leg::equilibrium);
    RecursionRequest recursion;
    int every = 1;
};

// Names of the legs and of the methods of the recursion.
std::vector<std::string> solvers();

// The settings of a solver; the method has to be one of solvers(). Throws std::invalid_argument for an
// option that does not apply to it.
compare::SolverSettings solver_of(const SolverRequest& request);

// Names of the solvers whose points can be proved: the references, and the methods of the recursion.
std::vector<std::string> certified_solvers();
// The settings of one of these.
compare::SolverSettings certified_solver(const std::string& solver);

// A solved branch; its points have been passed to the callback.
struct SolvedBranch {
    EquilibriumPath path;  // without points
    // States at the ends of the sides, of a method without a tolerance: its error there is reported.
    std::vector<std::pair<compare::BranchSide, Equilibrium>> ends = {};
    std::string softest_motion = {};  // before a failure
};
// Calls `change_row` with each state when it is found, and with its row, which it may change; calls
// `hand_over` with the rows in the order of the branch.
SolvedBranch solve_branch(const Model& model, const Branch& branch,
                          const std::vector<compare::Channel>& channels,
                          const compare::SolverSettings& solver,
                          const std::function<void(const Equilibrium&, compare::Row&)>& change_row,
                          const std::function<void(compare::Row)>& hand_over);

// Error of a method at the end of a branch side, in words: its state there against one solve of the
// equilibrium leg at the same parameter.
std::string error_at_end(const Model& model, compare::BranchSide side, const Equilibrium& state);

}  // namespace elastocheck::reports
