// Step-size control by an error estimate, and dense output between the steps.
//
//   a step    continuation.hpp
//   between   the cubic through (z, z') and (z⁺, z⁺'). Its error is largest at the midpoint, where
//             the size of one Newton correction estimates it.
//
// A step is accepted when continuation.hpp accepts it and the midpoint error is within the tolerance. The
// next step size follows from the midpoint error, which is of order 4.
//
// An equilibrium that becomes unstable and stable again between two nodes leaves the sign of the
// determinant unchanged. It shows as a dip of the determinant: where the determinant at the
// midpoint has another sign, or is less than half of that at either end, the step is halved until
// the dip disappears or the point is located. Two modes that become unstable at once also leave the
// sign unchanged; they show in the least stiffness at every node (stiffness.hpp). A branch that
// begins unstable is not followed (inertia.hpp). After `most_steps` steps the outcome is
// iteration_limit.
//
// No step crosses a knot of a force curve: the step ends on the knot (event_location.hpp) and the next one
// begins with the derivative on the other side. Where the determinant changes its sign with the
// piece, the path turns back at the knot.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "recursive/stepping/event_location.hpp"
#include "recursive/stepping/recording.hpp"
#include "recursive/stepping/settle.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive {

// Maximum number of steps, accepted or rejected: near a singular point each may be a ten-millionth
// of the branch.
inline constexpr int most_steps = 20'000;

// Cubic Hermite interpolation at the fraction t between two nodes, rotations as vectors π:
// π(0) = 0, π'(0) = ω, π(h) = log(A⁺Aᵀ), π'(h) = J(π)⁻¹ ω⁺.
template <class Real>
void between(const Node<Real>& from, const Node<Real>& to, Real t, State<Real>& q,
             Vector<Real>& lambda) {
    const Real h = to.p - from.p;
    const Real h01 = t * t * (3 - 2 * t), h10 = t * (1 - t) * (1 - t) * h,
               h11 = t * t * (t - 1) * h;
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

// Change of the reactions by the correction in s.x, over the allowed change. Allowed are the larger
// reactions of the two nodes `one` and `other` times length_tolerance / L, and the rounding of all
// forces at q and of stiffness times position, since the reactions may be zero. The correction of
// the motion does not detect this error: in a driven mechanism the drivers prescribe the whole
// motion, and all forces are in λ.
template <class Real>
Real share_of_reactions(SteppingState<Real>& s, const Going<Real>& going, const State<Real>& q,
                        const Vector<Real>& one, const Vector<Real>& other) {
    const auto force = [&](const auto& lambda) {
        constraint_force(s.system.M, lambda, s.force);
        return size_of_force(s, s.force);
    };
    const Real largest = std::max(force(one), force(other)), change = force(s.x.tail(s.m()));
    elastic_force<Real>(s.model, s.inputs, q, s.force);
    const Real acts = std::max({largest, size_of_force(s, s.applied), size_of_force(s, s.force)});
    constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
    const Real allowed =
        largest * going.length_tolerance / static_cast<Real>(s.length) +
        Real(guard::rounding) * epsilon * acts +
        10 * epsilon * (static_cast<Real>(s.length) + reach(q)) * stiffest(s.system.M);
    return allowed > 0 ? change / allowed : Real(0);
}

// Records the points at equal increments of the parameter up to `to`. Pre: the state has just
// settled.
template <class Real>
Outcome adapt(SteppingState<Real>& s, const Adaptive& method, double to, Recording& recording) {
    const Real end = static_cast<Real>(to);
    const Going<Real> going{Drive::rate, static_cast<Real>(method.length_tolerance),
                            static_cast<Real>(method.angle_tolerance)};
    const std::size_t last = recording.points - 1, &reached = recording.reached;
    const auto parameter = [&](std::size_t k) {
        return to * static_cast<double>(k) / static_cast<double>(last);
    };
    const auto keep = [&](const State<Real>& q, const Vector<Real>& lambda, double a) {
        go_to(s, {1, static_cast<Real>(a)});
        recording.keep(s.model, s.inputs, q, q, lambda, a);
    };

    Node<Real> node{s.q, s.lambda, {}, {}, 0, 0}, next = node;
    Vector<Real> lambda = s.lambda, curvature = Vector<Real>::Zero(s.n()),
                 lambda_curvature = Vector<Real>::Zero(s.m());
    State<Real> q = s.q;
    Real size = 0;
    // The factors are those of the last correction of settling.
    differentiate(s, going, node);
    const int orientation = node.orientation;
    // A bend of the path may be sharper than a short step: an imperfect column turns aside within 1e-9
    // of its load. The reason why the branch ends is judged at the first short step that is refused; a
    // step refused only for its interpolation error gives no reason.
    constexpr Real short_step = Real(1e-7),  // of the branch
        shortest_step = std::max(Real(1e-12), std::numeric_limits<Real>::epsilon());
    bool refused = false;  // a short step at refused_at, past which the path has not gone on
    Real refused_at = 0;
    Outcome ended = Outcome::branch_lost;  // why
    Real h = end / 8;
    int changes = 0;  // of pieces since the last accepted step
    // Factorisation and derivative at the node on the present pieces.
    const auto begin_anew = [&]() -> Outcome {
        go_to(s, going.place(node.p));
        external_force<Real>(s.model, s.branch, s.inputs, node.q, s.applied);
        if (const Outcome outcome = factorise_at(s, node.q, node.lambda);
            outcome != Outcome::converged)
            return outcome;
        differentiate(s, going, node);
        curvature.setZero();
        lambda_curvature.setZero();
        return node.orientation == orientation ? Outcome::converged : Outcome::limit_point;
    };
    if (!s.curves.empty()) {
        take_pieces(s, going, node, h * Real(1e-3), q);
        if (const Outcome outcome = begin_anew(); outcome != Outcome::converged) return outcome;
    }
    Real log_here = log_determinant(s.system.lu);
    SubspaceBasis<Real> softest;
    const auto unstable = [&] {
        const LeastStiffness least = least_stiffness(s, softest);
        return (least.of_energy && least.value < 0) || pushed_over(s, next.q, next.lambda) < 0;
    };
    if (const Outcome outcome = judge_start(s); outcome != Outcome::converged) return outcome;
    keep(node.q, node.lambda, 0);

    for (int steps = 0; reached <= last; ++steps) {
        if (steps == most_steps) return Outcome::iteration_limit;
        next.p = std::abs(end - node.p) < std::abs(h) * Real(1.1) ? end : node.p + h;
        KnotCrossing<Real> met;
        Trial<Real> trial =
            step_to_knot(s, going, node, curvature, lambda_curvature, next, q, met,
                         [&](const Node<Real>& one, const Node<Real>& other, Real t,
                             State<Real>& at) { between(one, other, t, at, lambda); });
        const Real step = next.p - node.p;
        if (step == Real(0)) {  // the node lies on a knot
            piece_of(s, *met.curve) += met.side;
            if (++changes > 2 * static_cast<int>(s.curves.size())) return Outcome::limit_point;
            if (const Outcome outcome = begin_anew(); outcome != Outcome::converged) return outcome;
            log_here = log_determinant(s.system.lu);
            continue;
        }
        Real error = std::numeric_limits<Real>::infinity();
        if (trial.verdict == Verdict::believed) {
            const Real log_next = log_determinant(s.system.lu);
            if (unstable()) trial.verdict = Verdict::turned_over;
            if (contradict_at(s, next, q, lambda)) return Outcome::inconsistent_constraints;
            between(node, next, Real(0.5), q, lambda);
            trial.outcome = correct(s, going, q, lambda, node.p + step / 2, size);
            if (trial.outcome == Outcome::converged) {
                error = std::max(
                    {trial.left, size, share_of_reactions(s, going, q, node.lambda, next.lambda)});
                const bool turned = s.system.lu.orientation != node.orientation;
                const bool dips = log_determinant(s.system.lu) < std::min(log_here, log_next) - 1;
                if (trial.verdict == Verdict::believed && (turned || dips))
                    trial.verdict = turned ? Verdict::turned_over : Verdict::dips;
            }
            if (trial.verdict == Verdict::believed && error <= 1) {
                for (; reached <= last;) {
                    const double at = parameter(reached);
                    const Real t = (static_cast<Real>(at) - node.p) / step;
                    if (t > 1 && next.p != end) break;
                    between(node, next, std::min(t, Real(1)), q, lambda);
                    keep(q, lambda, at);
                }
                curvature = (next.dq - node.dq) / step;
                lambda_curvature = (next.dlambda - node.dlambda) / step;
                std::swap(node, next);
                log_here = log_next;
                s.a = node.p;
                changes = 0;
                if (std::abs(node.p - refused_at) > std::abs(end) * short_step) refused = false;
                if (met.curve && reached <= last) {
                    take_pieces(s, going, node, h * Real(1e-3), q);
                    if (const Outcome outcome = begin_anew(); outcome != Outcome::converged)
                        return outcome;
                    log_here = log_determinant(s.system.lu);
                    continue;  // with the step size that the knot shortened
                }
            }
        }
        using std::pow;
        const bool judged = trial.verdict == Verdict::believed && std::isfinite(error);
        const Real change =
            judged ? Real(0.85) * pow(std::max(error, Real(1e-8)), Real(-0.25)) : Real(0.3);
        h = step * std::clamp(change, Real(0.1), Real(4));
        if (!(std::abs(h) > std::abs(end) * short_step) && reached <= last) {
            if (!refused) {
                refused_at = node.p;
                ended = Outcome::branch_lost;
            }
            refused = true;
            if (!judged && ended == Outcome::branch_lost)
                ended = why_it_ends(trial, node, curvature, step, static_cast<Real>(s.length));
            if (!(std::abs(h) > std::abs(end) * shortest_step)) return ended;
        }
    }
    return Outcome::converged;
}

}  // namespace elastocheck::recursive
