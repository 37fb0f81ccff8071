// Linearised equilibrium conditions at a given state, and their solution for a change of the
// right-hand side: the part that the response to disturbances and the states of neighbouring models
// share.
//
// With V the potential, x the 6nb coordinates of the chart at the state, Φ the m constraints, H the
// Hessian of V + λᵀ Φ and A the slope of the loads that have no potential, a change b of ∂V/∂x +
// Φ_qᵀ λ and Φ_rate of Φ moves the stationary point by dx and λ by dλ:
//
//   ⎡ H + A   Φ_qᵀ ⎤ ⎧ dx ⎫     ⎧   b    ⎫
//   ⎣  Φ_q     0   ⎦ ⎩ dλ ⎭ = - ⎩ Φ_rate ⎭
//
// It is solved in ξ = S⁻¹ x and forces in units of F·L (scales.hpp), within the null space Z of
// Φ_q:
//
//   t: shortest with Φ_q t = -Φ_rate      Zᵀ K Z u = -Zᵀ (b + K t)      dξ = t + Z u,   K = H + A
#pragma once

#include <Eigen/LU>
#include <optional>
#include <string>

#include "reference/energy/minimise/branch.hpp"

namespace elastocheck::reference::energy {

// In ξ and units of F·L; n = 6nb coordinates, r motions that K resists.
struct StateTangent {
    State state;
    Course course;
    Prescribed prescribed;  // at the state's a
    Scales scales;
    Eigen::VectorXd S, D;                    // scales of x [n] and of the rows of Φ [m]
    Eigen::VectorXd lambda;                  // multipliers of Φ [m], SI
    Eigen::MatrixXd K;                       // H + A [n × n]
    Eigen::MatrixXd Z;                       // motions that K resists, a basis [n × r]
    Eigen::MatrixXd idle;                    // motions that nothing resists, by columns
    Eigen::PartialPivLU<Eigen::MatrixXd> W;  // of ZᵀKZ [r × r]
    std::optional<Failure> failure;          // if set, nothing else is
};
// Throws std::invalid_argument where the branch has parts that are inactive on it or two sides.
// Failures: not_conservative, too_large, not_finite, branch_lost.
StateTangent tangent_at(const Model& model, const Branch& branch, const Equilibrium& state);

// The change dx for b [6nb] and Phi_rate [m] (empty: none), both SI. Idle motions are held.
// `rounding` is the error of b in units of F·L per ξ, if it is larger than that of its last digits:
// a load on an idle motion below it does not count. If it is infinite, neither loads on idle
// motions nor redundant rows of Φ are checked.
//
// Outcomes, the first that holds, with size = |b|_∞ + |K t|_∞ and rest = b + K dξ the part that the
// multipliers balance:
//
//   inconsistent_constraints   |Φ_q t + Φ_rate| > 1e-9 |Φ_rate|
//   not_finite                 dξ is not finite
//   singular                   |Zᵀ rest|_∞ > 1e-3 size after one correction: ZᵀKZ is only rounding
//   loaded_idle_mode           |idleᵀ rest|_∞ > 1e-8 size + rounding
struct TangentSolution {
    Outcome outcome = Outcome::converged;
    std::string what;      // half a sentence on the failure
    Eigen::VectorXd x;     // dx [6nb], SI
    Eigen::VectorXd rest;  // [6nb], units of F·L
};
TangentSolution solve_tangent(const StateTangent& tangent, const Eigen::VectorXd& b,
                              const Eigen::VectorXd& Phi_rate, double rounding = 0);
// The change dλ [m], SI, of the same solution.
Eigen::VectorXd multiplier_rates(const StateTangent& tangent, const TangentSolution& solution);

}  // namespace elastocheck::reference::energy
