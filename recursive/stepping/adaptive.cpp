#include "recursive/stepping/adaptive.hpp"

#include <algorithm>
#include <limits>

#include "recursive/stepping/event_location.hpp"
#include "recursive/stepping/settle.hpp"
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive {
namespace {

// Change of the reactions by the correction in s.x, over the allowed change. Allowed are the larger
// reactions of the two nodes `one` and `other` times length_tolerance / L, and the rounding of all
// forces at q and of stiffness times position, since the reactions may be zero. The correction of
// the motion does not detect this error: in a driven mechanism the drivers prescribe the whole
// motion, and all forces are in λ.
double share_of_reactions(SteppingState& s, const ContinuationSettings& settings,
                          const State<double>& q, const Vector<double>& one,
                          const Vector<double>& other) {
    const auto force = [&](const auto& lambda) {
        constraint_force(s.system.M, lambda, s.force);
        return size_of_force(s, s.force);
    };
    const double largest = std::max(force(one), force(other)), change = force(s.x.tail(s.m()));
    elastic_force<double>(s.model, s.inputs, q, s.force);
    const double acts = std::max({largest, size_of_force(s, s.applied), size_of_force(s, s.force)});
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double allowed = largest * settings.length_tolerance / s.length +
                           guard::rounding * epsilon * acts +
                           10 * epsilon * (s.length + reach(q)) * stiffest(s.system.M);
    return allowed > 0 ? change / allowed : 0;
}

// Records the points at equal increments of the parameter up to `to`. Pre: the state
// has just settled.
Outcome adapt(SteppingState& s, const Adaptive& method, double to, Recording& recording) {
    const ContinuationSettings settings{Drive::rate, method.length_tolerance,
                                        method.angle_tolerance};
    const std::size_t last = recording.points - 1, &reached = recording.reached;
    const auto parameter = [&](std::size_t k) {
        return to * static_cast<double>(k) / static_cast<double>(last);
    };
    const auto keep = [&](const State<double>& q, const Vector<double>& lambda, double a) {
        go_to(s, {1, a});
        recording.keep(s.model, s.inputs, q, q, lambda, a);
    };

    Node node{s.q, s.lambda, {}, {}, 0, 0}, next = node;
    Vector<double> lambda = s.lambda, curvature = Vector<double>::Zero(s.n()),
                   lambda_curvature = Vector<double>::Zero(s.m());
    State<double> q = s.q;
    double size = 0;
    // The factors are those of the last correction of settling.
    differentiate(s, settings, node);
    const int orientation = node.orientation;
    // A bend of the path may be sharper than a short step: an imperfect column turns aside within
    // 1e-9 of its load. The reason why the branch ends is judged at the first short step that is
    // refused; a later one overrides it if the first was refused only for its interpolation error.
    constexpr double short_step = 1e-7,  // of the branch
        shortest_step = 1e-12;
    bool refused = false;  // a short step at refused_at, past which the path has not gone on
    double refused_at = 0;
    Outcome ended = Outcome::branch_lost;  // why
    bool by_error = false;                 // refused only for its interpolation error
    double h = to / 8;
    int changes = 0;  // of pieces since the last accepted step
    // Factorisation and derivative at the node on the present pieces.
    const auto begin_anew = [&]() -> Outcome {
        go_to(s, settings.at(node.p));
        external_force<double>(s.model, s.branch, s.inputs, node.q, s.applied);
        if (const Outcome outcome = factorise_at(s, node.q, node.lambda);
            outcome != Outcome::converged)
            return outcome;
        differentiate(s, settings, node);
        curvature.setZero();
        lambda_curvature.setZero();
        return node.orientation == orientation ? Outcome::converged : Outcome::limit_point;
    };
    if (!s.curves.empty()) {
        take_pieces(s, settings, node, h * 1e-3, q);
        if (const Outcome outcome = begin_anew(); outcome != Outcome::converged) return outcome;
    }
    double log_here = log_determinant(s.system);
    Matrix<double> softest;
    const auto unstable = [&] {
        const LeastStiffness least = min_stiffness(s, softest);
        return (least.of_energy && least.value < 0) ||
               negative_idle_stiffness(s, next.q, next.lambda) < 0;
    };
    if (const Outcome outcome = check_start_stability(s, start_stability(s));
        outcome != Outcome::converged)
        return outcome;
    keep(node.q, node.lambda, 0);

    for (int steps = 0; reached <= last; ++steps) {
        if (steps == max_steps) return Outcome::iteration_limit;
        if (node.p == s.end && s.end != to) return Outcome::inconsistent_constraints;
        next.p = std::abs(s.end - node.p) < std::abs(h) * 1.1 ? s.end : node.p + h;
        KnotCrossing met;
        Trial trial =
            step_to_knot(s, settings, node, curvature, lambda_curvature, next, q, lambda, met);
        const double step = next.p - node.p;
        if (step == 0) {  // the node lies on a knot
            piece_of(s, *met.curve) += met.side;
            if (++changes > 2 * static_cast<int>(s.curves.size())) return Outcome::limit_point;
            if (const Outcome outcome = begin_anew(); outcome != Outcome::converged) return outcome;
            log_here = log_determinant(s.system);
            continue;
        }
        double error = std::numeric_limits<double>::infinity();
        if (trial.verdict == Verdict::accepted) {
            const double log_next = log_determinant(s.system);
            if (unstable()) trial.verdict = Verdict::past_singular_point;
            if (is_inconsistent_at(s, next, q, lambda)) return Outcome::inconsistent_constraints;
            between(node, next, 0.5, q, lambda);
            trial.outcome = correct(s, settings, q, lambda, node.p + step / 2, size);
            if (trial.outcome == Outcome::converged) {
                error = std::max({trial.left, size,
                                  share_of_reactions(s, settings, q, node.lambda, next.lambda)});
                const bool turned = s.system.lu.orientation != node.orientation;
                const bool dips = determinant_dips(log_here, log_determinant(s.system), log_next);
                if (trial.verdict == Verdict::accepted && (turned || dips))
                    trial.verdict =
                        turned ? Verdict::past_singular_point : Verdict::nearly_singular;
            }
            if (trial.verdict == Verdict::accepted && error <= 1) {
                for (; reached <= last;) {
                    const double at = parameter(reached);
                    const double t = (at - node.p) / step;
                    if (t > 1 && next.p != to) break;
                    between(node, next, std::min(t, 1.0), q, lambda);
                    keep(q, lambda, at);
                }
                curvature = (next.dq - node.dq) / step;
                lambda_curvature = (next.dlambda - node.dlambda) / step;
                std::swap(node, next);
                log_here = log_next;
                s.a = node.p;
                changes = 0;
                if (std::abs(node.p - refused_at) > std::abs(to) * short_step) refused = false;
                if (met.curve && reached <= last) {
                    take_pieces(s, settings, node, h * 1e-3, q);
                    if (const Outcome outcome = begin_anew(); outcome != Outcome::converged)
                        return outcome;
                    log_here = log_determinant(s.system);
                    continue;  // with the step size that the knot shortened
                }
            }
        }
        const bool judged = trial.verdict == Verdict::accepted && std::isfinite(error);
        const double change = judged ? 0.85 * std::pow(std::max(error, 1e-8), -0.25) : 0.3;
        h = step * std::clamp(change, 0.1, 4.0);
        if (!(std::abs(h) > std::abs(to) * short_step) && reached <= last) {
            const Outcome reason = end_reason(trial, node, curvature, step, s.length);
            if (!refused) refused_at = node.p;
            const bool better = ended == Outcome::branch_lost || (by_error && !judged);
            if (!refused || (better && reason != Outcome::branch_lost)) {
                ended = reason;
                by_error = judged;
            }
            refused = true;
            if (!(std::abs(h) > std::abs(to) * shortest_step)) return ended;
        }
    }
    return Outcome::converged;
}

}  // namespace

EquilibriumPath sweep_adaptive(const Model& model, const Branch& branch, const Options& options,
                               const Analysis& analysis, const Visit& visit, Stop& stop) {
    const int steps = options.steps > 0 ? options.steps : branch.steps;
    SteppingState s(model, branch, analysis);
    EquilibriumPath path;
    Recording recording(model, (options.record > 0 ? options.record : steps) + 1, path, visit);
    path.outcome = settle(s);
    const bool settled = path.outcome == Outcome::converged;
    if (settled)
        path.outcome = adapt(s, std::get<Adaptive>(options.method.kind), branch.to, recording);
    recording.finish();
    path.counts = s.counts;
    stop = {settled ? s.a : std::numeric_limits<double>::quiet_NaN(),
            path.outcome == Outcome::singular ? s.unstable_start : std::string()};
    return path;
}

}  // namespace elastocheck::recursive
