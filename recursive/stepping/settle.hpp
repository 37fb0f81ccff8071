// Settling: homotopy from the design position to the equilibrium at the start of the branch.
// t goes from 0 to 1 (stepping_state.hpp), under preloads, static loads, start values of drivers
// and joints that are open at the design position.
#pragma once

#include "recursive/stepping/continuation.hpp"
#include "recursive/stepping/steps.hpp"

namespace elastocheck::recursive {

// Whether no driver moves the start, so that a design position in equilibrium is the start.
inline bool starts_as_drawn(const Branch& branch) {
    return std::ranges::all_of(branch.drivers,
                               [](const Driver& driver) { return driver.start == 0; });
}

// Whether the forces load an idle mode, tested at the design position, where the modes are most
// accurate.
template <class Real>
bool loads_idle_mode(const SteppingState<Real>& s) {
    Vector<Real> f_ext, f_elast;
    external_force<Real>(s.model, s.branch, s.inputs, s.q, f_ext);
    elastic_force<Real>(s.model, s.inputs, s.q, f_elast);
    const Real whole = size_of_force(s, f_ext) + size_of_force(s, f_elast);
    const Real rounding = Real(guard::rounding) * std::numeric_limits<Real>::epsilon();
    const Real blur = s.Phi_d.norm() / static_cast<Real>(std::min(1.0, s.length));
    return !(load_on_idle_modes<Real>(s, f_ext - f_elast, whole) <=
             rounding + Real(guard::share_per_error) * blur);
}

// Whether joints that are open at the design position are still open after settling. An angle
// counts as closed on one side only (u_i·w = 0 has two solutions).
template <class Real>
bool remains_open(const SteppingState<Real>& s, Real share) {
    const Real open = s.Phi_d.norm();
    const Real rounding =
        std::max(Real(10 * guard::closed), 100 * std::numeric_limits<Real>::epsilon() *
                                               static_cast<Real>(std::max(1.0, s.length)));
    Vector<Real> Phi = constraint_values<Real>(s.model, s.inputs, s.q);
    for (std::size_t c = 0; c < s.model.constraints.size(); ++c) {
        const ConstraintKind& kind = s.model.constraints[c].kind;
        if (is_angle(kind) && !(slope<Real>(kind, s.inputs.offset[c], s.q) < 0)) return true;
    }
    return !(Phi.norm() <= share * open + rounding);
}
// Outcome of settling: joints that were open and cannot be closed explain other failures.
template <class Real>
Outcome settled(const SteppingState<Real>& s, Outcome outcome, Real share) {
    if (outcome == Outcome::not_finite || outcome == Outcome::loaded_idle_mode ||
        outcome == Outcome::iteration_limit)
        return outcome;
    const bool was_open = s.Phi_d.norm() > Real(0);
    if (outcome != Outcome::converged)
        return was_open ? Outcome::inconsistent_constraints : outcome;
    // A gap that linear steps open between closed joints is a step error, not inconsistency.
    return was_open && remains_open(s, share) ? Outcome::inconsistent_constraints : outcome;
}

// Settles with the stiffness of (19): in one step where the design position is an equilibrium,
// which gives λ⁻¹; else in `steps` steps, as on the branch.
template <class Real>
Outcome settle(SteppingState<Real>& s, const Linear& method, int steps) {
    // The error of one linear step is the square of its size: below rounding for this size.
    const Real at_rest = Real(1e-6) * static_cast<Real>(s.length);
    for (const int N : {1, steps}) {
        s.consistent = false;
        s.q = s.before = design_state<Real>(s.model);
        s.lambda.setZero();
        go_to(s, {1, 0});
        if (loads_idle_mode(s)) return Outcome::loaded_idle_mode;
        go_to(s, {0, 0});
        external_force<Real>(s.model, s.branch, s.inputs, s.q, s.applied);
        s.applied -= s.R_d;
        elastic_force<Real>(s.model, s.inputs, s.q, s.stored);
        s.element.clear();
        for (std::size_t k = 0; k < s.model.elastics.size(); ++k)
            s.element.push_back(
                element_force<Real>(s.model.elastics[k].kind, s.inputs.rest[k], s.q));
        drive_at(s, Drive::start, Real(1), s.q, s.lambda);
        if (s.upper.isZero(0) && s.lower.isZero(0)) {  // nothing is held: λ⁻¹ = 0
            go_to(s, {1, 0});
            return Outcome::converged;
        }
        Outcome outcome = Outcome::converged;
        for (int k = 1; k <= N && outcome == Outcome::converged; ++k)
            outcome = step(s, method,
                           {k == N ? Real(1) : static_cast<Real>(k) / static_cast<Real>(N), 0});
        const bool rested = outcome == Outcome::converged && s.last.norm() <= at_rest;
        s.swings = 0;
        s.last.setZero();
        // The gap left by linear steps falls with their number; a gap of more than half is not
        // closing.
        if (rested || N == steps) return settled(s, outcome, Real(0.5));
    }
    return Outcome::converged;
}

// Settles with the consistent tangent and the true forces: variable steps, each halved until
// accepted, and Newton corrections down to round-off at the end.
template <class Real>
Outcome settle_consistently(SteppingState<Real>& s) {
    s.consistent = true;
    go_to(s, {1, 0});
    if (loads_idle_mode(s)) return Outcome::loaded_idle_mode;
    const Real length = static_cast<Real>(s.length);
    // Steps before the end need only stay in the convergence region of Newton's method.
    const ContinuationSettings<Real> settings{Drive::start, Real(1e-4) * length, Real(1e-4)};
    Node<Real> node{s.q, s.lambda, {}, {}, 0, 0}, next = node;
    go_to(s, {0, 0});
    drive_at(s, Drive::start, Real(1), s.q, s.lambda);
    if (!s.upper.isZero(0) || !s.lower.isZero(0)) {
        if (const Outcome outcome = factorise_at(s, s.q, s.lambda); outcome != Outcome::converged)
            return outcome;
        differentiate(s, settings, node);
        Vector<Real> curvature = Vector<Real>::Zero(s.n()),
                     lambda_curvature = Vector<Real>::Zero(s.m());
        Real h = 1;
        while (node.p < Real(1)) {
            next.p = node.p + h < Real(1) - h / 8 ? node.p + h : Real(1);
            const Trial<Real> trial =
                try_step(s, settings, node, curvature, lambda_curvature, next);
            const Real tried = next.p - node.p;
            if (trial.verdict == Verdict::accepted) {
                curvature = (next.dq - node.dq) / tried;
                lambda_curvature = (next.dlambda - node.dlambda) / tried;
                std::swap(node, next);
                h = 2 * tried;
            } else if (h = tried / 4; h < Real(1e-6)) {
                return end_reason(trial, node, curvature, tried, length);
            }
        }
    }
    // Corrections fall quadratically down to round-off. From a stiff start they need not fall at
    // once. If they do not become small, the outcome is branch_lost.
    constexpr int most = 24;
    const Real enough = 100 * std::numeric_limits<Real>::epsilon() * length;
    const Real rest = std::max(Real(1e-6) * length, 1000 * enough);
    Real before = std::numeric_limits<Real>::infinity();
    for (int k = 0;; ++k) {
        Real unused = 0;
        if (const Outcome outcome =
                correct(s, ContinuationSettings<Real>{Drive::start, length, Real(1)}, node.q,
                        node.lambda, Real(1), unused);
            outcome != Outcome::converged)
            return outcome;
        const Real size = std::sqrt(size_of_solution(s));
        if (size <= enough || (size <= rest && !(size < before))) break;
        if (k == most) return Outcome::branch_lost;
        before = size;
    }
    if (has_redundancy(s)) {
        residual_at(s, node.q, node.lambda);
        --s.counts.evaluations;  // a check only: not counted
        if (is_inconsistent(s, node.q)) return Outcome::inconsistent_constraints;
    }
    s.q = s.before = node.q;
    s.lambda = node.lambda;
    s.orientation = s.system.lu.orientation;
    s.last.setZero();
    return Outcome::converged;
}
template <class Real>
Outcome settle(SteppingState<Real>& s) {
    return settled(s, settle_consistently(s), Real(0));
}

// Instantiated in stepping/sweep_double.cpp.
extern template Outcome settle<double>(SteppingState<double>&);
extern template Outcome settled<double>(const SteppingState<double>&, Outcome, double);

}  // namespace elastocheck::recursive
