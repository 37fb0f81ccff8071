// Sweep along a branch, shared by all stepping methods: settle at a = 0, then N increments, eqs.
// (25)-(29), or the steps of the adaptive method. Instantiated once per arithmetic (sweep_*.cpp) to
// compile in parallel.
#pragma once

#include "elastocheck/recursive.hpp"
#include "recursive/stepping/adaptive.hpp"

namespace elastocheck::recursive {

// Where a sweep stopped: the parameter, NaN while settling; and whether the cause is that the
// settled start is unstable.
struct Stop {
    double at = std::numeric_limits<double>::quiet_NaN();
    bool begins_unstable = false;
};

// Returns the recorded points up to the end or the failure; with a visitor they are streamed
// instead. On failure `stop` says where; the caller writes the message.
template <class Real>
EquilibriumPath sweep(const Model& model, const Branch& branch, const Options& options,
                      const Analysis& analysis, const Visit& visit, Stop& stop) {
    const int N = options.steps > 0 ? options.steps : branch.steps;
    const int points = options.record > 0 ? options.record : N;
    SteppingState<Real> s(model, branch, analysis);
    EquilibriumPath path;
    Recording recording(model, points + 1, path, visit);
    const auto finish = [&](Outcome outcome, double a) {
        path.outcome = outcome;
        recording.finish();
        path.counts = s.counts;
        stop = {a, outcome == Outcome::singular && s.begins_unstable};
        return path;
    };
    double stopped = 0;
    const auto equal_steps = [&](const auto& method, const auto& where_lambda_acts) -> Outcome {
        const auto keep = [&](double a) {
            recording.keep(s.model, s.inputs, s.q, where_lambda_acts, s.lambda, a);
        };
        keep(0);
        pass_kinks(s);  // kinks at the settled start
        s.kinked = 0;
        for (int k = 1; k <= N; ++k) {
            stopped = branch.to * k / N;
            if (const Outcome o = step(s, method, {1, static_cast<Real>(stopped)});
                o != Outcome::converged)
                return o;
            if (static_cast<long>(k) * points % N == 0) keep(stopped);
        }
        return check_what_is_held(s);
    };
    constexpr double settling = std::numeric_limits<double>::quiet_NaN();
    return std::visit(
        overloaded{
            [&](const Linear& method) {
                const bool follows = method.follow.lever || method.follow.axis;
                const bool truth = method.follow == everything;
                if (const Outcome o = truth ? settle(s) : settle(s, method, N);
                    o != Outcome::converged)
                    return finish(o, settling);
                s.consistent = false;
                const Outcome o = equal_steps(method, follows ? s.q : s.before);
                return finish(o, stopped);
            },
            [&](const Consistent& method) {
                if (const Outcome o = settle(s); o != Outcome::converged)
                    return finish(o, settling);
                Outcome o = equal_steps(method, s.q);
                if (o == Outcome::converged && method.solve == Consistent::Solve::once)
                    o = check_last_step(s);
                return finish(o, stopped);
            },
            [&](const Adaptive& method) {
                if (const Outcome o = settle(s); o != Outcome::converged)
                    return finish(o, settling);
                const Outcome o = adapt(s, method, branch.to, recording);
                return finish(o, static_cast<double>(s.a));
            },
            [&](const Series&) { return finish(Outcome::not_finite, settling); },  // never called
        },
        options.method.kind);
}

extern template EquilibriumPath sweep<float>(const Model&, const Branch&, const Options&,
                                             const Analysis&, const Visit&, Stop&);
extern template EquilibriumPath sweep<double>(const Model&, const Branch&, const Options&,
                                              const Analysis&, const Visit&, Stop&);
extern template EquilibriumPath sweep<long double>(const Model&, const Branch&, const Options&,
                                                   const Analysis&, const Visit&, Stop&);

}  // namespace elastocheck::recursive
