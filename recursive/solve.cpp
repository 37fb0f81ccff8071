#include "recursive/solve.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "recursive/adaptive.hpp"
#include "recursive/steps.hpp"

namespace elastocheck::recursive {
namespace {

std::string words(const Diagnosis& diagnosis, const Method& method, Outcome outcome, double load) {
    std::string detail = fmt::format("at load factor {:.6g}", load);
    if (outcome == Outcome::loaded_idle_mode) {
        detail += ": the load pushes what nothing resists:";
        for (const auto& mode : diagnosis.idle) detail += " " + mode.description + ";";
        detail.pop_back();
    } else if (outcome == Outcome::singular && diagnosis.null_space.cols() > 0) {
        detail += ": the matrix lost rank, or what was idle or redundant at the design position no longer is";
    } else if (outcome == Outcome::diverged) {
        detail += method.consistent
                      ? ": what a step misses is more than half of it; take more steps"
                      : ": the stored forces turn stiffer than the elements are, the recursion is unstable "
                        "from here on";
    }
    return detail;
}

template <class Real>
EquilibriumPath march(const Model& model, const Branch& branch, const Options& options,
                      const Diagnosis& diagnosis) {
    const int N = options.steps > 0 ? options.steps : branch.steps;
    const int points = options.record > 0 ? options.record : N;
    March<Real> s(model, branch, options.method, diagnosis);
    EquilibriumPath path;
    make_room(model, points + 1, path);
    std::size_t reached = 0;
    const auto finish = [&](Outcome outcome, double load) {
        path.outcome = outcome;
        if (outcome != Outcome::converged)
            path.detail =
                fmt::format("branch '{}': {}", branch.name, words(diagnosis, options.method, outcome, load));
        path.points.resize(reached);
        path.counts = s.counts;
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

}  // namespace

EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options) {
    if (options.method.series) {
        if (options.precision != Precision::twofold)
            throw std::invalid_argument("the series is computed in double precision only");
        const int points = options.record > 0  ? options.record
                           : options.steps > 0 ? options.steps
                                               : branch.steps;
        return series::sample(model, series::follow(model, branch, options.series), branch, points);
    }
    const Diagnosis diagnosis = diagnose(model);
    if (!(diagnosis.constraint_error <= 1e-9)) {
        EquilibriumPath path;
        path.outcome = Outcome::inconsistent_constraints;
        path.detail =
            fmt::format("branch '{}': the joints are not closed at the design position, |Φ| = {:.3g}",
                        branch.name, diagnosis.constraint_error);
        return path;
    }
    switch (options.precision) {
        case Precision::single: return march<float>(model, branch, options, diagnosis);
        case Precision::twofold: return march<double>(model, branch, options, diagnosis);
        case Precision::extended: return march<long double>(model, branch, options, diagnosis);
    }
    return {};
}

}  // namespace elastocheck::recursive
