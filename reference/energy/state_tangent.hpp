// Linearised conditions at a given state and their answers: common part of the response to
// disturbances and of the states of neighbouring models.
#pragma once

#include <Eigen/LU>
#include <optional>
#include <string>

#include "reference/energy/minimise/branch.hpp"

namespace elastocheck::reference::energy {

// In ξ and units of F·L.
struct StateTangent {
    State state;
    Course course;
    Prescribed prescribed;  // at the state's a
    Scales scales;
    Eigen::VectorXd S, D, lambda;            // lambda of Φ, SI
    Eigen::MatrixXd K;                       // H + A, A that of loads without potential
    Eigen::MatrixXd Z, idle;                 // resisting motions, and idle ones
    Eigen::PartialPivLU<Eigen::MatrixXd> W;  // ZᵀKZ
    std::optional<Failure> failure;          // then nothing else is set
};
// Throws std::invalid_argument where the branch has parts that are inactive on it or two sides.
// Failures: not_conservative, too_large, not_finite, branch_lost.
StateTangent tangent_at(const Model& model, const Branch& branch, const Equilibrium& state);

// The change dx, SI, of the stationary point where its conditions change by
//   b   of ∂V/∂x + Φ_qᵀ λ [6nb],   Phi_rate   of Φ [m]; empty: none
// Idle motions are held. `rounding` of b, in units of F·L per ξ, where that is more than its own last
// digits: a smaller load on an idle motion does not count; infinite: neither that nor Φ is judged.
struct Answer {
    Outcome outcome = Outcome::converged;
    std::string what;  // half a sentence on the failure
    Eigen::VectorXd x;
    Eigen::VectorXd left;  // what the multipliers have to balance: of ∂V/∂ξ, units of F·L
};
Answer answer(const StateTangent& at, const Eigen::VectorXd& b, const Eigen::VectorXd& Phi_rate,
              double rounding = 0);
// The change dλ, SI, that belongs to it.
Eigen::VectorXd multiplier_rates(const StateTangent& at, const Answer& answer);

}  // namespace elastocheck::reference::energy
