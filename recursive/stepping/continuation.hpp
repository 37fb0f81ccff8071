// Predictor-corrector continuation along a path of equilibria: nodes and accepted steps.
//
// A node is a point z = (q, λ) of the path with its derivative z' = dz/dp, p the parameter (t while
// settling, a on the branch): ∂G z' = the drivers' terms, one more right-hand side for the factors
// of the node. From one node to the next:
//
//   predictor    z⁺ = z + h z' + ½ h² z'', z'' from the last two derivatives
//   corrector    Newton steps, each with fresh factors: their sizes fall quadratically, so the
//                square of the last one over the one before estimates the remaining error. (With
//                the factors of the old node they hardly fall: where stiff bushings rotate beside
//                soft springs, the error of old factors is the angle of rotation times the ratio of
//                the rates.)
//
// Newton's method is not bound to the branch: past a limit point it converges to any other
// equilibrium. So a step is accepted only where the determinant of the matrix keeps its sign and
// the sum of all corrections is less than half of the predictor step.
#pragma once

#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

template <class Real>
struct Node {
    State<Real> q;
    Vector<Real> lambda, dq, dlambda;  // z' = (dq, dlambda) per unit of p
    Real p = 0;
    int orientation = 0;  // sign of the determinant
};

// The parameter that moves, and the tolerances of the corrector.
template <class Real>
struct ContinuationSettings {
    Drive drive = Drive::rate;
    Real length_tolerance = 0, angle_tolerance = 0;  // of the corrections [m], [rad]

    Parameters<Real> at(Real p) const {
        return drive == Drive::start ? Parameters<Real>{p, 0} : Parameters<Real>{1, p};
    }
};

// z' at the node, with the factors in the system.
template <class Real>
void differentiate(SteppingState<Real>& s, const ContinuationSettings<Real>& settings,
                   Node<Real>& node) {
    go_to(s, settings.at(node.p));
    drive_at(s, settings.drive, Real(1), node.q, node.lambda);
    back_substitute(s);
    node.dq = s.x.head(s.n());
    node.dlambda = s.x.tail(s.m());
    node.orientation = s.system.lu.orientation;
}

// Size of the motion dq in units of the tolerances: the largest over all bodies.
template <class Real, class Motion>
Real share(const ContinuationSettings<Real>& settings, const Motion& dq) {
    Real worst = 0;
    for (Eigen::Index b = 0; b < dq.size() / 6; ++b) {
        worst = std::max(worst, dq.template segment<3>(6 * b).norm() / settings.length_tolerance);
        worst =
            std::max(worst, dq.template segment<3>(6 * b + 3).norm() / settings.angle_tolerance);
    }
    return worst;
}

// One Newton correction of (q, lambda) at p; `size` returns it in units of the tolerance.
template <class Real>
Outcome correct(SteppingState<Real>& s, const ContinuationSettings<Real>& settings, State<Real>& q,
                Vector<Real>& lambda, Real p, Real& size) {
    go_to(s, settings.at(p));
    external_force<Real>(s.model, s.branch, s.inputs, q, s.applied);  // for the check of idle modes
    if (const Real held = 1 - s.parameters.t; held != Real(0)) s.applied -= held * s.R_d;
    if (const Outcome outcome = factorise_at(s, q, lambda); outcome != Outcome::converged)
        return outcome;
    residual_at(s, q, lambda);
    back_substitute(s);
    if (!s.x.allFinite()) return Outcome::not_finite;
    if (const Outcome outcome = check_idle_load(s, q, std::sqrt(size_of_solution(s)));
        outcome != Outcome::converged)
        return outcome;
    size = share<Real>(settings, s.x.head(s.n()));
    s.dq = s.x.head(s.n());
    advance(q, s.dq);
    lambda += s.x.tail(s.m());
    return Outcome::converged;
}

// Result of a step.
enum class Verdict {
    accepted,
    unsolved,            // the corrections do not fall, or the remaining error is too large
    another_branch,      // an equilibrium, but far from the predictor
    nearly_singular,     // on this path, but nearly singular in between
    past_singular_point  // on this path, but beyond a point where the matrix is singular
};

template <class Real>
struct Trial {
    Outcome outcome = Outcome::converged;  // of the linear algebra
    Verdict verdict = Verdict::unsolved;
    // remaining error of the corrector, in units of the tolerance
    Real left = std::numeric_limits<Real>::infinity();
};

// Tries a step from `node` to next.p; `curvature` and `lambda_curvature` estimate z''. Fills
// `next`, with its derivative unless the verdict is `unsolved`.
template <class Real>
Trial<Real> try_step(SteppingState<Real>& s, const ContinuationSettings<Real>& settings,
                     const Node<Real>& node, const Vector<Real>& curvature,
                     const Vector<Real>& lambda_curvature, Node<Real>& next) {
    const Real h = next.p - node.p;
    Trial<Real> trial;
    next.q = node.q;
    next.lambda = node.lambda + h * node.dlambda + h * h / 2 * lambda_curvature;
    s.dq = h * node.dq + h * h / 2 * curvature;
    // The linearisation of a rotation is invalid beyond one radian.
    for (int b = 0; b < s.n() / 6; ++b)
        if (!(s.dq.template segment<3>(6 * b + 3).norm() <= Real(guard::largest_turn)))
            return trial;
    const Real forecast = share<Real>(settings, s.dq);
    advance(next.q, s.dq);
    Real before = std::numeric_limits<Real>::infinity(), size = 0, corrected = 0;
    for (int k = 0; k < 6 && trial.left > Real(0.01); ++k) {
        trial.outcome = correct(s, settings, next.q, next.lambda, next.p, size);
        if (trial.outcome != Outcome::converged) return trial;
        if (!(size < before)) break;  // not falling: the step is too long
        // The first correction has no ratio yet. A correction far below the tolerance may be
        // rounding, whose ratio means nothing.
        trial.left = k == 0 || size <= Real(1e-3) ? size : size * (size / before);
        before = size;
        corrected += size;
    }
    if (!(trial.left <= Real(0.01))) return trial;
    differentiate(s, settings, next);
    // The predictor is of second order: corrections of half its step mean that it predicted another
    // branch.
    const bool continues = corrected <= forecast / 2 + 1;
    trial.verdict = !continues                             ? Verdict::another_branch
                    : next.orientation != node.orientation ? Verdict::past_singular_point
                                                           : Verdict::accepted;
    return trial;
}

// Whether redundant joints are inconsistent at the node whose factors are in the system, by the gap
// that remains after corrections with these factors. q and lambda are workspace.
template <class Real>
bool is_inconsistent_at(SteppingState<Real>& s, const Node<Real>& node, State<Real>& q,
                        Vector<Real>& lambda) {
    constexpr int corrections = 3;  // each a thousandth of the one before, or less
    if (!has_redundancy(s)) return false;
    const Counts counts = s.counts;  // a check only: not counted
    q = node.q;
    lambda = node.lambda;
    for (int k = 0; k < corrections; ++k) {
        residual_at(s, q, lambda);
        back_substitute(s);
        s.dq = s.x.head(s.n());
        advance(q, s.dq);
        lambda += s.x.tail(s.m());
    }
    residual_at(s, q, lambda);
    s.counts = counts;
    return is_inconsistent(s, q);
}

// Why the path ends at `node`, judged by the smallest rejected step, of length h.
template <class Real>
Outcome end_reason(const Trial<Real>& trial, const Node<Real>& node, const Vector<Real>& curvature,
                   Real h, Real length) {
    if (trial.outcome == Outcome::not_finite || trial.outcome == Outcome::loaded_idle_mode)
        return trial.outcome;
    // If the drivers' rate is in the range of the singular matrix, z' stays finite and the path
    // continues past a bifurcation point, where another path crosses. If not, z' ~ (p* - p)^-½ and
    // the path turns back at a limit point p*; then z'' (p* - p) = ½ z', and h is about p* - p. A
    // z' at rounding level decides nothing.
    const bool moves = node.dq.norm() * (std::abs(node.p) + std::abs(h)) > Real(1e-9) * length;
    if (moves && curvature.norm() * std::abs(h) > Real(0.02) * node.dq.norm())
        return Outcome::limit_point;
    if (trial.outcome == Outcome::singular || trial.verdict == Verdict::nearly_singular)
        return Outcome::singular;
    if (trial.verdict == Verdict::past_singular_point) return Outcome::bifurcation_point;
    return Outcome::branch_lost;
}

// Instantiated in stepping/sweep_double.cpp.
extern template void differentiate<double>(SteppingState<double>&,
                                           const ContinuationSettings<double>&, Node<double>&);
extern template Outcome correct<double>(SteppingState<double>&, const ContinuationSettings<double>&,
                                        State<double>&, Vector<double>&, double, double&);
extern template Trial<double> try_step<double>(SteppingState<double>&,
                                               const ContinuationSettings<double>&,
                                               const Node<double>&, const Vector<double>&,
                                               const Vector<double>&, Node<double>&);
extern template bool is_inconsistent_at<double>(SteppingState<double>&, const Node<double>&,
                                                State<double>&, Vector<double>&);

}  // namespace elastocheck::recursive
