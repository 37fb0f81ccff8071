// What accuracy costs: the ladder of methods as work against error.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reports/page/numbers.hpp"
#include "reports/page/sections/common.hpp"
#include "reports/page/sections/sections.hpp"

namespace elastocheck::reports {
namespace {

constexpr Colour colours[] = {vermilion, ochre, pink, blue, sky, purple, green, slate};

std::string setting_of(const Field& point) {
    if (const auto steps = point.find("steps")) return whole_number(steps->whole());
    if (const auto own = point.find("own_tolerance_m")) return setting(1e3 * own->number(), "mm");
    return "";
}

Figure figure(const Field& trade, const char* id, const char* price, const char* front, const char* axis,
              const char* title) {
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
    const Field points = trade["points"];
    for (const auto& point : points.items()) {
        const double error = point["error"]["mm"].number(), work = point[price].number();
        if (!point["ranked"].truth() || !(error > 0) || !(work > 0) || !std::isfinite(error)) continue;
        const std::string method = point["method"].text();
        Series* series = nullptr;
        for (auto& s : figure.series)
            if (s.title == method) series = &s;
        if (series == nullptr) {
            const auto n = figure.series.size();
            figure.series.push_back(
                {method, Series::Style::line_points, colours[n % std::size(colours)], static_cast<int>(n)});
            series = &figure.series.back();
        }
        series->rows.push_back({work, error});
        low = std::min(low, error), high = std::max(high, error);
        if (point["on_front"][front].truth()) on_front.push_back({work, error});
    }
    std::ranges::sort(on_front);
    pareto.rows = on_front;
    if (!pareto.rows.empty()) figure.series.insert(figure.series.begin(), pareto);
    if (const auto tolerance = trade["tolerance"].find("mm"); tolerance && high >= low) {
        high = std::max(high, tolerance->number());
        low = std::min(low, tolerance->number());
        figure.y_low = std::pow(10, std::floor(std::log10(low)));
        figure.bands.push_back(
            {figure.y_low, tolerance->number(), "within " + setting(tolerance->number(), "mm")});
        figure.y_high = std::pow(10, std::ceil(std::log10(high * 1.2)));
    }
    if (const auto chosen = trade.find("recommendation")) {
        const auto all = points.items();
        const auto at = static_cast<std::size_t>((*chosen)["position"].whole());
        if (at >= all.size()) (*chosen)["position"].fail("no such point");
        const double x = all[at][price].number(), y = all[at]["error"]["mm"].number();
        if (x > 0 && y > 0) figure.series.push_back({"recommended", Series::Style::rings, ink, 5, {{x, y}}});
    }
    std::vector<std::string> names;
    for (const auto& s : figure.series)
        if (!s.title.empty()) names.push_back(s.title);
    figure.description = fmt::format(
        "Logarithmic plot of worst position error against {} for {}. The wide pale line joins those that no "
        "other beats in both.",
        axis, enumerated(names));
    return figure;
}

Table ladder(const Field& trade) {
    Table table{.caption = "The ladder: what each method gives for its work",
                .columns = {},
                .rows = {},
                .folded = true};
    bool times = false, angles = false;
    for (const auto& point : trade["points"].items()) {
        times = times || point.find("time_ratio");
        angles = angles || point["error"].find("deg");
    }
    table.columns = {{"method", true}, {"steps, or its own tolerance"}, {"error [mm]"}};
    if (angles) table.columns.push_back({"error [deg]"});
    for (const char* name : {"solves", "factorisations", "evaluations"}) table.columns.push_back({name});
    if (times) table.columns.push_back({"time [ratio]"});
    table.columns.push_back({"remark", true});
    for (const auto& point : trade["points"].items()) {
        std::vector<std::string> row{point["method"].text(), setting_of(point),
                                     number(point["error"]["mm"].number(), 2)};
        if (angles)
            row.push_back(point["error"].find("deg") ? number(point["error"]["deg"].number(), 2) : "–");
        for (const char* count : {"solves", "factorisations", "evaluations"})
            row.push_back(whole_number(point[count].whole()));
        if (times) row.push_back(number(point["time_ratio"].number(), 2));
        const bool front = point["on_front"][times ? "time" : "factorisations_and_evaluations"].truth();
        row.push_back(front ? "on the front" : point["not_ranked"].text());
        table.rows.push_back(row);
    }
    return table;
}

}  // namespace

std::optional<Section> price_section(const Field& scene) {
    const auto trade = scene.find("trade");
    if (!trade) return std::nullopt;
    Section section{.id = "price", .title = "What accuracy costs"};
    section.words["points"] = (*trade)["output_points"].whole();
    section.words["not_confirmed"] = (*trade)["not_confirmed"].texts();
    section.words["reasons"] = (*trade)["inconclusive"].texts();
    section.words["judged_not"] = !section.words["reasons"].empty();
    bool times = false;
    for (const auto& point : (*trade)["points"].items()) times = times || point.find("time_ratio");
    FigureGroup group;
    group.figures.push_back(figure(*trade, "price-solves", "solves", "solves", "linear solves, all branches",
                                   "Error against linear solves"));
    if (times) {
        section.words["times"] = {{"rounds", (*trade)["rounds"].whole()},
                                  {"noise", percent((*trade)["time_noise"].number())}};
        group.figures.push_back(figure(*trade, "price-time", "time_ratio", "time",
                                       "time, as a ratio to the equilibrium leg", "Error against time"));
    }
    std::erase_if(group.figures, [](const Figure& f) { return f.series.empty(); });
    group.caption = "Worst position error over all branches, output points and outputs, at equal parameter.";
    group.table = ladder(*trade);
    if (group.figures.empty())
        section.tables.push_back(group.table);
    else
        section.figures.push_back(std::move(group));
    if (const auto chosen = trade->find("recommendation")) {
        const auto both = [](const Field& f) {
            std::string text = quantity(f["mm"].number(), "mm");
            if (const auto deg = f.find("deg")) text += ", " + quantity(deg->number(), "deg");
            return text;
        };
        section.words["chosen"] = {{"text", configuration(*chosen)},
                                   {"low", both((*chosen)["low"])},
                                   {"high", both((*chosen)["high"])},
                                   {"band_from", (*chosen)["band_from"].text()},
                                   {"confirmed", both((*chosen)["confirmed_error"])},
                                   {"numbers", whole_number((*chosen)["confirmed_numbers"].whole())}};
    }
    return section;
}

}  // namespace elastocheck::reports
