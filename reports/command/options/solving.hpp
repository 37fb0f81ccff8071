// How a scene is solved by one leg or method, and which outputs are read: what `solve` and the Python
// module share.
#pragma once

#include <string>
#include <vector>

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

// Pre: the method is one of solvers(). Throws std::invalid_argument for an option that does not
// apply to it.
compare::SolverSettings solver_of(const SolverRequest& request);

// The solvers whose points are proved, by name: the references, and the methods of the recursion.
std::vector<std::string> certified_solvers();
// Pre: it is one of them.
compare::SolverSettings certified_solver(const std::string& solver);

// Whether a recorded parameter is the end of a branch side, but for rounding.
bool is_end(const Branch& side, double load);
// Error of a method at the end of a branch side, in words: its state there against one solve of the
// equilibrium leg at the same parameter.
std::string error_at_end(const Model& model, compare::BranchSide side, const Equilibrium& state);

}  // namespace elastocheck::reports
