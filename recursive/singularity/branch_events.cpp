#include "recursive/singularity/branch_events.hpp"

#include <algorithm>
#include <cmath>

#include "recursive/stepping/adaptive.hpp"
#include "recursive/stepping/event_location.hpp"
#include "recursive/stepping/settle.hpp"
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/step_check.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive {
namespace {

constexpr double max_step = 1. / 4, min_step = 1. / 64;  // as fractions of the branch
constexpr double tolerance = 1e-4;                       // of L, or rad: tolerance of the corrector

// Whether the outcome means the end of the branch and not a numerical failure.
bool ends(Outcome outcome) {
    return outcome == Outcome::limit_point || outcome == Outcome::bifurcation_point ||
           outcome == Outcome::singular || outcome == Outcome::branch_lost ||
           outcome == Outcome::inconsistent_constraints;
}

// Settles to the equilibrium at a = 0 and leaves its factors in the system.
Outcome settle_start(SteppingState& s, const Branch& branch, const Analysis& analysis) {
    const bool as_drawn = analysis.at_rest && starts_as_drawn(branch) && s.kinks.curves.empty();
    if (as_drawn) go_to(s, {1, 0});
    const Outcome outcome = as_drawn ? check_factors(s, s.q, analysis.pivot_ratio) : settle(s);
    if (outcome != Outcome::converged) return outcome;
    return check_start_stability(s, as_drawn ? analysis.start : start_stability(s));
}

// Stability at the nodes of one traversal. A change of the determinant's sign shows an odd number
// of negative stiffnesses; the softest modes show two at once.
struct Stability {
    Matrix<double> softest = {};

    // With the factors of `next` in the system.
    bool is_lost(SteppingState& s, const Trial& trial) {
        if (trial.verdict == Verdict::past_singular_point) return true;
        if (trial.verdict != Verdict::accepted) return false;
        const LeastStiffness least = min_stiffness(s, softest);
        return least.of_energy && least.value < 0;
    }
};

// Parameter at which stability is lost between a stable node and p = far, by bisection with
// accepted steps; none if `far` is reached and stable, or if no step decides.
std::optional<double> lost_between(SteppingState& s, const ContinuationSettings& settings,
                                   Node node, double far) {
    constexpr double resolution = 1e-6;   // of the way from the node
    constexpr int max_steps_tried = 100;  // bisection takes 20, the rest is for rejected ones
    const Vector<double> none = Vector<double>::Zero(s.n()),
                         lambda_none = Vector<double>::Zero(s.m());
    const double finest = resolution * std::abs(far - node.p);
    Node next = node;
    Stability stability;
    bool lost = false;
    double h = far - node.p;
    for (int tried = 0; tried < max_steps_tried && std::abs(h) > finest / 2; ++tried) {
        next.p = node.p + h;
        const Trial trial = try_step(s, settings, node, none, lambda_none, next);
        if (stability.is_lost(s, trial)) {
            if (std::abs(h) <= finest) return next.p;
            far = next.p;
            lost = true;
            h /= 2;
        } else if (trial.verdict == Verdict::accepted) {
            std::swap(node, next);
            if (node.p == far) return std::nullopt;
            h = lost ? std::max(std::abs(far - node.p) / 2, finest) * (far > node.p ? 1 : -1)
                     : far - node.p;
        } else {
            h /= 4;
        }
    }
    return std::nullopt;
}

// Parameter between two stable nodes at which the determinant has the other sign, or at which two
// modes may have become unstable; none if the determinant stays away from zero.
std::optional<double> suspect_between(SteppingState& s, const ContinuationSettings& settings,
                                      const Node& from, const Node& to, double log_from,
                                      double log_to) {
    // Below this fraction of the larger end value two modes may have passed zero.
    constexpr double nearly = 0.01;
    State<double> q = from.q;
    Vector<double> lambda = from.lambda;
    const auto parameter = [&](double t) { return from.p + t * (to.p - from.p); };
    const auto determinant = [&](double t) {
        interpolate(from, to, t, q, lambda);
        go_to(s, settings.at(parameter(t)));
        const bool regular = factorise_at(s, q, lambda) == Outcome::converged;
        return regular && s.system.lu.orientation == from.orientation
                   ? std::exp2(log_determinant(s.system) - log_from)
                   : -1;
    };
    const double end = std::exp2(log_to - log_from);
    const Dip lowest = lowest_determinant({1, determinant(0.5), end}, determinant);
    return lowest.t > 0 && lowest.t < 1 && lowest.value < nearly * std::max(1., end)
               ? std::optional(parameter(lowest.t))
               : std::nullopt;
}

// Result of following the branch with few steps. Stability lost inside may be regained
// before the end.
struct Traversal {
    bool through = false;             // the end was reached and no loss of stability was found
    std::optional<double> lost = {};  // parameter at which stability is lost
    // parameter before which redundant joints become inconsistent
    std::optional<double> consistent = {};
};

Traversal follow_by_long_steps(SteppingState& s, double to) {
    const ContinuationSettings settings{Drive::rate, tolerance * s.setup.length, tolerance};
    Node node{.q = s.q, .lambda = s.lambda}, next = node;
    differentiate(s, settings, node);
    double log_here = log_determinant(s.system);
    // The step before: its first node, the slope of the log-determinant over it, and whether its
    // interior was examined.
    Node before = node;
    double log_before = log_here, rise_before = 0;
    bool examined_before = true;
    Vector<double> curvature = Vector<double>::Zero(s.n()),
                   lambda_curvature = Vector<double>::Zero(s.m());
    State<double> q = s.q;
    Vector<double> lambda = s.lambda;
    Stability stability;
    double h = max_step;
    for (double done = 0; done < 1;) {  // fraction of the branch
        const double ahead = done + h < 1 - h / 8 ? done + h : 1;
        next.p = to * ahead;
        const Trial trial = try_step(s, settings, node, curvature, lambda_curvature, next);
        const bool accepted = trial.verdict == Verdict::accepted;
        if (accepted && is_inconsistent_at(s, next, q, lambda)) return {false, {}, node.p};
        if (accepted && negative_idle_stiffness(s, next.q, next.lambda) < 0) return {};
        const bool first = done == 0, last = ahead == 1;
        if (trial.verdict == Verdict::past_singular_point ||
            (last && stability.is_lost(s, trial))) {
            if (const auto lost = lost_between(s, settings, node, next.p)) return {false, lost};
        } else if (accepted && is_straight(s, settings, node, next)) {
            if (ahead == 1 && is_unstable(s)) return {};
            const double log_next = log_determinant(s.system),
                         rise = (log_next - log_here) / (ahead - done);
            const bool has_minimum = !first && rise_before < 0 && rise > 0;
            for (const bool this_step : {true, false}) {
                if (this_step ? !(first || last || has_minimum)
                              : !(has_minimum && !examined_before))
                    continue;
                const Node &from = this_step ? node : before, &to_node = this_step ? next : node;
                const auto suspect =
                    suspect_between(s, settings, from, to_node, this_step ? log_here : log_before,
                                    this_step ? log_next : log_here);
                if (!suspect) continue;
                if (const auto lost = lost_between(s, settings, from, *suspect))
                    return {false, lost};
            }
            before = node;
            log_before = log_here;
            rise_before = rise;
            examined_before = first || has_minimum;
            curvature = (next.dq - node.dq) / (next.p - node.p);
            lambda_curvature = (next.dlambda - node.dlambda) / (next.p - node.p);
            std::swap(node, next);
            log_here = log_next;
            h = std::min(2 * (ahead - done), max_step);
            done = ahead;
            continue;
        }
        if (h = (ahead - done) / 4; h < min_step) return {};
    }
    return {true};
}

}  // namespace

std::optional<Event> find_event(const Model& model, const Branch& branch,
                                const Analysis& analysis) {
    Stop stop;
    const Options options{.method = find_method("adaptive").value(), .steps = 1};
    const EquilibriumPath path = sweep_adaptive(model, branch, options, analysis, {}, stop);
    if (!ends(path.outcome) || std::isnan(stop.at)) return std::nullopt;
    return Event{path.outcome, stop.at};
}

std::optional<Event> watch(const Model& model, const Branch& branch, const Analysis& analysis) {
    if (branch.to == 0 || model.bodies.empty()) return std::nullopt;
    SteppingState s(model, branch, analysis);
    s.setup.consistent = true;
    // Newton corrections at every node restore accuracy, and a pivot order costs ten
    // factorisations.
    s.system.lu.largest_multiplier = 1e4;
    if (const Outcome o = settle_start(s, branch, analysis);
        ends(o) || o == Outcome::loaded_idle_mode)
        return Event{o, std::numeric_limits<double>::quiet_NaN(), s.start.unstable};
    else if (o != Outcome::converged)
        return std::nullopt;  // the method reports this failure itself
    const Traversal traversal = follow_by_long_steps(s, s.setup.end);
    if (traversal.through) return std::nullopt;
    const std::optional<Event> event = find_event(model, branch, analysis);
    const bool sooner =
        traversal.lost &&
        !(event && std::abs(event->load) <= (1 + tolerance) * std::abs(*traversal.lost));
    if (!event && traversal.consistent)
        return Event{Outcome::inconsistent_constraints, *traversal.consistent};
    return sooner ? Event{Outcome::bifurcation_point, *traversal.lost} : event;
}

}  // namespace elastocheck::recursive
