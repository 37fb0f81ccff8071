// Sweep along a branch by the methods with equal steps: settle at a = 0, then N
// increments, eqs. (25)-(29).
#pragma once

#include "elastocheck/recursive.hpp"
#include "recursive/stepping/recording.hpp"
#include "recursive/stepping/settle.hpp"

namespace elastocheck::recursive {

// Returns the recorded points up to the end or the failure; with a visitor they are streamed
// instead. On failure `stop` says where; the caller writes the message. Pre: Linear or Consistent.
inline EquilibriumPath sweep(const Model& model, const Branch& branch, const Options& options,
                             const Analysis& analysis, const PointVisitor& visit, Stop& stop) {
    const int N = options.steps > 0 ? options.steps : branch.steps;
    const int points = options.record > 0 ? options.record : N;
    SteppingState s(model, branch, analysis);
    EquilibriumPath path;
    Recording recording(model, points + 1, path, visit);
    const auto equal_steps = [&](const auto& method, const auto& where_lambda_acts) -> Outcome {
        const auto keep = [&](double a) {
            recording.keep(s.model, s.inputs, s.q, where_lambda_acts, s.lambda, a);
        };
        stop.at = 0;
        keep(0);
        pass_kinks(s);  // kinks at the settled start
        s.kinks.uncompared = 0;
        for (int k = 1; k <= N; ++k) {
            stop.at = branch.to * k / N;
            if (const Outcome o = step(s, method, {1, stop.at}); o != Outcome::converged) return o;
            if (static_cast<long>(k) * points % N == 0) keep(stop.at);
        }
        return check_held_modes(s);
    };
    stop = {};
    if (const auto* method = std::get_if<Linear>(&options.method.kind)) {
        const bool follows = method->stored.lever_follows || method->stored.axis_follows;
        const bool true_forces = method->stored == all_follow;
        path.outcome = true_forces ? settle(s) : settle(s, *method, N);
        s.setup.consistent = false;
        if (path.outcome == Outcome::converged)
            path.outcome = equal_steps(*method, follows ? s.q : s.step.before);
    } else {
        const auto& tangent = std::get<Consistent>(options.method.kind);
        path.outcome = settle(s);
        if (path.outcome == Outcome::converged) path.outcome = equal_steps(tangent, s.q);
        if (path.outcome == Outcome::converged && tangent.solve == Consistent::Solve::once)
            path.outcome = check_last_step(s);
    }
    recording.finish();
    path.counts = s.counts;
    return path;
}

}  // namespace elastocheck::recursive
