// The linear recursive formula, eqs. (25)-(29), and derived methods: solve() along a branch.
#pragma once

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/recursive_method.hpp"

namespace elastocheck::recursive {

struct Analysis;  // of a model, shared by its branches: recursive/diagnosis/analysis.hpp

// The arithmetic of a method with equal steps: float, double, long double.
enum class Precision { single, double_precision, extended };

struct Options {
    Method method = {};  // published; its kind holds the method's own settings
    // equal increments of the parameter over the branch; 0: the branch's own number
    int steps = 0;
    int record = 0;  // equal increments between recorded points, a divisor of steps; 0: every step
    Precision precision = Precision::double_precision;
    // compute the error bound and remaining stiffness (error_bound.hpp) at recorded points
    bool error_bound = false;
    int error_bound_every = 1;  // ... at every so many of them, and at the last
};

// Follows one branch from load factor 0 to branch.to and returns the recorded points, record + 1
// (or steps + 1) of them. A point holds its configuration, |Φ| of eq. (31), and the joint wrenches.
// In methods without following forces these are λⁿ⁻¹ with the Jacobian of its solve, eq. (22); else
// λ with the current Jacobian.
//
// The published method takes one factorisation per step, and one more where static loads or
// preloads require λ⁻¹. `adaptive` and `series` choose their own steps and evaluate the recorded
// points between them, in double precision only: std::invalid_argument for another precision.
//
// The analysis of the model may be passed in and shared between branches and
// threads; std::invalid_argument where it is of another model.
//
// Thread-safe: calls keep no state and may share a model that no thread changes meanwhile.
EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options,
                      const Analysis& analysis, const Visit& visit = {});
EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options = {},
                      const Visit& visit = {});

// Residuals of a state from any leg in the full nonlinear equations of this leg; balances are
// formed from Equilibrium::reactions.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::recursive
