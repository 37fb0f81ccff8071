// Stability of an equilibrium, and of all equilibria on a continuation step.
//
// Z is an orthonormal basis of the null space of Φ_q, the motions that the constraints allow. The
// stiffness of the equilibrium in these motions is the reduced Hessian
//
//   M = -Zᵀ ∂(balance)/∂q Z      [d × d]
//
// that is, the Hessian of the energy with the curvature of the constraints, over F L. A path of
// equilibria on which no eigenvalue of M reaches zero has no bifurcation, no limit point and no
// loss of stability. Equal signs at both ends of a step do not exclude a zero in between, so the
// least eigenvalue is interpolated over each step by a parabola through its ends and its middle. An
// eigenvalue that is not the least at these three places may dip between them, so det M is
// interpolated too.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "reference/equilibrium/linear_algebra/linearisation.hpp"

namespace elastocheck::reference::equilibrium {

// With a follower load, or a bushing formulation without energy, M is not symmetric, and the
// criterion is weaker: flutter depends on masses, which a statics model does not have. Statics can
// decide that no other equilibrium passes through this one and that the branch does not turn back,
// that is, that det M keeps its sign (stability against divergence, not flutter).

// Spectrum of M without its idle modes: the least eigenvalue (the modulus where it is complex,
// which requires a dead moment, since only the distance from zero matters), and the size below
// which it is round-off. For a system without energy: the least modulus with the sign of det M, and
// the number of negative real eigenvalues, which may change only in pairs away from zero. 1 where
// nothing is free. NaN if J is.
struct Stiffness {
    double least = 1;
    double round_off = 0;
    int negative = 0;
    Eigen::Index redundant = 0;  // constraints, of which the null space has as many self-stresses
    // log₂ |det M| without its idle modes, where M was formed; else NaN
    double log_determinant = std::numeric_limits<double>::quiet_NaN();
};
Stiffness stiffness(const System& system, const Linearisation& at);

// The same from J alone, given the number of its idle modes and of redundant constraints; empty for
// more than a dozen bodies, and where a stiffness is neither rounding nor well above it.
std::optional<Stiffness> stiffness_of_few(const System& system, const Sparse& J, Eigen::Index idle,
                                          Eigen::Index redundant);

// For more bodies M is not formed. By Finsler's theorem (Debreu 1952), M is positive definite iff
// K + ρ Φ_qᵀ Φ_q is for some ρ, with K the symmetric part of -∂(balance)/∂q. The eigenvalues of M
// next to zero are the largest of its inverse, which is contained in the solution of the linearised
// system:
//
//   ⎡ -K   Φ_qᵀ ⎤ ⎧ x ⎫   ⎧ -b ⎫
//   ⎣ Φ_q   0   ⎦ ⎩ λ ⎭ = ⎩  0 ⎭      x = Z M⁻¹ Zᵀ b
//
// Where definiteness is not certain, 200 eigenvalues are computed, which is all of them for every
// suspension here. In larger models without energy, a pair of negative eigenvalues that moves far
// past zero within one step may be missed.

// λ the least eigenvalue of M at the start, the middle and the end of a step.
enum class Stability {
    kept,  // min λ ≥ -round_off, and the parabola through the three values stays above zero
    lost,  // min λ < -round_off
    // λ is not finite, the number of negative eigenvalues changes, or the parabola of λ or of det M
    // dips to zero between the three places: a shorter step is needed
    uncertain
};
// `logs`: log₂ of a determinant with the zeros of det M, at the same three places.
Stability over_step(const Stiffness& from, const Stiffness& middle, const Stiffness& to,
                    const std::array<double, 3>& logs = {0, 0, 0});

// Whether the constraints stay on one side of a bifurcation of their own on a step. det J contains
// det Φ_q squared and keeps its sign there; the determinant of
//
//   ⎡ Φ_q  U ⎤
//   ⎣ Zᵀ   0 ⎦     Z, U: null spaces of Φ_q and Φ_qᵀ where the step begins
//
// changes sign where Φ_q loses rank. Times its transpose at the start of the step, whose
// determinant is the same there, it is
//
//   ⎡ Φ_q Φ_q(from)ᵀ + U Uᵀ   Φ_q Z ⎤
//   ⎣          0                1   ⎦
//
// so that Z is not needed: det (Φ_q Φ_q(from)ᵀ + U Uᵀ) stays positive.
bool constraints_keep_their_side(const System& system, const Linearisation& from,
                                 const Linearisation& to);

}  // namespace elastocheck::reference::equilibrium
