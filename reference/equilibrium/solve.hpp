// Reference leg 1: the full nonlinear constraint and equilibrium equations, solved by Ceres.
#pragma once

#include <span>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::reference::equilibrium {

struct Options {
    double tolerance =
        1e-12;  // on the largest scaled residual; a point is accepted on this, never on a solver's word
    int iteration_limit = 100;  // per solve
    int halvings = 12;          // of a load step that does not converge, before the branch is given up
};

// The equilibria at `loads` (load factors of `branch`, in the order they are to be visited, warm-started one
// from the other).
EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> loads,
                      const Options& options = {});

// How well a state, from any leg, satisfies this leg's equations;
// balances are formed from Equilibrium::reactions.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::reference::equilibrium
