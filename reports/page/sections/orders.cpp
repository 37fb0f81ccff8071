// Section: the branch as a power series, with order, tolerance, reach and error.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "compare/tables/rows.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

constexpr Colour order_colours[] = {vermilion, blue, green, purple};

FigureGroup group(const std::string& branch, const std::vector<compare::OrderRow>& levels) {
    FigureGroup group;
    group.caption = fmt::format("Number of expansions of branch {} over their order.", branch);
    group.table = page_table(
        fmt::format("Series over branch {}; error to the full solution", branch), levels);
    group.table.folded = true;
    Figure figure{.id = fmt::format("orders-{}", slug(branch)),
                  .title = branch,
                  .description = {},
                  .x = "order",
                  .y = "expansions",
                  .log_y = true};
    std::map<double, std::vector<std::vector<double>>, std::greater<>> by_tolerance;
    for (const auto& level : levels)
        if (std::isfinite(level.tolerance) && level.outcome == "converged")
            by_tolerance[level.tolerance].push_back({level.order, level.expansions});
    std::vector<std::string> listed;
    for (const auto& [tolerance, rows] : by_tolerance) {
        const std::size_t k = figure.series.size();
        figure.series.push_back(
            {fmt::format("tolerance {} mm", number(tolerance, 1)), Series::Style::line_points,
             order_colours[k % std::size(order_colours)], static_cast<int>(4 + k), rows});
        listed.push_back(fmt::format(
            "tolerance {} mm, {} expansions at order {} and {} at order {}", number(tolerance, 1),
            number(rows.front()[1], 3), number(rows.front()[0], 2), number(rows.back()[1], 3),
            number(rows.back()[0], 2)));
    }
    if (figure.series.empty()) return group;
    figure.description =
        "Logarithmic plot of the number of expansions over their order: " + enumerated(listed) +
        ".";
    group.figures.push_back(std::move(figure));
    return group;
}

}  // namespace

std::optional<Section> orders_section(const JsonCursor& scene) {
    const auto orders = scene.find("orders");
    if (!orders) return std::nullopt;
    Section section{.id = "orders",
                    .title = "Series method: the branch as power series",
                    .part = Part::evidence};
    auto& nearest = section.words["nearest"] = nlohmann::ordered_json::array();
    const auto all = read_rows<compare::OrderRow>(*orders);
    for (const auto& branch : distinct(all, &compare::OrderRow::branch)) {
        if (!leads(scene, branch)) continue;
        const auto levels = where(all, &compare::OrderRow::branch, branch);
        section.figures.push_back(group(branch, levels));
        if (const auto& last = levels.back(); std::isfinite(last.singularity))
            nearest.push_back({{"branch", branch},
                               {"radius", number(last.singularity, 3)},
                               {"degrees", number(last.its_angle * 180 / std::numbers::pi, 2)}});
    }
    return section;
}

}  // namespace elastocheck::reports
