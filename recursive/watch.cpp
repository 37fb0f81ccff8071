#include "recursive/watch.hpp"

#include "recursive/settle.hpp"
#include "recursive/stiffness.hpp"
#include "recursive/straight.hpp"
#include "recursive/sweep.hpp"

namespace elastocheck::recursive {
namespace {

constexpr double longest = 1. / 4, shortest = 1. / 64;  // of the way
constexpr double near = 1e-4;                           // of L, or rad: what a step need not be told apart

// Whether it is the branch that ends, not the numbers.
bool ends(Outcome outcome) {
    return outcome == Outcome::limit_point || outcome == Outcome::dividing_point ||
           outcome == Outcome::singular || outcome == Outcome::branch_lost ||
           outcome == Outcome::inconsistent_constraints;
}

// To the equilibrium at a = 0, whose factors are then in the system.
Outcome settles(March<double>& s, const Branch& branch, const Analysis& analysis) {
    const auto settled = [&] {
        if (!analysis.at_rest || !starts_as_drawn(branch) || !s.curves.empty()) return settle(s);
        go_to(s, {1, 0});
        return judge(s, s.q, analysis.pivot_ratio);
    };
    const Outcome outcome = settled();
    return outcome == Outcome::converged ? judge_start(s) : outcome;
}

// Whether the few tangents come through.
bool comes_through(March<double>& s, double to) {
    const Going<double> going{Drive::rate, near * s.length, near};
    Node<double> node{s.q, s.lambda, {}, {}, 0, 0}, next = node;
    differentiate(s, going, node);
    Vector<double> curvature = Vector<double>::Zero(s.n()), lambda_curvature = Vector<double>::Zero(s.m());
    State<double> q = s.q;
    Vector<double> lambda = s.lambda;
    double h = longest;  // of the way
    for (double gone = 0; gone < 1;) {
        const double ahead = gone + h < 1 - h / 8 ? gone + h : 1;
        next.p = to * ahead;
        const Trial<double> trial = try_step(s, going, node, curvature, lambda_curvature, next);
        if (trial.verdict == Verdict::believed && contradict_at(s, next, q, lambda)) return false;
        if (trial.verdict == Verdict::believed && pushed_over(s, next.q, next.lambda) < 0) return false;
        if (trial.verdict == Verdict::believed && is_straight(s, going, node, next)) {
            curvature = (next.dq - node.dq) / (next.p - node.p);
            lambda_curvature = (next.dlambda - node.dlambda) / (next.p - node.p);
            std::swap(node, next);
            h = std::min(2 * (ahead - gone), longest);
            gone = ahead;
        } else if (h = (ahead - gone) / 4; h < shortest) {
            return false;
        }
    }
    Softest<double> softest;
    const LeastStiffness least = least_stiffness(s, softest);
    return !(least.of_energy && least.value < 0) && !is_unstable(s);
}

}  // namespace

std::optional<Event> find_event(const Model& model, const Branch& branch, const Analysis& analysis) {
    Stop stop;
    const Options options{.method = find_method("adaptive").value(), .steps = 1};
    const EquilibriumPath path = sweep<double>(model, branch, options, analysis, {}, stop);
    if (!ends(path.outcome) || std::isnan(stop.at)) return std::nullopt;
    return Event{path.outcome, stop.at};
}

std::optional<Event> watch(const Model& model, const Branch& branch, const Analysis& analysis) {
    if (branch.to == 0 || model.bodies.empty()) return std::nullopt;
    March<double> s(model, branch, analysis);
    s.consistent = true;
    if (const Outcome o = settles(s, branch, analysis); ends(o))
        return Event{o, std::numeric_limits<double>::quiet_NaN(), s.begins_unstable};
    else if (o != Outcome::converged)
        return std::nullopt;  // the method says so itself
    if (comes_through(s, branch.to)) return std::nullopt;
    return find_event(model, branch, analysis);
}

}  // namespace elastocheck::recursive
