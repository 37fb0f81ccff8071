// Newton's method from arbitrary starts, for equilibria off the branch, and a choice of starts.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "elastocheck/equilibrium.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reference::equilibrium {

struct FromStart {
    // else iteration_limit, singular, not_finite; branch_lost: converges to a known state
    Outcome outcome = Outcome::converged;
    Equilibrium state = {};  // valid where it converged
    // Stiffness::least at the state (stability.hpp)
    double stiffness = std::numeric_limits<double>::quiet_NaN();
    // the least eigenvalue is above zero by more than its round-off; without an energy, stability
    // against divergence alone (stability.hpp)
    bool stable = false;
};

// Equilibrium at a that Newton's method reaches from `start`, different from those that are `known`
// at this a. Intermediate states are unrestricted, so the result is an equilibrium of the model,
// not a point of the branch.
//
// Throws as `solve` does, and std::invalid_argument unless `start` and the known states have one
// pose per body.
FromStart solve_from(const Model& model, const Branch& branch, double a,
                     const std::vector<Pose>& start, std::span<const Equilibrium> known = {},
                     const Options& options = {});

// Poses beside an equilibrium, on both sides along each of its `motions` softest free motions, at
// the distances `lengths` (shares of the model's size, or radians). Excludes idle motions; empty
// for models of more than a hundred bodies.
std::vector<std::vector<Pose>> beside(const Model& model, const Branch& branch,
                                      const Equilibrium& state, int motions,
                                      std::span<const double> lengths);

// Distance of two states, as in pose_size: shares of the model's size, radians; idle motions
// at `a` excluded.
double distance(const Model& model, const Branch& branch, const Equilibrium& a,
                const Equilibrium& b);

}  // namespace elastocheck::reference::equilibrium
