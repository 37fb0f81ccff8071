// Reference leg 2: the potential energy minimised subject to the full nonlinear constraints, by NLopt.
#pragma once

#include <span>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::reference::energy {

struct Options {
    double tolerance = 1e-10;  // on the projected gradient and the constraints, scaled; never a solver's word
    int evaluation_limit = 2000;  // per load
    int recentre_limit = 20;      // charts per load
};

// The equilibria at `loads` (load factors of `branch`, in the order they are to be visited, warm-started one
// from the other).
EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> loads,
                      const Options& options = {});

// How well a state, from any leg, satisfies this leg's conditions: the constraints, and the gradient of the
// potential left over after the best multipliers.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::reference::energy
