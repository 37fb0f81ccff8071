// Linearised system at a given state and its answers: common part of the response to disturbances
// and of the states of neighbouring models.
#pragma once

#include <string>

#include "reference/equilibrium/linear_algebra/linearisation.hpp"

namespace elastocheck::reference::equilibrium {

struct StateTangent {
    System system;  // of the branch, its drivers frozen at the state's a
    Loading loading;
    Eigen::VectorXd x = {};  // the poses of the state, with the reactions of least imbalance
    Linearisation at = {};
    // singular where the branch turns back, not_finite; then `at` must not be used
    Outcome outcome = Outcome::converged;
    std::string what = {};
};
// Places of the terms in J, and the orders of elimination of J and of the system of its reactions: of the
// last state of a model of this structure.
struct Orders {
    std::shared_ptr<const Pattern> pattern = {};
    Factors of_J = {}, of_reactions = {};
};
// Throws std::invalid_argument where state, model and branch do not fit.
StateTangent tangent_at(const Model& model, const Branch& branch, const Equilibrium& state,
                        Orders& orders);

// J dx = -E_rate, with minimum-norm motion in the idle modes. `rounding`: of the entries of E_rate,
// where that is more than their own last digits; a part outside the range of J that is smaller does
// not count.
struct Solved {
    Outcome outcome = Outcome::converged;
    std::string what;  // half a sentence on the failure
    Eigen::VectorXd dx;
};
Solved solve_at_state(const StateTangent& tangent, const Eigen::VectorXd& E_rate,
                      double rounding = 0);

}  // namespace elastocheck::reference::equilibrium
