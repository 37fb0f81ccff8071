// One trim with the preloads of the bushings as they are. A trim that balances the bushings
// (balanced_trim.cpp) repeats it with corrected preloads.
#pragma once

#include "compare/comparison/legs.hpp"
#include "compare/comparison/trim.hpp"

namespace elastocheck::compare {

// Largest residual |c| of the conditions [m, rad] (elastocheck/trim.hpp) that is accepted where
// Newton's method does not reduce it further.
constexpr double accepted_residual = 1e-9;

// The equilibrium of a trimmed scene at a = 0.
struct SettledTrim {
    BranchSide side;  // a branch without motion, whose drivers have the values of the adjustments
    Equilibrium state;
};

// Pre: scene.trim. Solves the trim equations by the leg `solver`. With `confirm` the energy leg
// confirms the result or, where that does not apply, the series. `start`: as for trim_by_series();
// `settled` receives the state of a trim that is reached. Both may be null.
Trimmed trim_once(const Scene& scene, Leg solver, bool confirm, TrimStart* start,
                  SettledTrim* settled);

// Requested value less the value in the design position, for each condition [m, rad].
Eigen::VectorXd requested_from_drawn(const Scene& scene);

}  // namespace elastocheck::compare
