// The one loop of all methods that take steps: settle at load factor 0,
// then N increments, eqs. (25)-(29), or steps of the method's own.
// Instantiated once per arithmetic (sweep_*.cpp), since each takes its time to compile.
#pragma once

#include "recursive/adaptive.hpp"
#include "recursive/solve.hpp"
#include "recursive/steps.hpp"

namespace elastocheck::recursive {

// The recorded points as far as the sweep comes; where it does not converge, `stopped` is the load factor and
// the words for it are the caller's.
template <class Real>
EquilibriumPath sweep(const Model& model, const Branch& branch, const Options& options,
                      const Diagnosis& diagnosis, double& stopped) {
    const int N = options.steps > 0 ? options.steps : branch.steps;
    const int points = options.record > 0 ? options.record : N;
    March<Real> s(model, branch, options.method, diagnosis);
    EquilibriumPath path;
    make_room(model, points + 1, path);
    std::size_t reached = 0;
    const auto finish = [&](Outcome outcome, double load) {
        path.outcome = outcome;
        path.points.resize(reached);
        path.counts = s.counts;
        stopped = load;
        return path;
    };
    const bool follows = options.method.follow.lever || options.method.follow.axis;
    const auto keep = [&](double load) {
        record<Real>(s.model, s.q, follows ? s.q : s.before, s.lambda, load, path.points[reached]);
        ++reached;
    };

    if (const Outcome outcome = settle(s); outcome != Outcome::converged) return finish(outcome, 0);
    if (options.method.adaptive) {
        const Outcome outcome =
            adapt(s, options.length_tolerance, options.angle_tolerance, branch.to, path, reached);
        return finish(outcome, static_cast<double>(s.a));
    }
    keep(0);
    for (int k = 1; k <= N; ++k) {
        const double load = branch.to * k / N;
        if (const Outcome outcome = step(s, static_cast<Real>(load)); outcome != Outcome::converged)
            return finish(outcome, load);
        if (k == N && options.method.consistent && options.method.corrections == 0)
            if (const Outcome outcome = check_last_step(s); outcome != Outcome::converged)
                return finish(outcome, load);
        if (static_cast<long>(k) * points % N == 0) keep(load);
    }
    return finish(Outcome::converged, branch.to);
}

extern template EquilibriumPath sweep<float>(const Model&, const Branch&, const Options&, const Diagnosis&,
                                             double&);
extern template EquilibriumPath sweep<double>(const Model&, const Branch&, const Options&, const Diagnosis&,
                                              double&);
extern template EquilibriumPath sweep<long double>(const Model&, const Branch&, const Options&,
                                                   const Diagnosis&, double&);

}  // namespace elastocheck::recursive
