#include "compare/studies/order_study.hpp"
#include "compare/jobs/jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

constexpr int max_expansions = 2000;

// Distance of the series from the reference, NaN unless it reached the end.
Accuracy distance(const std::vector<Channel>& channels, const References& truth, const Curve& curve,
                  Outcome outcome) {
    if (!truth.failures.empty() || outcome != Outcome::converged) return {nan, nan};
    return distance(channels, truth.truth.curve, curve);
}

OrderLevel level_of(const Solves& solves, const BranchSide& side, const References& truth,
                    double tolerance, int order) {
    const auto path = recursive::series::follow(
        side.model, side.branch,
        {.order = order, .last_order = order, .tolerance = tolerance, .expansions = max_expansions},
        *side.analysis);
    const auto points = recursive::series::sample(side.model, path, side.branch, side.branch.steps);
    const Curve found = curve(solves.model, solves.channels, side.branch, points.points);
    OrderLevel level{.order = order,
                     .tolerance = tolerance,
                     .outcome = path.outcome,
                     .expansions = static_cast<int>(path.expansions.size()),
                     .rejected = path.rejected,
                     .work = {.solves = path.counts.iterations,
                              .factorisations = path.counts.factorisations,
                              .evaluations = path.counts.evaluations},
                     .nearest = {},
                     .error = distance(solves.channels, truth, found, points.outcome)};
    if (!path.expansions.empty()) {
        level.first_reach = path.expansions.front().reach;
        level.nearest = path.expansions.front().singularity;
    }
    for (const auto& expansion : path.expansions) {
        const auto& judged = expansion.certificate;
        level.force = std::max({level.force, judged.force_middle, judged.force_end});
        level.error_end = std::max(level.error_end, judged.error_end);
    }
    return level;
}

}  // namespace

std::vector<BranchOrders> order_study(Solves& solves, const OrderOptions& options) {
    const int multiple = options.points / solves.base;
    std::vector<BranchSide> sides;
    for (const auto& of_branch : solves.sides)
        std::ranges::copy(of_branch, std::back_inserter(sides));
    std::vector<References> truth(sides.size());
    std::vector<BranchOrders> result(sides.size());
    std::vector<Job> references, levels;
    for (std::size_t k = 0; k < sides.size(); ++k)
        references.push_back({fmt::format("{}: references", sides[k].name), [&, k] {
                                  truth[k] = references_on_side(solves, sides[k], multiple);
                              }});
    run_jobs(references, options.threads, part(options.progress, 0, 0.3));
    for (std::size_t k = 0; k < sides.size(); ++k) {
        result[k] = {sides[k].name, truth[k].failures.empty() ? "" : truth[k].failures.front(),
                     truth[k].uncertainty,
                     std::vector<OrderLevel>(options.tolerances.size() * options.orders.size())};
        std::size_t l = 0;
        for (const double tolerance : options.tolerances)
            for (const int order : options.orders)
                levels.push_back(
                    {fmt::format("{}: order {}, {:.0e} m", sides[k].name, order, tolerance),
                     [&, k, tolerance, order, at = l++] {
                         result[k].levels[at] = level_of(solves, at_points(sides[k], multiple),
                                                         truth[k], tolerance, order);
                     }});
    }
    run_jobs(levels, options.threads, part(options.progress, 0.3, 1));
    return result;
}

std::vector<BranchOrders> order_study(const Model& model, const OrderOptions& options) {
    Solves solves(model, options.points);
    return order_study(solves, options);
}

bool conclusive(const std::vector<BranchOrders>& orders) {
    const auto judged = [](const BranchOrders& branch) {
        return std::ranges::any_of(
            branch.levels, [](const OrderLevel& level) { return std::isfinite(level.error.mm); });
    };
    return !orders.empty() && std::ranges::all_of(orders, judged);
}

}  // namespace elastocheck::compare
