// The linear recursive formula, eqs. (25)-(29), and derived methods: solve() along a branch,
// solve_batch() for many variants of a model.
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
// methods without following forces (published, closed), else of λ with the current Jacobian.
//
// The published method takes one factorisation per step, and one more where static loads or preloads require
// λ⁻¹. `adaptive` and `series` choose their own steps and evaluate the recorded points between them.
//
// The analysis of the model may be passed in and shared between branches and
// threads; std::invalid_argument where it is of another model.
//
// Thread-safe: calls keep no state and may share a model that no thread changes meanwhile.
EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options,
                      const Analysis& analysis, const PointVisitor& visit = {});
EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options = {},
                      const PointVisitor& visit = {});

// ---- Many variants of a model: the same parts between the same bodies, with other numbers.

struct BatchOptions {
    Series series = {};  // over the parameter of the branch, not arc length
    int points = 20;     // equal increments between recorded points of a branch
    // Record the joint wrenches of the points, and |Φ|; else the wrenches are zero, |Φ| is NaN.
    bool wrenches = true;
};
// Receives the path of every branch of every variant (positions in `variants` and in its
// Model::branches), points + 1 points where the outcome is `converged`; branches of one variant in
// their order, variants in any order. The reference is valid during the call only.
using VisitBatch =
    std::function<void(std::size_t variant, std::size_t branch, const EquilibriumPath& path)>;

// Follows all branches of all variants by `series`, four variants at a time in one arithmetic, each
// branch from a = 0 to branch.to. A branch with two sides is two branches here (branch_sides() in
// models/branch.hpp), and every part of a model is active on all its branches.
//
// The result of a variant is that of solve() with the method `series`, within 1e-12 of the largest coordinate
// and of the largest force; it does not depend on the other variants. A variant that has another structure than
// the design, ends early, or comes close to the threshold of any decision of the algorithm is solved alone: its
// path is that of solve(), with its Outcome. So a NaN in one variant is reported for that variant.
//
// Pivot order, scaling and idle modes are those of the design, whose analysis may be passed in.
// Throws std::invalid_argument as solve() does. Thread-safe as solve(): divide the variants among
// threads, with one call each.
void solve_batch(const Model& design, const Analysis& analysis, std::span<const Model> variants,
                 const BatchOptions& options, const VisitBatch& visit);
void solve_batch(const Model& design, std::span<const Model> variants, const BatchOptions& options,
                 const VisitBatch& visit);

// Residuals of a state from any leg in the full nonlinear equations of this leg; balances are
// formed from Equilibrium::reactions.
Residuals residuals(const Model& model, const Branch& branch, const Equilibrium& state);

}  // namespace elastocheck::recursive
