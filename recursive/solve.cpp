#include "recursive/solve.hpp"

#include <fmt/format.h>

#include <numbers>
#include <stdexcept>

#include "recursive/series/path.hpp"
#include "recursive/sweep.hpp"

namespace elastocheck::recursive {
namespace {

// A value of the branch's parameter as it is spoken of: "at 1200 N", "at 35.2 mm".
std::string at_parameter(ParameterUnit unit, double a) {
    switch (unit) {
        case ParameterUnit::newton: return fmt::format("at {:.6g} N", a);
        case ParameterUnit::newton_metre: return fmt::format("at {:.6g} N·m", a);
        case ParameterUnit::metre: return fmt::format("at {:.6g} mm", 1e3 * a);
        case ParameterUnit::radian: return fmt::format("at {:.6g} deg", a * 180 / std::numbers::pi);
        case ParameterUnit::none: return fmt::format("at {:.6g}", a);
    }
    return {};
}

std::string words(const Diagnosis& diagnosis, const Branch& branch, const Method& method, Outcome outcome,
                  double stopped) {
    std::string detail = std::isnan(stopped) ? std::string("while what is held at the start settles")
                                             : at_parameter(branch.unit, stopped);
    switch (outcome) {
        case Outcome::loaded_idle_mode:
            detail += ": the load pushes what nothing resists: " + idle_modes(diagnosis);
            break;
        case Outcome::singular:
            detail += ": the branch divides, turns back or loses its stability before";
            if (diagnosis.null_space.cols() > 0)
                detail += ", or what was idle or redundant at the design position no longer is";
            break;
        case Outcome::inconsistent_constraints:
            detail = fmt::format("the joints cannot be closed; as drawn they are open by |Φ| = {:.3g}",
                                 diagnosis.constraint_error);
            break;
        case Outcome::limit_point:
            detail += ": a limit point, past it no equilibrium continues the branch";
            break;
        case Outcome::dividing_point:
            detail += ": another curve of equilibria crosses the branch, which is unstable past this point";
            break;
        case Outcome::diverged:
            detail +=
                std::holds_alternative<Linear>(method.kind)
                    ? ": the stored forces turn stiffer than the elements are, the recursion is unstable "
                      "from here on"
                    : ": what a step misses is more than half of it; take more steps";
            break;
        case Outcome::converged:
        case Outcome::not_finite:
        case Outcome::iteration_limit:
        case Outcome::branch_lost:
        case Outcome::not_conservative:      // of the energy
        case Outcome::too_large:             // likewise
        case Outcome::outside_table: break;  // found in compare/
    }
    return detail;
}

EquilibriumPath sweep(Precision precision, const Model& model, const Branch& branch, const Options& options,
                      const Analysis& analysis, const Visit& visit, double& stopped) {
    switch (precision) {
        case Precision::single: return sweep<float>(model, branch, options, analysis, visit, stopped);
        case Precision::twofold: return sweep<double>(model, branch, options, analysis, visit, stopped);
        case Precision::extended: return sweep<long double>(model, branch, options, analysis, visit, stopped);
    }
    return {};
}

}  // namespace

EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options,
                      const Analysis& analysis, const Visit& visit) {
    check(model, branch);
    if (const auto* how = std::get_if<Series>(&options.method.kind)) {
        if (options.precision != Precision::twofold)
            throw std::invalid_argument("the series is computed in double precision only");
        const int points = options.record > 0  ? options.record
                           : options.steps > 0 ? options.steps
                                               : branch.steps;
        return series::sample(model, series::follow(model, branch, *how, analysis), branch, points, visit);
    }
    double stopped = 0;
    EquilibriumPath path = sweep(options.precision, model, branch, options, analysis, visit, stopped);
    if (path.outcome != Outcome::converged)
        path.detail = fmt::format("branch '{}': {}", branch.name,
                                  words(analysis.diagnosis, branch, options.method, path.outcome, stopped));
    return path;
}

EquilibriumPath solve(const Model& model, const Branch& branch, const Options& options, const Visit& visit) {
    check(model, branch);
    return solve(model, branch, options, analyse(model), visit);
}

}  // namespace elastocheck::recursive
