#include "compare/studies/order_study.hpp"
#include "compare/comparison/legs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

// NaN unless the series reached the end.
Accuracy apart(const std::vector<Channel>& channels, const References& truth, const Curve& curve,
               Outcome outcome) {
    if (!truth.failures.empty() || outcome != Outcome::converged) return {nan, nan};
    return distance(channels, truth.truth, curve);
}

BranchOrders study_way(const Model& model, const std::vector<Channel>& channels,
                       const BranchSide& way, const OrderOptions& options) {
    const References truth = references(model, channels, way.branch, {way});
    BranchOrders orders{
        way.name, truth.failures.empty() ? "" : truth.failures.front(), truth.uncertainty, {}};
    for (const double tolerance : options.tolerances)
        for (const int order : options.orders) {
            if (options.progress)
                options.progress(
                    fmt::format("{}: order {}, {:.0e} mm", way.name, order, 1e3 * tolerance));
            const auto path = recursive::series::follow(
                way.model, way.branch,
                {.order = order, .tolerance = tolerance, .expansions = options.expansions});
            const auto points =
                recursive::series::sample(way.model, path, way.branch, way.branch.steps);
            const Curve found = curve(model, channels, way.branch, points.points);
            OrderLevel level{.order = order,
                             .tolerance = tolerance,
                             .outcome = path.outcome,
                             .expansions = static_cast<int>(path.expansions.size()),
                             .rejected = path.rejected,
                             .work = {.solves = path.counts.iterations,
                                      .factorisations = path.counts.factorisations,
                                      .evaluations = path.counts.evaluations},
                             .nearest = {},
                             .error = apart(channels, truth, found, points.outcome)};
            if (!path.expansions.empty()) {
                level.first_reach = path.expansions.front().reach;
                level.nearest = path.expansions.front().singularity;
            }
            for (const auto& expansion : path.expansions) {
                const auto& judged = expansion.certificate;
                level.force = std::max({level.force, judged.force_middle, judged.force_end});
                level.error_end = std::max(level.error_end, judged.error_end);
            }
            orders.levels.push_back(level);
        }
    return orders;
}

}  // namespace

std::vector<BranchOrders> order_study(const Model& model, const OrderOptions& options) {
    const auto all = channels(model);
    std::vector<BranchOrders> result;
    for (const auto& branch : model.branches)
        for (const auto& way : sides_of(model, branch, options.points))
            result.push_back(study_way(model, all, way, options));
    return result;
}

bool conclusive(const std::vector<BranchOrders>& orders) {
    const auto judged = [](const BranchOrders& branch) {
        return std::ranges::any_of(
            branch.levels, [](const OrderLevel& level) { return std::isfinite(level.error.mm); });
    };
    return !orders.empty() && std::ranges::all_of(orders, judged);
}

}  // namespace elastocheck::compare
