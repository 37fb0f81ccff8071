// The linear recursive formula, eqs. (25)-(29), and derived methods: solve() along a branch.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/recursive_method.hpp"

namespace elastocheck::recursive {

struct Analysis;  // of a model, shared by its branches: recursive/diagnosis/analysis.hpp

struct Options {
    Method method = {};  // published; its kind holds the method's own settings
    // equal increments of the parameter over the branch; 0: the branch's own number
    int steps = 0;
    // number of equal increments of the branch that are recorded, a divisor of steps; 0: every step
    int record = 0;
};

// Follows one branch from a = 0 to branch.to and returns record + 1 (or steps + 1) points. A point holds the
// poses, |Φ| of eq. (31), and the joint wrenches, eq. (22): of λⁿ⁻¹ with the Jacobian of its solve in
// methods whose stored forces do not follow the bodies (published, closed), else of λ with the
// current Jacobian.
//
// The published method takes one factorisation per step, and one more where static loads or preloads require
// λ of the start (λⁿ⁻¹ of the first step). `adaptive` and `series` choose their own steps and evaluate
// the recorded points between them.
//
// The analysis of the model may be passed in and shared between branches and
// threads; std::invalid_argument where it is of another model.
//
// Thread-safe: calls keep no state and may share a model that no thread changes meanwhile.
EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options,
                      const Analysis& analysis, const PointVisitor& visit = {});
EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options = {},
                      const PointVisitor& visit = {});

// Residuals of a state from any leg in the full nonlinear equations of this leg; balances are
// formed from Equilibrium::reactions.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::recursive
