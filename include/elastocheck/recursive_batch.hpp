// Many variants of a model by the method `series`: the same parts between the same bodies, with other
// numbers.
#pragma once

#include "elastocheck/recursive.hpp"

namespace elastocheck::recursive {

struct BatchOptions {
    // Every expansion of a lane has this order; over the parameter of the branch, not arc length.
    Series series = {.order = 24};
    int points = 20;  // equal increments between recorded points of a branch
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
// The result of a variant is that of solve() with the method `series` and options.series, within 1e-12 of the
// largest coordinate and of the largest force; it does not depend on the other variants. A variant that has another structure than
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

}  // namespace elastocheck::recursive
