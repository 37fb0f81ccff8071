// Whether an equilibrium is stable, and a step from one to the next stays so.
//
// What the constraints leave free is Z, an orthonormal basis of the null space of Φ_q. There the equilibrium
// is as stiff as
//
//   M = -Zᵀ ∂(balance)/∂q Z      [d × d]
//
// the Hessian of the energy with its constraints' curvature, over F L. A path of equilibria on which no
// eigenvalue of M reaches zero neither divides nor turns back nor loses its stability. A sign at both ends of
// a step says nothing of what lies between, so the least eigenvalue is followed over each step by a parabola
// through its ends and its middle.
#pragma once

#include "reference/equilibrium/linearisation.hpp"

namespace elastocheck::reference::equilibrium {

// With a follower, or a bushing whose formulation has no energy, M is not symmetric, and what is meant by stable is
// less: whether the equilibrium would flutter is a question of masses, which a statics model does not have. What
// statics can say is that no other equilibrium passes through this one and that the branch does not turn, that is,
// that det M keeps its sign (divergence, not flutter).

// Of M without its idle modes: the least eigenvalue (the modulus where it is complex, which takes a dead
// moment: a zero eigenvalue is what matters), and the size below which it is round-off. Where the system has no
// energy: the least modulus, with the sign of det M, and the number of negative real eigenvalues, which may change
// only in pairs away from zero. 1 where nothing is free. NaN if J is.
struct Stiffness {
    double least = 1;
    double round_off = 0;
    int negative = 0;
};
Stiffness stiffness(const System& system, const Linearisation& at);

// M is never formed. By Debreu, it is positive definite where K + ρ Φ_qᵀ Φ_q is for some ρ, K the symmetric part of
// -∂(balance)/∂q, of which it is a part; and its eigenvalues next to zero are the largest of its inverse, which is in the
// solution of the linearised system:
//
//   ⎡ -K   Φ_qᵀ ⎤ ⎧ x ⎫   ⎧ -b ⎫
//   ⎣ Φ_q   0   ⎦ ⎩ λ ⎭ = ⎩  0 ⎭      x = Z M⁻¹ Zᵀ b
//
// Where M is not surely definite, 200 of them are asked for: all, of all suspensions here. Beyond, a pair of negative
// eigenvalues that has come far past zero within one step may be overlooked where there is no energy.

enum class Stability {
    kept,
    lost,      // an eigenvalue is negative somewhere
    uncertain  // the parabola dips: a shorter step will tell
};
Stability over_step(const Stiffness& from, const Stiffness& middle, const Stiffness& to);

// Whether the constraints, which may divide too, have done so on a step. The determinant of J has that of Φ_q in it
// twice and does not notice; that of
//
//   ⎡ Φ_q  U ⎤
//   ⎣ Zᵀ   0 ⎦     Z, U: null spaces of Φ_q and Φ_qᵀ where the step begins
//
// changes its sign where Φ_q loses rank. Times its transpose where the step begins, whose determinant is the same there,
// it is  ⎡ Φ_q Φ_q(from)ᵀ + U Uᵀ   Φ_q Z ⎤
//        ⎣          0                1   ⎦, so that Z is not needed: det (Φ_q Φ_q(from)ᵀ + U Uᵀ) stays positive.
bool constraints_keep_their_side(const System& system, const Linearisation& from, const Linearisation& to);

}  // namespace elastocheck::reference::equilibrium
