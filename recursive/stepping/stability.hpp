// Stability of an equilibrium: inertia of its reduced Hessian, idle modes under load, settled
// start.
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
// weight standing on a ball). With Z the idle modes that share bodies, orthonormal in W and in the
// null space of Φ_q,
//
//   zᵀKz < 0, z in Z      the energy falls along z: the equilibrium is unstable
//
// K includes the curvature of the joint reactions.
#pragma once

#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

// Whether the forces derive from an energy. A load that turns with its body has none, and then the
// symmetric part of its K does not decide stability.
bool has_energy(const Model& model, const Branch& branch);

// Whether the equilibrium whose consistent tangent is in the system has a negative eigenvalue.
// False where the negative pivot may be round-off, which grows with ρ, and where K is not
// symmetric.
bool is_unstable(const SteppingState<double>& s);

// Stability of the start, whose matrix is in the system. Settling from a drawing far from rest may
// lead to an unstable equilibrium, and a drawing at rest may be one. The result for the latter is in
// the analysis: it is the same for all branches, apart from the energy of their loads.
StartStability start_stability(SteppingState<double>& s);
// `singular` if the start of the branch is unstable.
Outcome check_start_stability(SteppingState<double>& s, const StartStability& start);

// Whether the parabola through log₂ |determinant| at the ends and the middle of a step, taken as
// values, falls below half of the least of them or below 2 % of their range in between.
bool determinant_dips(double log_from, double log_middle, double log_to);

// The smallest eigenvalue of the symmetric part of Q.
double least_eigenvalue(const Eigen::MatrixXd& Q);

// The least eigenvalue of ZᵀKZ over all groups of idle modes, K of the consistent matrix in the
// system; 0 where none is negative beyond rounding.
template <class Real>
double least_of_idle(const SteppingState<Real>& s) {
    constexpr double several = 256;  // multiple of the rounding of a sum
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const Held<Real>& held = s.system.held;
    const SaddleMatrix<Real>& M = s.system.M;
    double least = 0;
    for (int first = 0, end = 0; first < held.idle; first = end) {
        for (end = first + 1; end < held.idle && held.with[static_cast<std::size_t>(end)] == first;)
            ++end;
        const int modes = end - first, places = held.end(first) - held.begin(first);
        const auto z = [&](int mode, int place) {
            return Eigen::Map<const Vector6<Real>>(held.value.data() + held.begin(first + mode) +
                                                   place);
        };
        const auto body = [&](int place) {
            return held.row[static_cast<std::size_t>(held.begin(first) + place)] / 6;
        };
        Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(modes, modes), sizes = Q;
        for (int i = 0; i < places; i += 6)
            for (int j = 0; j < places; j += 6) {
                const int at = M.block_at(body(i), body(j));
                if (at < 0) continue;
                const Eigen::Map<const Matrix6<Real>> K(M.values.data() + at);
                for (int a = 0; a < modes; ++a)
                    for (int b = 0; b < modes; ++b) {
                        Q(a, b) += static_cast<double>(z(a, i).dot(K * z(b, j)));
                        sizes(a, b) += static_cast<double>(
                            z(a, i).cwiseAbs().dot(K.cwiseAbs() * z(b, j).cwiseAbs()));
                    }
            }
        if (!Q.allFinite()) continue;
        if (const double lowest = least_eigenvalue(Q); lowest < -several * epsilon * sizes.norm())
            least = std::min(least, lowest);
    }
    return least;
}

// The least stiffness of an idle mode at the equilibrium near (q, λ) if the acting forces make that
// mode unstable, else 0. Pre: the consistent matrix at (q, λ) is in the system and factorised.
// Unstable means below -10⁻⁶ times (forces / L), which exceeds the effect of the residual, both at
// (q, λ) and at the equilibrium after corrections. The system is left factorised at one of the two.
template <class Real>
double negative_idle_stiffness(SteppingState<Real>& s, const State<Real>& near,
                               const Vector<Real>& lambda_near) {
    constexpr int corrections = 3;
    constexpr double noticed = 1e-6;
    if (s.system.held.idle == 0 || !has_energy(s.model, s.branch)) return 0;
    const auto least = [&](const State<Real>& q) {
        const double stiffness = least_of_idle(s);
        if (!(stiffness < 0)) return 0.;
        external_force<Real>(s.model, s.branch, s.inputs, q, s.upper);
        elastic_force<Real>(s.model, s.inputs, q, s.force);
        const Real acts = size_of_force(s, s.upper) + size_of_force(s, s.force);
        return stiffness < -noticed * static_cast<double>(acts) / s.length ? stiffness : 0.;
    };
    if (!(least(near) < 0)) return 0;
    const Counts counts = s.counts;  // a check only: not counted
    State<Real> q = near;
    Vector<Real> lambda = lambda_near;
    bool there = true;
    for (int k = 0; k < corrections && there; ++k) {
        residual_at(s, q, lambda);
        back_substitute(s);
        there = s.x.allFinite();
        s.dq = s.x.head(s.n());
        advance(q, s.dq);
        lambda += s.x.tail(s.m());
        there = there && factorise_at(s, q, lambda) == Outcome::converged;
    }
    s.counts = counts;
    return there ? least(q) : 0;
}

// Instantiated in stepping/sweep_double.cpp.
extern template double negative_idle_stiffness<double>(SteppingState<double>&, const State<double>&,
                                                       const Vector<double>&);

}  // namespace elastocheck::recursive
