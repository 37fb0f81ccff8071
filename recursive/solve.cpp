#include "recursive/solve.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "recursive/sweep.hpp"

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

EquilibriumPath sweep(Precision precision, const Model& model, const Branch& branch, const Options& options,
                      const Diagnosis& diagnosis, double& stopped) {
    switch (precision) {
        case Precision::single: return sweep<float>(model, branch, options, diagnosis, stopped);
        case Precision::twofold: return sweep<double>(model, branch, options, diagnosis, stopped);
        case Precision::extended: return sweep<long double>(model, branch, options, diagnosis, stopped);
    }
    return {};
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
    double stopped = 0;
    EquilibriumPath path = sweep(options.precision, model, branch, options, diagnosis, stopped);
    if (path.outcome != Outcome::converged)
        path.detail = fmt::format("branch '{}': {}", branch.name,
                                  words(diagnosis, options.method, path.outcome, stopped));
    return path;
}

}  // namespace elastocheck::recursive
