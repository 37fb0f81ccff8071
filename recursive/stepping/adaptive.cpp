#include "recursive/stepping/adaptive.hpp"

#include <algorithm>
#include <limits>

#include "recursive/stepping/event_location.hpp"
#include "recursive/stepping/settle.hpp"
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive {
namespace {

// Change of the reactions by the correction in s.work.x, over the allowed change: the larger
// reactions of the two nodes times length_tolerance / L, and, since the reactions may be zero, the
// rounding of all forces at q and of stiffness times position. The correction of the motion does
// not detect this error: in a driven mechanism the drivers prescribe the whole motion, and all
// forces are in λ.
double share_of_reactions(SteppingState& s, const ContinuationSettings& settings,
                          const State<double>& q, const Vector<double>& lambda_from,
                          const Vector<double>& lambda_to) {
    const auto force = [&](const auto& lambda) {
        constraint_force(s.system.M, lambda, s.work.force);
        return size_of_force(s, s.work.force);
    };
    const double largest = std::max(force(lambda_from), force(lambda_to)),
                 change = force(s.work.x.tail(s.m()));
    elastic_force<double>(s.model, s.inputs, q, s.work.force);
    const double acts =
        std::max({largest, size_of_force(s, s.work.applied), size_of_force(s, s.work.force)});
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double allowed = largest * settings.length_tolerance / s.setup.length +
                           guard::rounding * epsilon * acts +
                           10 * epsilon * (s.setup.length + reach(q)) * stiffest(s.system.M);
    return allowed > 0 ? change / allowed : 0;
}

// Steps as fractions of the branch: a short one, whose refusal shows why the branch ends, and the
// shortest that is tried. The path may bend more sharply than a short step: an imperfect column
// buckles within 1e-9 of its load.
constexpr double short_step = 1e-7, shortest_step = 1e-12;

// A sweep with step-size control, from the state, which has just settled.
struct Sweep {
    SteppingState& s;
    ContinuationSettings settings;
    double to;
    Recording& recording;
    Stride stride;
    int orientation = 0;  // sign of the determinant at the start
    double h;             // of the next step
    double log_here = 0;  // log₂ |determinant| at the node
    Matrix<double> softest = {};
    int changes = 0;        // of pieces since the last accepted step
    bool refused = false;   // a short step at refused_at; reset once the path is past it
    double refused_at = 0;  // parameter
    Outcome ended = Outcome::branch_lost;  // the reason, if the branch ends there
    bool by_error = false;                 // refused only for its interpolation error

    bool is_done() const { return recording.reached >= recording.points; }
};

void keep(Sweep& w, const State<double>& q, const Vector<double>& lambda, double a) {
    go_to(w.s, {1, a});
    w.recording.keep(w.s.model, w.s.inputs, q, q, lambda, a);
}

// Factorisation and derivative at the node on the present pieces.
Outcome begin_anew(Sweep& w) {
    Node& node = w.stride.node;
    go_to(w.s, w.settings.at(node.p));
    external_force<double>(w.s.model, w.s.branch, w.s.inputs, node.q, w.s.work.applied);
    if (const Outcome outcome = factorise_at(w.s, node.q, node.lambda);
        outcome != Outcome::converged)
        return outcome;
    differentiate(w.s, w.settings, node);
    w.stride.curvature.setZero();
    w.stride.lambda_curvature.setZero();
    w.log_here = log_determinant(w.s.system);
    return node.orientation == w.orientation ? Outcome::converged : Outcome::limit_point;
}

bool is_unstable(Sweep& w) {
    const LeastStiffness least = min_stiffness(w.s, w.softest);
    return (least.of_energy && least.value < 0) ||
           negative_idle_stiffness(w.s, w.stride.next.q, w.stride.next.lambda) < 0;
}

// Judges the middle of a step that Newton's method accepts, and its stability: the error of the
// interpolation, in units of the tolerance; infinite where the middle is not solved.
Outcome judge_step(Sweep& w, Trial& trial, double log_next, double& error) {
    auto& [node, next, curvature, lambda_curvature, q, lambda] = w.stride;
    if (is_unstable(w)) trial.verdict = Verdict::past_singular_point;
    if (is_inconsistent_at(w.s, next, q, lambda)) return Outcome::inconsistent_constraints;
    interpolate(node, next, 0.5, q, lambda);
    double size = 0;
    trial.outcome = correct(w.s, w.settings, q, lambda, node.p + (next.p - node.p) / 2, size);
    if (trial.outcome != Outcome::converged) return Outcome::converged;
    error = std::max(
        {trial.error, size, share_of_reactions(w.s, w.settings, q, node.lambda, next.lambda)});
    const bool turned = w.s.system.lu.orientation != node.orientation;
    const bool dips = determinant_dips(w.log_here, log_determinant(w.s.system), log_next);
    if (trial.verdict == Verdict::accepted && (turned || dips))
        trial.verdict = turned ? Verdict::past_singular_point : Verdict::nearly_singular;
    return Outcome::converged;
}

// Records the points of the step and moves the node to its end.
void take_step(Sweep& w, double log_next) {
    auto& [node, next, curvature, lambda_curvature, q, lambda] = w.stride;
    const double step = next.p - node.p, last = static_cast<double>(w.recording.points - 1);
    while (!w.is_done()) {
        const double at = w.to * static_cast<double>(w.recording.reached) / last;
        const double t = (at - node.p) / step;
        if (t > 1 && next.p != w.to) break;
        interpolate(node, next, std::min(t, 1.0), q, lambda);
        keep(w, q, lambda, at);
    }
    curvature = (next.dq - node.dq) / step;
    lambda_curvature = (next.dlambda - node.dlambda) / step;
    std::swap(node, next);
    w.log_here = log_next;
    w.s.a = node.p;
    w.changes = 0;
    if (std::abs(node.p - w.refused_at) > std::abs(w.to) * short_step) w.refused = false;
}

// Whether the branch ends after a step that was refused or is followed by a short one. The reason
// is judged at the first short step that is refused; a later one overrides it if the first was
// refused only for its interpolation error.
bool ends(Sweep& w, const Trial& trial, double step, bool judged) {
    if (std::abs(w.h) > std::abs(w.to) * short_step || w.is_done()) return false;
    const Outcome reason =
        end_reason(trial, w.stride.node, w.stride.curvature, step, w.s.setup.length);
    if (!w.refused) w.refused_at = w.stride.node.p;
    const bool better = w.ended == Outcome::branch_lost || (w.by_error && !judged);
    if (!w.refused || (better && reason != Outcome::branch_lost)) {
        w.ended = reason;
        w.by_error = judged;
    }
    w.refused = true;
    return !(std::abs(w.h) > std::abs(w.to) * shortest_step);
}

// One step, accepted or refused; an outcome other than `converged` where the branch ends.
Outcome try_next(Sweep& w) {
    const Node &node = w.stride.node, &next = w.stride.next;
    w.stride.next.p =
        std::abs(w.s.setup.end - node.p) < std::abs(w.h) * 1.1 ? w.s.setup.end : node.p + w.h;
    KnotCrossing met;
    Trial trial = step_to_knot(w.s, w.settings, w.stride, met);
    const double step = next.p - node.p;
    if (step == 0) {  // the node lies on a knot
        piece_of(w.s, *met.curve) += met.side;
        if (++w.changes > 2 * static_cast<int>(w.s.kinks.curves.size()))
            return Outcome::limit_point;
        return begin_anew(w);
    }
    double error = std::numeric_limits<double>::infinity();
    if (trial.verdict == Verdict::accepted) {
        const double log_next = log_determinant(w.s.system);
        if (const Outcome o = judge_step(w, trial, log_next, error); o != Outcome::converged)
            return o;
        if (trial.verdict == Verdict::accepted && error <= 1) {
            take_step(w, log_next);
            if (met.curve && !w.is_done()) {
                take_pieces(w.s, w.settings, node, w.h * 1e-3, w.stride.q);
                return begin_anew(w);
            }
        }
    }
    const bool judged = trial.verdict == Verdict::accepted && std::isfinite(error);
    const double change = judged ? 0.85 * std::pow(std::max(error, 1e-8), -0.25) : 0.3;
    w.h = step * std::clamp(change, 0.1, 4.0);
    return ends(w, trial, step, judged) ? w.ended : Outcome::converged;
}

// Records the points at equal increments of the parameter up to `to`. Pre: the state
// has just settled.
Outcome adapt(SteppingState& s, const Adaptive& method, double to, Recording& recording) {
    const Node start{.q = s.q, .lambda = s.lambda};
    Sweep w{.s = s,
            .settings = {Drive::rate, method.length_tolerance, method.angle_tolerance},
            .to = to,
            .recording = recording,
            .stride = {start, start, Vector<double>::Zero(s.n()), Vector<double>::Zero(s.m()), s.q,
                       s.lambda},
            .h = to / 8};
    Node& node = w.stride.node;
    // The factors are those of the last correction of settling.
    differentiate(s, w.settings, node);
    w.orientation = node.orientation;
    if (!s.kinks.curves.empty()) {
        take_pieces(s, w.settings, node, w.h * 1e-3, w.stride.q);
        if (const Outcome outcome = begin_anew(w); outcome != Outcome::converged) return outcome;
    }
    w.log_here = log_determinant(s.system);
    if (const Outcome outcome = check_start_stability(s, start_stability(s));
        outcome != Outcome::converged)
        return outcome;
    keep(w, node.q, node.lambda, 0);
    for (int steps = 0; !w.is_done(); ++steps) {
        if (steps == max_steps) return Outcome::iteration_limit;
        if (node.p == s.setup.end && s.setup.end != to) return Outcome::inconsistent_constraints;
        if (const Outcome outcome = try_next(w); outcome != Outcome::converged) return outcome;
    }
    return Outcome::converged;
}

}  // namespace

EquilibriumPath sweep_adaptive(const Model& model, const Branch& branch, const Options& options,
                               const Analysis& analysis, const PointVisitor& visit, Stop& stop) {
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
            path.outcome == Outcome::singular ? s.start.unstable : std::string()};
    return path;
}

}  // namespace elastocheck::recursive
