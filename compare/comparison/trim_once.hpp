// A trim with the preloads of the bushings as they are: a step of a trim that balances them.
#pragma once

#include "compare/comparison/legs.hpp"
#include "compare/comparison/trim.hpp"

namespace elastocheck::compare {

constexpr double acceptable = 1e-9;  // [m, rad]: of a condition, where Newton's method stagnates

// A trimmed scene as it settles.
struct SettledTrim {
    BranchSide held;
    Equilibrium state;
};

// Pre: scene.trim. By one leg; confirmed by the energy leg or, where that does not apply, by the
// series. `start` and `settles` may be null.
Trimmed trim_once(const Scene& scene, Leg solver, bool confirm, TrimStart* start,
                  SettledTrim* settles);

// What the conditions are counted from, as drawn and as requested, difference [m, rad].
Eigen::VectorXd requested_from_drawn(const Scene& scene);

}  // namespace elastocheck::compare
