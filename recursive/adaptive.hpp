// Step size from an error estimate, and the branch between the steps.
//
// A node is a point z = (q, λ) of the branch with its derivative z' = dz/da: at a node ∂G z' = ∂f_ext/∂a, one
// more right-hand side for factors that are there anyway. From one node to the next:
//
//   forecast    z⁺ = z + h z' + ½ h² z'', z'' from the last two derivatives
//   corrections Newton steps, each with its own factors: their sizes fall quadratically, so the last one
//               squared over the one before is what is left. (With the factors of the old node they hardly
//               fall at all: where stiff bushings turn beside soft springs, the error of old factors is their
//               angle times the ratio of the rates.)
//   between     the cubic through (z, z') and (z⁺, z⁺'). Its error is largest in the middle: one correction
//               there is it.
//
// A step is accepted when what is left and the middle are within the tolerance; the next size follows from
// the middle, which is of order 4.
#pragma once

#include <algorithm>

#include "recursive/steps.hpp"

namespace elastocheck::recursive {

template <class Real>
struct Node {
    State<Real> q;
    Vector<Real> lambda, dq, dlambda;  // z' = (dq, dlambda) per unit of the load factor
    Real a = 0;
};

// z' at the node, with the factors now in the system.
template <class Real>
void differentiate(March<Real>& s, Node<Real>& node) {
    s.upper.setZero();
    add_loads<Real>(s.branch.loads, Real(1), node.q, s.upper);
    s.lower.setZero();
    back_substitute(s);
    node.dq = s.x.head(s.n());
    node.dlambda = s.x.tail(s.m());
}

// The cubic between two nodes at the share t of the way, rotations as vectors π from the first node:
// π(0) = 0, π'(0) = ω, π(h) = log(A⁺Aᵀ), π'(h) = J(π)⁻¹ ω⁺.
template <class Real>
void between(const Node<Real>& from, const Node<Real>& to, Real t, State<Real>& q, Vector<Real>& lambda) {
    const Real h = to.a - from.a;
    const Real h01 = t * t * (3 - 2 * t), h10 = t * (1 - t) * (1 - t) * h, h11 = t * t * (t - 1) * h;
    lambda = from.lambda + h01 * (to.lambda - from.lambda) + h10 * from.dlambda + h11 * to.dlambda;
    for (BodyId b = 0; b < from.q.bodies(); ++b) {
        const auto d0 = from.dq.template segment<6>(6 * b), d1 = to.dq.template segment<6>(6 * b);
        const Matrix3<Real> turned = to.q[b].A * from.q[b].A.transpose();
        const Vector3<Real> pi = logarithm<Real>(turned);
        const Vector3<Real> pi1 = inverse_left_jacobian<Real>(pi) * d1.template tail<3>();
        q[b].r = from.q[b].r + h01 * (to.q[b].r - from.q[b].r) + h10 * d0.template head<3>() +
                 h11 * d1.template head<3>();
        const Vector3<Real> at = h01 * pi + h10 * d0.template tail<3>() + h11 * pi1;
        q[b].p = (exponential<Real>(at) * from.q[b].p).normalized();
        q[b].A = q[b].p.toRotationMatrix();
    }
}

// Fills `path.points` at their equal load increments up to `to`; `reached` counts them.
template <class Real>
Outcome adapt(March<Real>& s, double length_tolerance, double angle_tolerance, double to,
              EquilibriumPath& path, std::size_t& reached) {
    const int n = s.n();
    const Real end = static_cast<Real>(to);
    const auto share = [&]() -> Real {  // of the tolerance that the correction in s.x takes
        Real worst = 0;
        for (int b = 0; b < n / 6; ++b) {
            worst =
                std::max(worst, s.x.template segment<3>(6 * b).norm() / static_cast<Real>(length_tolerance));
            worst = std::max(worst,
                             s.x.template segment<3>(6 * b + 3).norm() / static_cast<Real>(angle_tolerance));
        }
        return worst;
    };
    const std::size_t last = path.points.size() - 1;
    const auto load = [&](std::size_t k) { return to * static_cast<double>(k) / static_cast<double>(last); };

    // One Newton correction of (q, lambda) at the load factor a; its share of the tolerance goes to `size`.
    const auto correct = [&](State<Real>& q, Vector<Real>& lambda, Real a, Real& size) -> Outcome {
        external_force<Real>(s.model, s.branch, end, q, s.applied);  // what idle modes are checked against
        if (const Outcome outcome = factorise_at(s, q, lambda, a); outcome != Outcome::converged)
            return outcome;
        residual_at(s, q, lambda, a);
        back_substitute(s);
        if (!s.x.allFinite()) return Outcome::not_finite;
        size = share();
        s.dq = s.x.head(n);
        advance(q, s.dq);
        lambda += s.x.tail(s.m());
        return Outcome::converged;
    };

    Node<Real> node{s.q, s.lambda, {}, {}, 0}, next = node;
    Vector<Real> lambda = s.lambda, curvature = Vector<Real>::Zero(n),
                 lambda_curvature = Vector<Real>::Zero(s.m());
    State<Real> q = s.q;
    Real size = 0;
    if (const Outcome outcome = correct(node.q, node.lambda, Real(0), size); outcome != Outcome::converged)
        return outcome;
    differentiate(s, node);
    record<Real>(s.model, node.q, node.q, node.lambda, 0, path.points[reached++]);

    Real h = end / 8;
    while (reached <= last) {
        if (!(std::abs(h) > std::abs(end) * Real(1e-7))) return Outcome::branch_lost;
        next.a = std::abs(end - node.a) < std::abs(h) * Real(1.1) ? end : node.a + h;
        const Real step = next.a - node.a;

        next.q = node.q;
        next.lambda = node.lambda + step * node.dlambda + step * step / 2 * lambda_curvature;
        s.dq = step * node.dq + step * step / 2 * curvature;
        advance(next.q, s.dq);
        Real left = std::numeric_limits<Real>::infinity(), before = left;
        Outcome outcome = Outcome::converged;
        for (int k = 0; k < 6 && left > Real(0.01) && outcome == Outcome::converged; ++k) {
            outcome = correct(next.q, next.lambda, next.a, size);
            if (outcome != Outcome::converged || !(size < before))
                break;  // not falling: the step is too long
            // The first correction has no ratio yet; one far below the tolerance may be rounding, whose ratio
            // says nothing.
            left = k == 0 || size <= Real(1e-3) ? size : size * (size / before);
            before = size;
        }
        Real error = left;
        if (error <= Real(0.01)) {
            differentiate(s, next);
            between(node, next, Real(0.5), q, lambda);
            outcome = correct(q, lambda, (node.a + next.a) / 2, size);
            error = std::max(error, size);
        }
        if (outcome == Outcome::converged && error <= 1) {
            for (; reached <= last; ++reached) {
                const double at = load(reached);
                const Real t = (static_cast<Real>(at) - node.a) / step;
                if (t > 1 && next.a != end) break;
                between(node, next, std::min(t, Real(1)), q, lambda);
                record<Real>(s.model, q, q, lambda, at, path.points[reached]);
            }
            curvature = (next.dq - node.dq) / step;
            lambda_curvature = (next.dlambda - node.dlambda) / step;
            std::swap(node, next);
            s.a = node.a;
        } else if (outcome != Outcome::converged && std::abs(h) <= std::abs(end) * Real(1e-3)) {
            return outcome;
        }
        using std::pow;
        const Real change =
            std::isfinite(error) ? Real(0.85) * pow(std::max(error, Real(1e-8)), Real(-0.25)) : Real(0.3);
        h = step * std::clamp(change, Real(0.1), Real(4));
    }
    return Outcome::converged;
}

}  // namespace elastocheck::recursive
