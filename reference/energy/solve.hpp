// Reference leg 2: the potential energy minimised subject to the full nonlinear constraints, by NLopt.
#pragma once

#include <span>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::reference::energy {

struct Options {
    double tolerance = 1e-10;  // on the projected gradient and the constraints, scaled; never a solver's word
    int evaluation_limit = 2000;  // per load, and per internal load on the way to one
    int recentre_limit = 20;      // charts, likewise
};

// The equilibria at `loads` (load factors of `branch`, in the order they are to be visited, warm-started one
// from the other). They are minima on the curve that starts at the design pose under the static loads; where
// that curve ends the outcome is branch_lost, whatever minima there may be elsewhere.
//
// Reactions of joints that repeat each other are not unique;
// these share the load with the smallest norm. Counts: `evaluations` of energy
// or constraints with derivatives, `iterations` are charts, `factorisations` are QR.
EquilibriumPath solve(const Model& model, const Branch& branch, std::span<const double> loads,
                      const Options& options = {});

// How well a state, from any leg, satisfies this leg's conditions: the constraints, and the gradient of the
// potential left over after the best multipliers. `direction` includes that orientations are unit
// quaternions. What cannot be judged is NaN: states that are no numbers, and forces once a bushing has turned
// by half a turn.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::reference::energy
