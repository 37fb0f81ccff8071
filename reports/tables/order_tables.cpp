#include "reports/tables/order_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include "reports/text/escape.hpp"

namespace elastocheck::reports {

std::string order_table(const std::vector<compare::BranchOrders>& orders) {
    std::string text;
    const auto out = std::back_inserter(text);
    for (const auto& branch : orders) {
        fmt::format_to(
            out,
            "\nbranch '{}', the series over its order; error to the equilibrium leg, references {:.1e} "
            "mm, {:.1e} deg apart\n",
            branch.branch, branch.uncertainty.mm, branch.uncertainty.deg);
        fmt::format_to(out, "  {:>8} {:>6} {:>11} {:>8} {:>8} {:>10} {:>10} {:>10} {:>12}\n", "told [m]",
                       "order", "expansions", "factor.", "solves", "error mm", "error deg", "left N",
                       "1st reach");
        double before = 0;
        for (const auto& level : branch.levels) {
            if (before != 0 && level.tolerance != before) text += "\n";
            before = level.tolerance;
            fmt::format_to(out, "  {:>8.0e} {:>6} {:>11} {:>8} {:>8} ", level.tolerance, level.order,
                           level.expansions, level.work.factorisations, level.work.solves);
            if (level.outcome != Outcome::converged) {
                fmt::format_to(out, "{:>10}\n", name(level.outcome));
                continue;
            }
            fmt::format_to(out, "{:>10.1e} {:>10.1e} {:>10.1e} {:>10.1f} %\n", level.error.mm,
                           level.error.deg, level.force, 100 * level.first_reach);
        }
        // A straight branch has none.
        if (!branch.levels.empty() && std::isfinite(branch.levels.back().nearest.radius)) {
            const auto& nearest = branch.levels.back().nearest;
            fmt::format_to(out,
                           "  nearest singularity of the branch as seen from its start: at {:.3g} times its "
                           "length, {:.0f}° "
                           "off the way ahead\n",
                           nearest.radius, nearest.angle * 180 / std::numbers::pi);
        }
    }
    return text;
}

std::string orders_csv(const std::vector<compare::BranchOrders>& orders) {
    std::string csv =
        "branch,told [m],order,outcome,expansions,rejected,factorisations,solves,error [mm],error [deg],"
        "reference uncertainty [mm],reference uncertainty [deg],residual [N],error at ends [m],first reach,"
        "singularity radius,singularity angle [rad],singularity misfit\n";
    for (const auto& branch : orders)
        for (const auto& l : branch.levels)
            csv += fmt::format(
                "{},{:g},{},{},{},{},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},"
                "{:.17g},{:.17g},{:.17g}\n",
                for_csv(branch.branch), l.tolerance, l.order, name(l.outcome), l.expansions, l.rejected,
                l.work.factorisations, l.work.solves, l.error.mm, l.error.deg, branch.uncertainty.mm,
                branch.uncertainty.deg, l.force, l.error_end, l.first_reach, l.nearest.radius,
                l.nearest.angle, l.nearest.misfit);
    return csv;
}

nlohmann::ordered_json orders_json(const std::vector<compare::BranchOrders>& orders) {
    using json = nlohmann::ordered_json;
    json all = json::array();
    for (const auto& branch : orders) {
        json levels = json::array();
        for (const auto& l : branch.levels)
            levels.push_back({{"told_m", l.tolerance},
                              {"order", l.order},
                              {"outcome", name(l.outcome)},
                              {"expansions", l.expansions},
                              {"rejected", l.rejected},
                              {"factorisations", l.work.factorisations},
                              {"solves", l.work.solves},
                              {"error_mm", l.error.mm},
                              {"error_deg", l.error.deg},
                              {"residual_N", l.force},
                              {"error_at_ends_m", l.error_end},
                              {"first_reach", l.first_reach},
                              {"singularity",
                               {{"radius", l.nearest.radius},
                                {"angle_rad", l.nearest.angle},
                                {"misfit", l.nearest.misfit}}}});
        all.push_back({{"branch", branch.branch},
                       {"uncertainty_mm", branch.uncertainty.mm},
                       {"uncertainty_deg", branch.uncertainty.deg},
                       {"levels", levels}});
    }
    return all;
}

}  // namespace elastocheck::reports
