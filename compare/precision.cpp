#include "compare/precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "reference/energy/solve.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck::compare {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
double worse(double a, double b) { return std::isnan(a) || a > b ? a : b; }  // NaN is larger than anything

Accuracy distance(const std::vector<Channel>& channels, const std::vector<double>& a,
                  const std::vector<double>& b) {
    Accuracy worst;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (!channels[c].main) continue;
        double& side = channels[c].unit == Unit::deg ? worst.deg : worst.mm;
        side = worse(side, std::abs(b[c] - a[c]));
    }
    return worst;
}

}  // namespace

const char* name(recursive::Precision precision) {
    switch (precision) {
        case recursive::Precision::single: return "float";
        case recursive::Precision::twofold: return "double";
        case recursive::Precision::extended: return "long double";
    }
    return "";
}

Floor floor_of(const std::vector<int>& steps, const std::vector<double>& values, double uncertainty) {
    std::vector<std::size_t> finite;
    for (std::size_t k = 0; k < values.size(); ++k)
        if (std::isfinite(values[k])) finite.push_back(k);
    if (finite.empty()) return {.least = nan};
    // Below the uncertainty nothing is better than anything else.
    const auto value = [&](std::size_t i) { return std::max(values[finite[i]], uncertainty); };
    // A third for four times the steps, and not by the luck of a single rounding: the next must stay there,
    // or, at the finest, the one before have fallen as well.
    const auto helps = [&](std::size_t i, double before) { return value(i) < before / 3; };
    Floor floor{.least = values[finite.front()]};
    std::size_t useful = 0;
    for (std::size_t i = 1; i < finite.size(); ++i) {
        floor.least = std::min(floor.least, values[finite[i]]);
        const double before = value(useful);
        if (helps(i, before) && (i + 1 < finite.size() ? helps(i + 1, before) : useful + 1 == i)) useful = i;
    }
    floor.useful_steps = steps[finite[useful]];
    floor.reached = useful + 1 < finite.size();
    floor.reference = values[finite[useful]] <= uncertainty;
    return floor;
}

PrecisionStudy precision_study(const Model& model, const PrecisionOptions& options) {
    PrecisionStudy study;
    if (model.branches.empty()) {
        study.inconclusive.push_back("the scene has no branch");
        return study;
    }
    const Branch& branch = model.branches.front();
    study.branch = branch.name;
    const auto all_channels = channels(model);
    for (const auto& channel : all_channels)
        study.angles = study.angles || (channel.main && channel.unit == Unit::deg);

    std::vector<double> loads;
    for (int k = 0; k <= 10; ++k) loads.push_back(branch.to * k / 10);
    const auto truth = reference::equilibrium::solve(model, branch, loads),
               other = reference::energy::solve(model, branch, loads);
    for (const auto& [leg, path] : {std::pair{Leg::equilibrium, &truth}, std::pair{Leg::energy, &other}})
        if (path->outcome != Outcome::converged)
            study.inconclusive.push_back(
                fmt::format("{} leg: {}: {}", name(leg), name(path->outcome), path->detail));
    study.uncertainty = {nan, nan};
    std::vector<double> end;
    if (study.inconclusive.empty()) {
        end = evaluate(model, truth.points.back());
        auto nudged = end;  // the references may agree to the last bit by luck
        for (double& v : nudged) v *= 1 + 4 * std::numeric_limits<double>::epsilon();
        const Accuracy apart = distance(all_channels, end, evaluate(model, other.points.back()));
        const Accuracy rounding = distance(all_channels, end, nudged);
        study.uncertainty = {worse(apart.mm, rounding.mm), worse(apart.deg, rounding.deg)};
    }

    const double per_step = std::pow(coordinates(model) + constraint_rows(model), 3);
    for (const auto& label : options.methods) {
        const auto method = recursive::find_method(label);
        if (!method || !recursive::has_steps(*method))
            throw std::invalid_argument(fmt::format("'{}' is not a method of fixed steps", label));
        for (const auto precision :
             {recursive::Precision::single, recursive::Precision::twofold, recursive::Precision::extended}) {
            PrecisionSeries series{
                .method = label, .precision = precision, .levels = {}, .constraint = {}, .mm = {}};
            std::vector<int> steps;
            std::vector<double> constraint, mm;
            for (long N = options.fewest_steps;
                 N <= options.most_steps &&
                 (series.levels.empty() || static_cast<double>(N) * per_step <= options.work_budget);
                 N *= 4) {
                if (options.progress)
                    options.progress(fmt::format("{} in {}, {} steps", label, name(precision), N));
                PrecisionLevel level{.steps = static_cast<int>(N), .constraint = nan, .error = {nan, nan}};
                const auto path = recursive::solve(
                    model, branch,
                    {.method = *method, .steps = level.steps, .record = 1, .precision = precision});
                level.outcome = path.outcome;
                if (path.outcome == Outcome::converged) {
                    level.constraint = path.points.back().constraint_error;
                    if (!end.empty())
                        level.error = distance(all_channels, end, evaluate(model, path.points.back()));
                }
                series.levels.push_back(level);
                steps.push_back(level.steps);
                constraint.push_back(level.constraint);
                mm.push_back(level.error.mm);
            }
            series.constraint = floor_of(steps, constraint);
            series.mm = floor_of(steps, mm, study.uncertainty.mm);
            study.series.push_back(std::move(series));
        }
    }
    return study;
}

}  // namespace elastocheck::compare
