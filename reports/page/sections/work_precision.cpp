// Section: work-precision diagrams of the methods.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/chart.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::TradeRow;

struct CostAxis {
    const char *id, *column;
    double TradeRow::*cost;
    const char *axis, *title;
};
// The error of every method over this measure of cost, without those that are not ranked.
Figure precision(const compare::Trade& trade, std::vector<TradeRow> points,
                 const CostAxis& cost_axis) {
    const auto& [id, column, cost, axis, title] = cost_axis;
    std::erase_if(points, [](const TradeRow& point) { return !point.not_ranked.empty(); });
    Figure figure = figure_of({.id = id,
                               .title = title,
                               .x = column,
                               .y = {"error"},
                               .by = {"method"},
                               .log_x = true,
                               .log_y = true},
                              table_of(points), "worst position error [mm]");
    figure.x = axis;
    figure.height = 1.2;
    add_tolerance(figure, trade.tolerance.mm, "mm");
    std::vector<std::string> names;
    for (const auto& s : figure.series) names.push_back(s.title);
    figure.description = fmt::format("Logarithmic plot of worst position error against {} for {}.",
                                     axis, enumerated(names));
    for (const auto& point : points)
        if (point.recommended && point.*cost > 0 && point.error > 0)
            figure.series.push_back(
                {"recommended", Series::Style::rings, ink, 5, {{point.*cost, point.error}}});
    return figure;
}

}  // namespace

std::optional<Section> price_section(const SceneAnalyses& scene) {
    const auto& trade = scene.trade;
    if (!trade) return std::nullopt;
    Section section{.id = "price", .title = "Cost of accuracy", .part = Part::evidence};
    section.words["points"] = trade->points_per_branch;
    section.words["not_confirmed"] = trade->rejected;
    section.words["reasons"] = trade->inconclusive;
    section.words["not_judged"] = !section.words["reasons"].empty();
    const auto points = trade_rows(*trade);
    const bool times = std::ranges::any_of(
        points, [](const TradeRow& point) { return std::isfinite(point.time_ratio); });
    FigureGroup group;
    group.figures.push_back(
        precision(*trade, points,
                  {"price-solves", "solves", &TradeRow::solves, "linear solves, all branches",
                   "Error against linear solves"}));
    if (times) {
        section.words["times"] = {{"rounds", trade->rounds}, {"noise", percent(trade->noise)}};
        group.figures.push_back(
            precision(*trade, points,
                      {"price-time", "time ratio", &TradeRow::time_ratio,
                       "time, as a ratio to the full solution", "Error against time"}));
    }
    std::erase_if(group.figures, [](const Figure& f) { return f.series.empty(); });
    group.caption =
        "Worst position error over all branches, output points and outputs, at equal parameter.";
    group.table = table_of(points);
    group.table.caption =
        "Work-precision table. A configuration is on the front if no other is as accurate for s: "
        "fewer solves, f: fewer factorisations and evaluations, t: less time";
    group.table.detail = true;
    if (group.figures.empty())
        section.tables.push_back(group.table);
    else
        section.figures.push_back(std::move(group));
    if (const auto& chosen = trade->recommendation) {
        const auto both = [&](const compare::Accuracy& error) {
            return quantity(error.mm, "mm") +
                   (trade->angles ? ", " + quantity(error.deg, "deg") : "");
        };
        section.words["chosen"] = {{"text", configuration(trade->points[chosen->point])},
                                   {"low", both(chosen->low)},
                                   {"high", both(chosen->high)},
                                   {"band_from", chosen->band_from},
                                   {"confirmed", both(chosen->confirmed)},
                                   {"numbers", whole_number(chosen->confirmed_numbers)}};
    }
    return section;
}

}  // namespace elastocheck::reports
