// Linearised system at a given state and its solutions: common part of the response to disturbances
// and of the states of neighbouring models.
#pragma once

#include <string>

#include "reference/equilibrium/linear_algebra/linearisation.hpp"

namespace elastocheck::reference::equilibrium {

struct StateTangent {
    System system;  // of the branch, its drivers frozen at the state's a
    Loading loading;
    Eigen::VectorXd x = {};  // poses of the state, and the reactions that leave the least imbalance
    Linearisation at = {};
    // singular where the branch turns back or bifurcates, not_finite; then `at` must not be used
    Outcome outcome = Outcome::converged;
    std::string what = {};
};
// What states of models of one structure share, from the last of them: the positions of the terms
// in J, and the elimination orders of J and of the least-squares system of the reactions.
struct Orders {
    std::shared_ptr<const Pattern> pattern = {};
    Factors of_J = {}, of_reactions = {};
};
// Throws std::invalid_argument where state, model and branch do not fit.
StateTangent tangent_at(const Model& model, const Branch& branch, const Equilibrium& state,
                        Orders& orders);

// Solves J dx = -E_rate, with minimum-norm motion in the idle modes. `rounding`: error of the
// entries of E_rate, where that is more than their own last digits; a part of E_rate outside the
// range of J up to this is ignored.
struct Solved {
    Outcome outcome = Outcome::converged;
    std::string what;  // half a sentence on the failure
    Eigen::VectorXd dx;
};
Solved solve_at_state(const StateTangent& tangent, const Eigen::VectorXd& E_rate,
                      double rounding = 0);

}  // namespace elastocheck::reference::equilibrium
