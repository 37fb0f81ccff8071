#include "compare/studies/precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "compare/jobs/jobs.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

// The last point of a curve, at which step counts are compared.
Curve end_of(const Curve& curve) {
    if (curve.a.empty()) return {};
    return {.unit = curve.unit, .a = {curve.a.back()}, .start = 0, .values = {curve.values.back()}};
}

}  // namespace

const char* name(recursive::Precision precision) {
    switch (precision) {
        case recursive::Precision::single: return "float";
        case recursive::Precision::double_precision: return "double";
        case recursive::Precision::extended: return "long double";
    }
    return "";
}

Floor floor_of(const std::vector<int>& steps, const std::vector<double>& values,
               double uncertainty) {
    std::vector<std::size_t> finite;
    for (std::size_t k = 0; k < values.size(); ++k)
        if (std::isfinite(values[k])) finite.push_back(k);
    if (finite.empty()) return {.least = nan};
    // Values below the uncertainty count as equal.
    const auto value = [&](std::size_t i) { return std::max(values[finite[i]], uncertainty); };
    // An improvement is a third for four times the steps. To exclude chance, the next level must
    // keep it, or, at the finest level, the one before must have improved as well.
    const auto helps = [&](std::size_t i, double before) { return value(i) < before / 3; };
    Floor floor{.least = values[finite.front()]};
    std::size_t useful = 0;
    for (std::size_t i = 1; i < finite.size(); ++i) {
        floor.least = std::min(floor.least, values[finite[i]]);
        const double before = value(useful);
        if (helps(i, before) && (i + 1 < finite.size() ? helps(i + 1, before) : useful + 1 == i))
            useful = i;
    }
    floor.useful_steps = steps[finite[useful]];
    floor.reached = useful + 1 < finite.size();
    floor.reference = values[finite[useful]] <= uncertainty;
    return floor;
}

PrecisionStudy precision_study(const Model& model, const PrecisionOptions& options) {
    Solves solves(model);
    return precision_study(solves, options);
}

PrecisionStudy precision_study(Solves& solves, const PrecisionOptions& options) {
    const Model& model = solves.model;
    PrecisionStudy study;
    if (model.branches.empty()) {
        study.inconclusive.push_back("the scene has no branch");
        return study;
    }
    const BranchSide& side = solves.sides.front().back();
    const Branch& branch = side.branch;
    BranchSide whole = side;  // only its first and last points are recorded
    whole.branch.steps = 1;
    study.branch = side.name;
    const auto& all_channels = solves.channels;
    for (const auto& channel : all_channels)
        study.angles = study.angles || (channel.main && channel.unit == Unit::deg);

    const References known = references_on_side(solves, side, 1);
    study.inconclusive = known.failures;
    study.uncertainty = {nan, nan};
    const Curve end = study.inconclusive.empty() ? end_of(known.truth.curve) : Curve{};
    if (!end.a.empty())
        study.uncertainty = worse(distance(all_channels, end, end_of(known.other.curve)),
                                  rounding_of(all_channels, end));

    const auto solve = [&](PrecisionLevel& level, const recursive::Method& method,
                           recursive::Precision precision) {
        const auto path = walk(whole, {.recursion = {.method = method, .precision = precision},
                                       .refine = level.steps});
        level.outcome = path.outcome;
        if (path.outcome != Outcome::converged) return;
        level.constraint = path.points.back().constraint_error;
        level.error =
            distance(all_channels, end, end_of(curve(model, all_channels, branch, path.points)));
    };
    const double per_step = std::pow(coordinates(model) + constraint_rows(model), 3);
    std::vector<Job> jobs;
    for (const auto& label : options.methods) {
        const auto method = recursive::find_method(label);
        if (!method || !recursive::has_steps(*method))
            throw std::invalid_argument(fmt::format("'{}' is not a method of fixed steps", label));
        for (const auto precision :
             {recursive::Precision::single, recursive::Precision::double_precision,
              recursive::Precision::extended}) {
            PrecisionSeries series{
                .method = label, .precision = precision, .levels = {}, .constraint = {}, .mm = {}};
            for (long N = options.fewest_steps;
                 N <= options.most_steps &&
                 (series.levels.empty() ||
                  static_cast<double>(N) * per_step <= options.work_budget);
                 N *= 4) {
                series.levels.push_back(
                    {.steps = static_cast<int>(N), .constraint = nan, .error = {nan, nan}});
                jobs.push_back(
                    {fmt::format("{} in {}, {} steps", label, name(precision), N),
                     [&, method, precision, s = study.series.size(), l = series.levels.size() - 1] {
                         solve(study.series[s].levels[l], *method, precision);
                     }});
            }
            study.series.push_back(std::move(series));
        }
    }
    run_jobs(jobs, options.threads, options.progress);
    for (auto& series : study.series) {
        std::vector<int> steps;
        std::vector<double> constraint, mm;
        for (const auto& level : series.levels) {
            steps.push_back(level.steps);
            constraint.push_back(level.constraint);
            mm.push_back(level.error.mm);
        }
        series.constraint = floor_of(steps, constraint);
        series.mm = floor_of(steps, mm, study.uncertainty.mm);
    }
    return study;
}

}  // namespace elastocheck::compare
