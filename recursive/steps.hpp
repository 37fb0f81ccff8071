// One load increment, eqs. (25)-(29), and its kin.
#pragma once

#include "recursive/march.hpp"

namespace elastocheck::recursive {

// f_ext for the coming step. Where the load does not follow, what is already applied keeps its moment, and
// only the increment is formed at the present lever.
template <class Real>
void apply_load(March<Real>& s, Real next) {
    if (s.method.follow.load) {
        external_force<Real>(s.model, s.branch, next, s.q, s.applied);
    } else {
        add_loads<Real>(s.branch.loads, next - s.a, s.q, s.applied);
    }
}

// f_elast at the configuration just reached, as far as it follows:
//
//   nothing   f_elast⁺ = f_ext - Φ_q(qⁿ)ᵀ λⁿ: the upper row just solved. With it the next right-hand side
//             f_ext - f_elast is that of (29), and by induction that of (28)
//   lever     each element's sum of K_T Δr', K_R Δπ, at the present position of its attachment points
//   axis      each element's true force, its increments added up at the levers of their time
//   both      the law itself
template <class Real>
void store(March<Real>& s) {
    const Follow& follow = s.method.follow;
    if (follow.lever && follow.axis) return elastic_force<Real>(s.model, s.q, s.stored);
    if (!follow.lever && !follow.axis) {
        s.stored.noalias() = s.applied - s.system.M.topRightCorner(s.n(), s.m()) * s.lambda;
        return;
    }
    if (follow.lever) s.stored.setZero();
    for (std::size_t k = 0; k < s.model.elastics.size(); ++k)
        std::visit(
            [&](const auto& e) {
                ElementForce<Real>& kept = s.element[k];
                const ElementForce<Real> now = element_force<Real>(e, s.q);
                const auto motion = [&](BodyId b) -> Vector6<Real> {
                    return b == ground ? Vector6<Real>::Zero()
                                       : Vector6<Real>(s.dq.template segment<6>(6 * b));
                };
                const auto k_e = element_stiffness<Real>(e, s.before);
                if (follow.lever) {
                    const Vector6<Real> dq_i = motion(k_e.i), dq_j = motion(k_e.j);
                    Vector6<Real> de;  // (12)-(13)
                    de << dq_j.template head<3>() - k_e.s_j.cross(dq_j.template tail<3>()) -
                              dq_i.template head<3>() + k_e.s_i.cross(dq_i.template tail<3>()),
                        dq_j.template tail<3>() - dq_i.template tail<3>();
                    const Vector6<Real> df = k_e.K * de;
                    kept = {kept.F + df.template head<3>(), kept.M + df.template tail<3>(), now.lever_i,
                            now.lever_j};
                    add_element_force<Real>(e.i.body, e.j.body, kept, s.stored);
                } else {
                    const ElementForce<Real> increment{now.F - kept.F, now.M - kept.M, k_e.s_i, k_e.s_j};
                    add_element_force<Real>(e.i.body, e.j.body, increment, s.stored);
                    kept = now;
                }
            },
            s.model.elastics[k].kind);
}

// From (qⁿ, aⁿ) to (qⁿ⁺¹, next).
//
// ⎡ K(qⁿ)    Φ_q(qⁿ)ᵀ ⎤ ⎧ Δq ⎫ⁿ   ⎧ f_ext - f_elast ⎫
// ⎣ Φ_q(qⁿ)     0     ⎦ ⎩ λ  ⎭  = ⎩   0  or  -Φ(qⁿ)  ⎭      (28), (29)
//
// with the consistent tangent ∂G/∂q in place of K where the method says so; λ is the total multiplier, so
// that Φ_qᵀ λⁿ⁻¹ on both sides need not be written.
template <class Real>
Outcome step(March<Real>& s, Real next) {
    const int n = s.n(), m = s.m();
    apply_load(s, next);
    if (const Outcome outcome = factorise_at(s, s.q, s.lambda, next); outcome != Outcome::converged)
        return outcome;
    s.upper = s.applied - s.stored;
    if (s.method.closed) s.lower = -s.Phi;
    back_substitute(s);
    ++s.counts.evaluations;
    s.before = s.q;

    if (s.method.midpoint) {
        // G(z⁺) = G(z) + ∂G(½(z + z⁺)) Δz + O(Δ³): the same residual, the matrix from half a step ahead, now
        // for (Δq, Δλ).
        s.dq = s.x.head(n) / 2;
        advance(s.q, s.dq);
        s.lambda_half = (s.lambda + s.x.tail(m)) / 2;
        s.upper.noalias() -= s.system.M.topRightCorner(n, m) * s.lambda;
        if (const Outcome outcome = factorise_at(s, s.q, s.lambda_half, next); outcome != Outcome::converged)
            return outcome;
        s.q = s.before;
        back_substitute(s);
        s.lambda += s.x.tail(m);
        const Real change = (s.x.head(n) - 2 * s.dq).cwiseProduct(s.system.weight.head(n)).squaredNorm();
        if (disagree(s, change, size_of_solution(s), Real(0))) return Outcome::diverged;
    } else {
        s.lambda = s.x.tail(m);
    }
    s.dq = s.x.head(n);
    if (!s.x.allFinite()) return Outcome::not_finite;
    if (has_diverged(s)) return Outcome::diverged;
    advance(s.q, s.dq);

    for (int k = 0; k < s.method.corrections; ++k) {
        residual_at(s, s.q, s.lambda, next);
        back_substitute(s);
        if (!s.x.allFinite()) return Outcome::not_finite;
        if (disagree(s, size_of_solution(s), s.last.squaredNorm(), Real(0))) return Outcome::diverged;
        s.dq = s.x.head(n);
        advance(s.q, s.dq);
        s.lambda += s.x.tail(m);
    }
    s.a = next;
    store(s);
    return Outcome::converged;
}

// What the step just taken missed, with its own factors: the next step would have shown it, after the last
// one nothing else does.
template <class Real>
Outcome check_last_step(March<Real>& s) {
    residual_at(s, s.q, s.lambda, s.a);
    back_substitute(s);
    return disagree(s, size_of_solution(s), s.last.squaredNorm(), Real(0)) ? Outcome::diverged
                                                                           : Outcome::converged;
}

// Load factor 0. Where nothing is stored and nothing weighs, λ⁻¹ = 0 and q⁰ is the design position. Otherwise
// (25) with the imbalance f_ext - f_elast gives λ⁻¹; Δq ≠ 0 only where the design position is not in
// equilibrium. Methods that follow the true forces settle to round-off.
template <class Real>
Outcome settle(March<Real>& s) {
    external_force<Real>(s.model, s.branch, 0, s.q, s.applied);
    elastic_force<Real>(s.model, s.q, s.stored);
    for (const auto& elastic : s.model.elastics)
        s.element.push_back(
            std::visit([&](const auto& e) { return element_force<Real>(e, s.q); }, elastic.kind));
    const bool settles = s.method.follow == everything;
    const Real enough = 100 * std::numeric_limits<Real>::epsilon() * static_cast<Real>(s.length);
    for (int k = 0; k < (settles ? 20 : 1) && !(s.applied - s.stored).isZero(0); ++k) {
        if (const Outcome outcome = step(s, Real(0)); outcome != Outcome::converged) return outcome;
        s.last.setZero();  // corrections shrink fast: none is a measure of the next
        if (s.dq.cwiseProduct(s.system.weight.head(s.n())).norm() <= enough) break;
    }
    s.swings = 0;
    return Outcome::converged;
}

}  // namespace elastocheck::recursive
