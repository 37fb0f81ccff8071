// The linear recursive formula: eqs. (25)-(29).
#pragma once

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::recursive {

struct Options {
    int steps = 0;  // equal load increments over the branch; 0: as many as the branch says
};

// The published method along one branch: steps + 1 points from load factor 0 to branch.to. Point n carries the
// configuration qⁿ, |Φ(qⁿ)| of eq. (31), and the joint wrenches of λⁿ⁻¹ with the Jacobian they were solved with, eq. (22).
// One factorisation per step, and one more where static loads or preloads ask for λ⁻¹ (design.md 3.1 (e)).
EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options = {});

// How well a state, from any leg, satisfies the full nonlinear equations as this leg writes them; balances are formed
// from Equilibrium::reactions.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::recursive
