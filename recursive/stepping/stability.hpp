// Stability of an equilibrium: inertia of its reduced Hessian, idle modes under
// load, settled start.
//
// Inertia: with Z a basis of the motions that the joints allow, ZᵀKZ is positive definite if and
// only if K + ρ Φ_qᵀ Φ_q is for some ρ (Finsler, Debreu). That matrix has as many negative
// eigenvalues as its LDLᵀ has negative pivots (Sylvester). One factorisation covers every mode of
// any stiffness. The few softest modes (stiffness.hpp) are not all, and two negative modes leave
// the sign of the determinant unchanged.
//
// Idle modes are motions that nothing resists at the unloaded design position. The border of (24)
// holds them, and the other stability tests do not cover them. Under load the acting forces may
// resist them (a pendulum under its weight) or make them unstable (a rod under axial compression, a
// weight standing on a ball). With Z the idle modes that share bodies, orthonormal in |W x| (W: 1
// for Δr, L for Δπ) and in the null space of Φ_q,
//
//   zᵀKz < 0, z in Z      the energy falls along z: the equilibrium is unstable
//
// K includes the curvature of the joint reactions.
#pragma once

#include <array>
#include <functional>

#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

// Whether the forces derive from an energy. A load that turns with its body has none, and then the
// symmetric part of its K does not decide stability.
bool has_energy(const Model& model, const Branch& branch);

// Whether the equilibrium whose consistent tangent is in the system has a negative
// eigenvalue. False where the negative pivot may be round-off, which grows with ρ, and where
// K is not symmetric.
bool is_unstable(const SteppingState& s);

// Stability of the start, whose matrix is in the system. Settling from a drawing far from rest may
// lead to an unstable equilibrium, and a drawing at rest may be one. The result for the latter is
// in the analysis: it is the same for all branches, apart from the energy of their loads.
StartStability start_stability(SteppingState& s);
// `singular` if the start of the branch is unstable.
Outcome check_start_stability(SteppingState& s, const StartStability& start);

// Whether |determinant| dips within a step, from its log₂ at the ends and the middle: the middle is
// below half of both ends, or the parabola through the three determinants falls below half of the
// least of them or below 2 % of their range.
bool determinant_dips(double log_from, double log_middle, double log_to);

// The lowest determinant found within a step, given its values at t = 0, ½ and 1, both ends
// positive. `determinant_at(t)` evaluates it: first where the parabola through these three has its
// minimum, then with that value in place of one of them, until a value is negative or the parabola
// no longer dips. A minimum predicted a little outside the step counts too: the next step begins
// past it.
struct Dip {
    double t = 0, value = 0;
};
Dip lowest_determinant(std::array<double, 3> values,
                       const std::function<double(double)>& determinant_at);
// Whether lowest_determinant() would evaluate the determinant for these values, or values[1] < 0.
bool may_reach_zero(const std::array<double, 3>& values);

// The smallest eigenvalue of the symmetric part of Q.
double min_eigenvalue(const Eigen::MatrixXd& Q);

// The least eigenvalue of ZᵀKZ over all groups of idle modes, K of the consistent matrix in the
// system; 0 where none is negative beyond rounding.
double min_of_idle(const SteppingState& s);

// The least stiffness of an idle mode at the equilibrium near (q, λ) if the acting forces make that
// mode unstable, else 0. Pre: the consistent matrix at (q, λ) is in the system and factorised.
// Unstable means below -10⁻⁶ times (forces / L), which exceeds the effect of the residual, both at
// (q, λ) and at the equilibrium after corrections. The system is left factorised at one of the two.
double negative_idle_stiffness(SteppingState& s, const State<double>& near,
                               const Vector<double>& lambda_near);

}  // namespace elastocheck::recursive
