// Section: work-precision diagrams of the methods.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

constexpr Colour method_colours[] = {vermilion, ochre, pink, blue, sky, purple, green, slate};

using compare::TradeRow;

Figure figure(const compare::Trade& trade, const std::vector<TradeRow>& points, const char* id,
              double TradeRow::*price, char front, const char* axis, const char* title) {
    Figure figure{.id = id,
                  .title = title,
                  .x = axis,
                  .y = "worst position error [mm]",
                  .log_x = true,
                  .log_y = true,
                  .height = 1.2};
    Series pareto{"", Series::Style::wide, faint};
    std::vector<std::vector<double>> on_front;
    double low = 1, high = 1e-16;
    for (const auto& point : points) {
        const double error = point.error, work = point.*price;
        if (!point.not_ranked.empty() || !(error > 0) || !(work > 0) || !std::isfinite(error))
            continue;
        const std::string& method = point.method;
        Series* series = nullptr;
        for (auto& s : figure.series)
            if (s.title == method) series = &s;
        if (series == nullptr) {
            const auto n = figure.series.size();
            figure.series.push_back({method, Series::Style::line_points,
                                     method_colours[n % std::size(method_colours)],
                                     static_cast<int>(n)});
            series = &figure.series.back();
        }
        series->rows.push_back({work, error});
        low = std::min(low, error), high = std::max(high, error);
        if (point.front.find(front) != std::string::npos) on_front.push_back({work, error});
    }
    std::ranges::sort(on_front);
    pareto.rows = on_front;
    if (!pareto.rows.empty()) figure.series.insert(figure.series.begin(), pareto);
    if (const double tolerance = trade.tolerance.mm; std::isfinite(tolerance) && high >= low) {
        high = std::max(high, tolerance);
        low = std::min(low, tolerance);
        figure.y_low = std::pow(10, std::floor(std::log10(low)));
        figure.bands.push_back({figure.y_low, tolerance, "within " + setting(tolerance, "mm")});
        figure.y_high = std::pow(10, std::ceil(std::log10(high * 1.2)));
    }
    if (trade.recommendation) {
        const TradeRow& chosen = points[trade.recommendation->point];
        const double x = chosen.*price, y = chosen.error;
        if (x > 0 && y > 0)
            figure.series.push_back({"recommended", Series::Style::rings, ink, 5, {{x, y}}});
    }
    std::vector<std::string> names;
    for (const auto& s : figure.series)
        if (!s.title.empty()) names.push_back(s.title);
    figure.description = fmt::format(
        "Logarithmic plot of worst position error against {} for {}. The wide pale line is the "
        "Pareto front.",
        axis, enumerated(names));
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
    section.words["judged_not"] = !section.words["reasons"].empty();
    const auto points = trade_rows(*trade);
    const bool times = std::ranges::any_of(
        points, [](const TradeRow& point) { return std::isfinite(point.time_ratio); });
    FigureGroup group;
    group.figures.push_back(figure(*trade, points, "price-solves", &TradeRow::solves, 's',
                                   "linear solves, all branches", "Error against linear solves"));
    if (times) {
        section.words["times"] = {{"rounds", trade->rounds}, {"noise", percent(trade->noise)}};
        group.figures.push_back(figure(*trade, points, "price-time", &TradeRow::time_ratio, 't',
                                       "time, as a ratio to the full solution",
                                       "Error against time"));
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
