#include "recursive/stepping/settle.hpp"

namespace elastocheck::recursive {
namespace {

// Whether joints that are open at the design position are still open after settling, by more than
// `share` of their gap. An angle counts as closed on one side only (u_i·w = 0 has two solutions).
bool remains_open(const SteppingState& s, double share) {
    const double design_gap = s.start.Phi_d.norm();
    const double rounding =
        std::max(10 * guard::closed,
                 100 * std::numeric_limits<double>::epsilon() * std::max(1.0, s.setup.length));
    Vector<double> Phi = constraint_values<double>(s.model, s.inputs, s.q);
    for (std::size_t c = 0; c < s.model.constraints.size(); ++c) {
        const ConstraintKind& kind = s.model.constraints[c].kind;
        if (is_angle(kind) && !(slope<double>(kind, s.inputs.offset[c], s.q) < 0)) return true;
    }
    return !(Phi.norm() <= share * design_gap + rounding);
}

}  // namespace

bool loads_idle_mode(const SteppingState& s) {
    Vector<double> f_ext, f_elast;
    external_force<double>(s.model, s.branch, s.inputs, s.q, f_ext);
    elastic_force<double>(s.model, s.inputs, s.q, f_elast);
    const double total_force = size_of_force(s, f_ext) + size_of_force(s, f_elast);
    const double rounding = guard::rounding * std::numeric_limits<double>::epsilon();
    const double uncertainty = s.start.Phi_d.norm() / std::min(1.0, s.setup.length);
    return !(load_on_idle_modes(s, f_ext - f_elast, total_force) <=
             rounding + guard::share_per_error * uncertainty);
}

Outcome settled(const SteppingState& s, Outcome outcome, double share) {
    if (outcome == Outcome::not_finite || outcome == Outcome::loaded_idle_mode ||
        outcome == Outcome::iteration_limit)
        return outcome;
    const bool was_open = s.start.Phi_d.norm() > 0;
    if (outcome != Outcome::converged)
        return was_open ? Outcome::inconsistent_constraints : outcome;
    // A gap that linear steps open between closed joints is a step error, not inconsistency.
    return was_open && remains_open(s, share) ? Outcome::inconsistent_constraints : outcome;
}

Outcome settle(SteppingState& s, const Linear& method, int steps) {
    // The error of one linear step is the square of its size: below rounding for this size.
    const double accurate_step = 1e-6 * s.setup.length;  // |W Δq| [m]
    for (const int N : {1, steps}) {
        s.setup.consistent = false;
        s.q = s.step.before = design_state<double>(s.model);
        s.lambda.setZero();
        go_to(s, {1, 0});
        if (loads_idle_mode(s)) return Outcome::loaded_idle_mode;
        go_to(s, {0, 0});
        external_force<double>(s.model, s.branch, s.inputs, s.q, s.work.applied);
        s.work.applied -= s.start.R_d;
        elastic_force<double>(s.model, s.inputs, s.q, s.work.stored);
        s.work.element.clear();
        for (std::size_t k = 0; k < s.model.elastics.size(); ++k)
            s.work.element.push_back(
                element_force<double>(s.model.elastics[k].kind, s.inputs.rest[k], s.q));
        drive_at(s, Drive::start, 1, s.q, s.lambda);
        if (s.work.upper.isZero(0) && s.work.lower.isZero(0)) {  // nothing is held: λ⁻¹ = 0
            go_to(s, {1, 0});
            return Outcome::converged;
        }
        Outcome outcome = Outcome::converged;
        for (int k = 1; k <= N && outcome == Outcome::converged; ++k)
            outcome =
                step(s, method, {k == N ? 1 : static_cast<double>(k) / static_cast<double>(N), 0});
        const bool is_accurate =
            outcome == Outcome::converged && s.step.last.norm() <= accurate_step;
        s.step.swings = 0;
        s.step.last.setZero();
        // The gap left by linear steps falls with their number; more than this share of the gap at the
        // design position is not closing.
        constexpr double max_share = 0.5;
        if (is_accurate || N == steps) return settled(s, outcome, max_share);
    }
    return Outcome::converged;
}

namespace {

Outcome settle_consistently(SteppingState& s) {
    s.setup.consistent = true;
    go_to(s, {1, 0});
    if (loads_idle_mode(s)) return Outcome::loaded_idle_mode;
    const double length = s.setup.length;
    // Steps before the end need only stay in the convergence region of Newton's method.
    const ContinuationSettings settings{Drive::start, 1e-4 * length, 1e-4};
    Node node{.q = s.q, .lambda = s.lambda}, next = node;
    go_to(s, {0, 0});
    drive_at(s, Drive::start, 1, s.q, s.lambda);
    if (!s.work.upper.isZero(0) || !s.work.lower.isZero(0)) {
        if (const Outcome outcome = factorise_at(s, s.q, s.lambda); outcome != Outcome::converged)
            return outcome;
        differentiate(s, settings, node);
        Vector<double> curvature = Vector<double>::Zero(s.n()),
                       lambda_curvature = Vector<double>::Zero(s.m());
        double h = 1;
        while (node.p < 1) {
            next.p = node.p + h < 1 - h / 8 ? node.p + h : 1;
            const Trial trial = try_step(s, settings, node, curvature, lambda_curvature, next);
            const double tried = next.p - node.p;
            if (trial.verdict == Verdict::accepted) {
                curvature = (next.dq - node.dq) / tried;
                lambda_curvature = (next.dlambda - node.dlambda) / tried;
                std::swap(node, next);
                h = 2 * tried;
            } else if (h = tried / 4; h < 1e-6) {
                return end_reason(trial, node, curvature, tried, length);
            }
        }
    }
    // Corrections fall quadratically down to round-off. From a stiff start they need not fall at
    // once. If they do not become small, the outcome is branch_lost.
    constexpr int max_corrections = 24;
    const double round_off = 100 * std::numeric_limits<double>::epsilon() * length;
    const double small = std::max(1e-6 * length, 1000 * round_off);
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0;; ++k) {
        double unused = 0;
        if (const Outcome outcome = correct(s, ContinuationSettings{Drive::start, length, 1},
                                            node.q, node.lambda, 1, unused);
            outcome != Outcome::converged)
            return outcome;
        const double size = std::sqrt(size_of_solution(s));
        if (size <= round_off || (size <= small && !(size < before))) break;
        if (k == max_corrections) return Outcome::branch_lost;
        before = size;
    }
    if (has_redundancy(s)) {
        residual_at(s, node.q, node.lambda);
        --s.counts.evaluations;  // a check only: not counted
        if (is_inconsistent(s, node.q)) return Outcome::inconsistent_constraints;
    }
    s.q = s.step.before = node.q;
    s.lambda = node.lambda;
    s.start.orientation = s.system.lu.orientation;
    s.step.last.setZero();
    return Outcome::converged;
}

}  // namespace

Outcome settle(SteppingState& s) { return settled(s, settle_consistently(s), 0); }

}  // namespace elastocheck::recursive
