#include "reports/tables/studies/order_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include "reports/tables/select.hpp"

namespace elastocheck::reports {

const std::vector<ShownColumn> order_columns{{"told", Digits::given},
                                             {"order"},
                                             {"outcome"},
                                             {"expansions"},
                                             {"factorisations"},
                                             {"solves"},
                                             {"error", Digits::size},
                                             {"angle error", Digits::size, "error"},
                                             {"residual", Digits::size},
                                             {"first reach", Digits::percent}};

std::string order_text(const compare::Table& orders) {
    std::string all;
    const auto out = std::back_inserter(all);
    for (const auto& branch : distinct(orders, "branch")) {
        const auto levels = where(orders, "branch", branch);
        fmt::format_to(
            out, "\nbranch '{}', the series over its order; error to the equilibrium leg", branch);
        if (const auto& why = words(levels, 0, "not compared"); !why.empty())
            fmt::format_to(out, ", which is none: {}\n", why);
        else
            fmt::format_to(out, ", references {:.1e} mm, {:.1e} deg apart\n",
                           number(levels, 0, "references apart"),
                           number(levels, 0, "references' angles apart"));
        all += text(levels, order_columns);
        // A linear branch has no singularity.
        const std::size_t last = levels.rows.size() - 1;
        if (const double radius = number(levels, last, "singularity"); std::isfinite(radius))
            fmt::format_to(
                out,
                "  nearest singularity of the branch as seen from its start: at {:.3g} times its "
                "length, {:.0f}° off the way ahead\n",
                radius, number(levels, last, "its angle") * 180 / std::numbers::pi);
    }
    return all;
}

}  // namespace elastocheck::reports
