// The linear recursive formula, eqs. (25)-(29), and the methods that grew from it.
#pragma once

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"
#include "recursive/analysis.hpp"
#include "recursive/method.hpp"

namespace elastocheck::recursive {

// The arithmetic: float, double, long double.
enum class Precision { single, twofold, extended };

struct Options {
    Method method = {};  // published; what a method can be told besides is in its kind
    int steps = 0;       // equal increments of the parameter over the branch; 0: as many as the branch says
    int record = 0;      // equal increments between recorded points, a divisor of steps; 0: every step
    Precision precision = Precision::twofold;
    bool account = false;   // points carry their bound, and the stiffness that is left there (account.hpp):
    int account_every = 1;  // of those that are recorded each such, and the last
};

// Along one branch, from load factor 0 to branch.to: the recorded points, record + 1 (or steps + 1) of them.
// A point carries its configuration, |Φ| of eq. (31), and the joint wrenches. While nothing follows the
// bodies these are λⁿ⁻¹ with the Jacobian it was solved with, eq. (22); else λ with the present one.
//
// The published method takes one factorisation per step, and one more where static loads or preloads ask for
// λ⁻¹. `adaptive` takes steps of its own and evaluates the recorded points between them,
// as does `series`, in double precision only: std::invalid_argument for another.
//
// What is told of the model alone (analysis.hpp) can be given, and then serves any number of branches and,
// being constant, threads; std::invalid_argument where it is of another model.
//
// Thread-safe: calls keep nothing between them and may share a model, as long as nobody changes it meanwhile.
EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options,
                      const Analysis& analysis, const Visit& visit = {});
EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options = {},
                      const Visit& visit = {});

// How well a state, from any leg, satisfies the full nonlinear equations as this leg writes them; balances
// are formed from Equilibrium::reactions.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::recursive
