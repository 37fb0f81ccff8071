#include "reports/tables/studies/order_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include "reports/tables/render.hpp"

namespace elastocheck::reports {

std::string order_text(const std::vector<compare::OrderRow>& orders) {
    std::string all;
    const auto out = std::back_inserter(all);
    for (const auto& branch : distinct(orders, &compare::OrderRow::branch)) {
        const auto levels = where(orders, &compare::OrderRow::branch, branch);
        const compare::OrderRow &first = levels.front(), &last = levels.back();
        fmt::format_to(
            out, "\nbranch '{}', the series over its order; error to the equilibrium leg", branch);
        if (!first.not_compared.empty())
            fmt::format_to(out, ", which is none: {}\n", first.not_compared);
        else
            fmt::format_to(out, ", references {:.1e} mm, {:.1e} deg apart\n", first.apart,
                           first.angles_apart);
        all += text(levels);
        if (std::isfinite(last.singularity))  // a linear branch has none
            fmt::format_to(
                out,
                "  nearest singularity of the branch as seen from its start: at {:.3g} times its "
                "length, {:.0f}° off the way ahead\n",
                last.singularity, last.its_angle * 180 / std::numbers::pi);
    }
    return all;
}

}  // namespace elastocheck::reports
