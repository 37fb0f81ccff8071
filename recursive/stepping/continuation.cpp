#include "recursive/stepping/continuation.hpp"

#include "recursive/stepping/step_check.hpp"

namespace elastocheck::recursive {

Outcome correct(SteppingState& s, const ContinuationSettings& settings, State<double>& q,
                Vector<double>& lambda, double p, double& size) {
    go_to(s, settings.at(p));
    external_force<double>(s.model, s.branch, s.inputs, q,
                           s.work.applied);  // for the check of idle modes
    if (const double held = 1 - s.parameters.t; held != 0) s.work.applied -= held * s.start.R_d;
    if (const Outcome outcome = factorise_at(s, q, lambda); outcome != Outcome::converged)
        return outcome;
    residual_at(s, q, lambda);
    back_substitute(s);
    if (!s.work.x.allFinite()) return Outcome::not_finite;
    if (const Outcome outcome = check_idle_load(s, q, std::sqrt(size_of_solution(s)));
        outcome != Outcome::converged)
        return outcome;
    size = size_in_tolerances(settings, s.work.x.head(s.n()));
    s.step.dq = s.work.x.head(s.n());
    advance(q, s.step.dq);
    lambda += s.work.x.tail(s.m());
    return Outcome::converged;
}

Trial try_step(SteppingState& s, const ContinuationSettings& settings, const Node& node,
               const Vector<double>& curvature, const Vector<double>& lambda_curvature,
               Node& next) {
    const double h = next.p - node.p;
    Trial trial;
    next.q = node.q;
    next.lambda = node.lambda + h * node.dlambda + h * h / 2 * lambda_curvature;
    s.step.dq = h * node.dq + h * h / 2 * curvature;
    // The linearisation of a rotation is invalid beyond one radian.
    for (int b = 0; b < s.n() / 6; ++b)
        if (!(s.step.dq.segment<3>(6 * b + 3).norm() <= guard::largest_turn)) return trial;
    const double forecast = size_in_tolerances(settings, s.step.dq);
    advance(next.q, s.step.dq);
    double before = std::numeric_limits<double>::infinity(), size = 0, corrected = 0;
    for (int k = 0; k < 6 && trial.error > 0.01; ++k) {
        trial.outcome = correct(s, settings, next.q, next.lambda, next.p, size);
        if (trial.outcome != Outcome::converged) return trial;
        if (!(size < before)) break;  // not falling: the step is too long
        // The first correction has no ratio yet. A correction far below the tolerance may be
        // rounding, whose ratio means nothing.
        trial.error = k == 0 || size <= 1e-3 ? size : size * (size / before);
        before = size;
        corrected += size;
    }
    if (!(trial.error <= 0.01)) return trial;
    differentiate(s, settings, next);
    // The predictor is of second order: corrections of half its step mean that it
    // predicted another branch.
    const bool continues = corrected <= forecast / 2 + 1;
    trial.verdict = !continues                             ? Verdict::another_branch
                    : next.orientation != node.orientation ? Verdict::past_singular_point
                                                           : Verdict::accepted;
    return trial;
}

bool is_inconsistent_at(SteppingState& s, const Node& node, State<double>& q,
                        Vector<double>& lambda) {
    constexpr int corrections = 3;  // each a thousandth of the one before, or less
    if (!has_redundancy(s)) return false;
    const Counts counts = s.counts;  // a check only: not counted
    q = node.q;
    lambda = node.lambda;
    for (int k = 0; k < corrections; ++k) {
        residual_at(s, q, lambda);
        back_substitute(s);
        s.step.dq = s.work.x.head(s.n());
        advance(q, s.step.dq);
        lambda += s.work.x.tail(s.m());
    }
    residual_at(s, q, lambda);
    s.counts = counts;
    return is_inconsistent(s, q);
}

Outcome end_reason(const Trial& trial, const Node& node, const Vector<double>& curvature, double h,
                   double length) {
    if (trial.outcome == Outcome::not_finite || trial.outcome == Outcome::loaded_idle_mode)
        return trial.outcome;
    // If the drivers' rate is in the range of the singular matrix, z' stays finite and the path
    // continues past a bifurcation point, where another path crosses. If not, z' ~ (p* - p)^-½ and
    // the path turns back at a limit point p*; then z'' (p* - p) = ½ z', and h is about p* - p. A
    // z' at rounding level decides nothing.
    const bool moves = node.dq.norm() * (std::abs(node.p) + std::abs(h)) > 1e-9 * length;
    if (moves && curvature.norm() * std::abs(h) > 0.02 * node.dq.norm())
        return Outcome::limit_point;
    if (trial.outcome == Outcome::singular || trial.verdict == Verdict::nearly_singular)
        return Outcome::singular;
    if (trial.verdict == Verdict::past_singular_point) return Outcome::bifurcation_point;
    return Outcome::branch_lost;
}

bool is_straight(const SteppingState& s, const ContinuationSettings& settings, const Node& from,
                 const Node& to) {
    Vector<double> chord(s.n());
    for (BodyId b = 0; b < from.q.bodies(); ++b) {
        const Matrix3<double> turned = to.q[b].A * from.q[b].A.transpose();
        chord.segment<3>(6 * b) = to.q[b].r - from.q[b].r;
        chord.segment<3>(6 * b + 3) = logarithm<double>(turned);
    }
    const Vector<double> mean = (to.p - from.p) / 2 * (from.dq + to.dq);
    // allowed distance of the chord from the mean tangent, as a fraction
    constexpr double straight = 0.25;
    return size_in_tolerances(settings, chord - mean) <=
               straight * size_in_tolerances(settings, chord) + 1 &&
           !any_reversed(s.model, from.q, to.q);
}

}  // namespace elastocheck::recursive
