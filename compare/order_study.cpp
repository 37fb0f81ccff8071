#include "compare/order_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "recursive/solve.hpp"
#include "reference/energy/solve.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck::compare {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Accuracy apart(const std::vector<Channel>& channels, const Curve& a, const EquilibriumPath& path_a,
               const Curve& b, const EquilibriumPath& path_b) {
    if (path_a.outcome != Outcome::converged || path_b.outcome != Outcome::converged) return {nan, nan};
    const Reading reading = at_equal_load(a, b);
    if (!reading.not_compared.empty()) return {nan, nan};
    Accuracy worst;
    for (std::size_t c = 0; c < reading.channels.size(); ++c) {
        if (!channels[c].main) continue;
        double& side = channels[c].unit == Unit::deg ? worst.deg : worst.mm;
        const double value = reading.channels[c].compared > 0 ? reading.channels[c].max : nan;
        if (!(value <= side)) side = value;  // a NaN stays
    }
    return worst;
}

}  // namespace

std::vector<BranchOrders> order_study(const Model& model, const OrderOptions& options) {
    const auto all_channels = channels(model);
    std::vector<BranchOrders> result;
    for (const auto& branch : model.branches) {
        BranchOrders orders{.branch = branch.name, .uncertainty = {}, .levels = {}};
        std::vector<double> loads;
        for (int k = 0; k <= options.points; ++k) loads.push_back(branch.to * k / options.points);
        const auto reference = reference::equilibrium::solve(model, branch, loads),
                   other = reference::energy::solve(model, branch, loads);
        const Curve truth = curve(model, branch, reference.points);
        orders.uncertainty = apart(all_channels, truth, reference, curve(model, branch, other.points), other);
        for (const double tolerance : options.tolerances)
            for (const int order : options.orders) {
                if (options.progress)
                    options.progress(fmt::format("{}: order {}, {:.0e} m", branch.name, order, tolerance));
                const auto path = recursive::series::follow(
                    model, branch,
                    {.order = order, .tolerance = tolerance, .expansions = options.expansions});
                const auto points = recursive::series::sample(model, path, branch, options.points);
                OrderLevel level{.order = order,
                                 .tolerance = tolerance,
                                 .outcome = path.outcome,
                                 .expansions = static_cast<int>(path.expansions.size()),
                                 .rejected = path.rejected,
                                 .work = {.solves = path.counts.iterations,
                                          .factorisations = path.counts.factorisations,
                                          .evaluations = path.counts.evaluations},
                                 .nearest = {},
                                 .error = apart(all_channels, truth, reference,
                                                curve(model, branch, points.points), points)};
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
        result.push_back(std::move(orders));
    }
    return result;
}

bool conclusive(const std::vector<BranchOrders>& orders) {
    const auto judged = [](const BranchOrders& branch) {
        return std::ranges::any_of(branch.levels,
                                   [](const OrderLevel& level) { return std::isfinite(level.error.mm); });
    };
    return !orders.empty() && std::ranges::all_of(orders, judged);
}

}  // namespace elastocheck::compare
