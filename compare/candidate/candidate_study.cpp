// Convergence study of a candidate: its curves for increasing numbers of steps, on each branch
// side, against the references, as for a method of the recursion (compare/studies/study.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/comparison/points.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

// Points of a level (one number of steps) on one branch side, from a = 0 on, as a curve of these
// channels; NaN where the candidate does not give one.
Curve curve_on(const Model& model, const BranchSide& side, const std::string& branch,
               const std::vector<Channel>& channels, const Comparison& outline,
               const Points& points) {
    const double unit = in_unit(unit_of(side.branch.unit)), to = unit * side.branch.to;
    const auto columns = as_absolute_values(model, outline, points.columns);
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < points.a.size(); ++k)
        if ((points.branch.empty() || points.branch[k] == branch) && points.a[k] * to >= 0)
            order.push_back(k);
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return std::abs(points.a[k]); });
    Curve curve;
    curve.unit = unit_of(side.branch.unit);
    for (const std::size_t k : order) {
        std::vector<double> values(channels.size(), nan);
        for (const auto& column : columns)
            if (const int c = find_channel(channels, outline.channels[column.channel].name); c >= 0)
                values[static_cast<std::size_t>(c)] = column.values[k];
        append(curve, points.a[k] / unit, std::move(values));
    }
    return curve;
}

}  // namespace

Study study_candidate(const Model& model, const std::string& name,
                      const std::vector<CandidateLevel>& levels, const Progress& progress) {
    Study result;
    for (const auto& level : levels) result.steps.push_back(level.steps);
    const auto refuse = [&](std::string why) {
        result.inconclusive.push_back(fmt::format("{}: {}", name, why));
        return result;
    };
    if (levels.size() < 3 ||
        std::ranges::adjacent_find(result.steps, std::greater_equal<>{}) != result.steps.end())
        return refuse("at least three numbers of steps are needed, positive and increasing");
    for (const auto& level : levels) {
        if (level.points.a.empty()) return refuse("it gives no load or parameter");
        if (level.points.branch.empty() && model.branches.size() > 1)
            return refuse("a column 'branch' is needed, since the scene has several branches");
    }
    const auto channels = motion(model);
    const Comparison outlined = outline(model);
    std::vector<std::size_t> studied;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const auto gives = [&](const CandidateLevel& level) {
            return std::ranges::any_of(level.points.columns, [&](const PointColumn& column) {
                return outlined.channels[column.channel].name == channels[c].name;
            });
        };
        if (channels[c].main && std::ranges::all_of(levels, gives)) {
            studied.push_back(c);
            result.channels.push_back(channels[c]);
        }
    }
    if (studied.empty()) return refuse("it gives no main output");

    for (const auto& branch : model.branches)
        for (const auto& side : sides_with_steps(model, branch, result.steps)) {
            if (progress) progress(fmt::format("{}: references", side.name), nan);
            const References known = references(model, channels, side.branch, {side});
            std::ranges::move(unfit(known, side.name), std::back_inserter(result.inconclusive));
            if (!known.failures.empty()) continue;
            BranchStudy b{studied_branch(side, channels, known.truth.curve), side.steps, {}};
            MethodStudy& study = b.methods.emplace_back();
            study.method = name;
            std::vector<Curve> curves;
            for (std::size_t l = 0; l < levels.size(); ++l) {
                study.constraint_error.push_back(nan);
                curves.push_back(
                    curve_on(model, side, branch.name, channels, outlined, levels[l].points));
                const Trend course = trend(curves.back().a);
                bool finite = course.monotonic();
                for (const auto& values : curves.back().values)
                    for (const std::size_t c : studied) finite = finite && std::isfinite(values[c]);
                study.outcomes.push_back(finite ? Outcome::converged : Outcome::not_finite);
                if (!finite && study.not_studied.empty())
                    study.not_studied = fmt::format(
                        "with {} steps: {}", levels[l].steps,
                        curves.back().a.size() < 2 ? "fewer than two points"
                        : course.monotonic()       ? "a value is not a number"
                                                   : "a load occurs twice, or is not a number");
            }
            if (study.not_studied.empty())
                study_levels(study, channels, studied, {side.steps, curves, known, nan});
            result.branches.push_back(std::move(b));
        }
    return result;
}

}  // namespace elastocheck::compare
