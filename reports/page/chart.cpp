#include "reports/page/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "reports/page/common.hpp"
#include "reports/render/render.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

constexpr Colour curve_colours[] = {vermilion, ochre, pink, blue, sky, purple, green, slate};

std::size_t place_of(const Table& table, const std::string& name) {
    const auto column = std::ranges::find(table.columns, name, &compare::Column::name);
    if (column == table.columns.end())
        throw std::out_of_range("table " + table.id + " has no column " + name);
    return static_cast<std::size_t>(column - table.columns.begin());
}

std::string heading_of(const compare::Column& column) {
    return with_unit(column.heading.empty() ? column.name : column.heading, column.unit);
}

bool has_row(const compare::Chart& chart, const std::vector<compare::Cell>& row) {
    const auto* word = std::get_if<std::string>(&row.front());
    return chart.only.empty() || word == nullptr || *word == chart.only;
}

// The rows of the chart in its columns: the abscissa, then chart.y in its order. A text is NaN.
std::vector<std::vector<double>> chart_rows(const compare::Chart& chart, const Table& table) {
    std::vector<std::size_t> places{place_of(table, chart.x)};
    for (const auto& name : chart.y) places.push_back(place_of(table, name));
    std::vector<std::vector<double>> rows;
    for (const auto& row : table.rows) {
        if (!has_row(chart, row)) continue;
        auto& numbers = rows.emplace_back();
        for (const std::size_t place : places) {
            const auto* value = std::get_if<double>(&row[place]);
            numbers.push_back(value != nullptr ? *value : NAN);
        }
    }
    return rows;
}

Figure scatter_of(const compare::Chart& chart, const Table& table) {
    Figure figure{.description = fmt::format("{} over {}.", chart.y.front(), chart.x),
                  .x = heading_of(table.columns[place_of(table, chart.x)]),
                  .y = heading_of(table.columns[place_of(table, chart.y.front())])};
    Series points{.style = Series::Style::points, .colour = blue};
    for (const auto& row : chart_rows(chart, table))
        if (std::isfinite(row[0]) && std::isfinite(row[1])) points.rows.push_back(row);
    figure.series.push_back(std::move(points));
    return figure;
}

std::size_t place_in(const std::vector<std::string>& list, const std::string& word) {
    return static_cast<std::size_t>(std::ranges::find(list, word) - list.begin());
}

// The curves of the table by their order there: those that are drawn as lines, and as rings.
std::pair<std::vector<DrawnCurve>, std::vector<DrawnCurve>> curves_in(const compare::Chart& chart,
                                                                      const Table& table) {
    std::vector<DrawnCurve> drawn, given;
    const std::size_t legend = place_of(table, chart.by[0]), wheel = place_of(table, chart.by[1]);
    const auto numbers = chart_rows(chart, table);
    for (std::size_t r = 0; r < numbers.size(); ++r) {
        const DrawnCurve like{std::get<std::string>(table.rows[r][legend]),
                              std::get<std::string>(table.rows[r][wheel])};
        auto& list = place_in(chart.rings, like.legend) < chart.rings.size() ? given : drawn;
        auto curve = std::ranges::find_if(list, [&](const DrawnCurve& other) {
            return other.legend == like.legend && other.wheel == like.wheel;
        });
        if (curve == list.end()) curve = list.insert(curve, like);
        const bool gap = !std::isfinite(numbers[r][0]) || !std::isfinite(numbers[r][1]);
        curve->rows.push_back(gap ? std::vector<double>{} : numbers[r]);
    }
    return {drawn, given};
}

// One legend entry for each value of by[0] and of by[1], in place of one a curve.
Figure lines_of(const compare::Chart& chart, const Table& table) {
    using enum Series::Style;
    constexpr Colour case_colours[] = {vermilion, blue, green, purple, ochre, pink, slate, sky};
    const auto [drawn, given] = curves_in(chart, table);
    const auto cases = compare::distinct(drawn, &DrawnCurve::legend);
    auto wheels = compare::distinct(drawn, &DrawnCurve::wheel);
    std::erase(wheels, "");
    const bool several = cases.size() > 1, by_wheel = drawn.size() > cases.size();
    const auto colour_of = [&](std::size_t k) { return case_colours[k % std::size(case_colours)]; };
    Figure figure{.x = heading_of(table.columns[place_of(table, chart.x)]),
                  .y = heading_of(table.columns[place_of(table, chart.y.front())])};
    auto& legend = figure.legend;
    for (std::size_t k = 0; several && k < cases.size(); ++k)
        legend.push_back(
            {.title = cases[k], .style = k == 0 ? heavy : line, .colour = colour_of(k)});
    const std::size_t sides = legend.size();
    for (std::size_t w = 0; by_wheel && w < wheels.size(); ++w)
        legend.push_back({.title = wheels[w],
                          .style = w == 0 ? line : dashed,
                          .colour = several ? ink : colour_of(w)});
    for (std::size_t k = 0; k < cases.size(); ++k)
        for (const auto& curve : compare::where(drawn, &DrawnCurve::legend, cases[k])) {
            const std::size_t w = place_in(wheels, curve.wheel);
            const bool of_wheel = w < wheels.size(), second = by_wheel && of_wheel && w > 0;
            Series series{.title = several ? curve.legend : "",
                          .style = several && k == 0 ? heavy : line,
                          .colour = colour_of(several  ? k
                                              : second ? w
                                                       : 0),
                          .rows = curve.rows};
            if (second) series.style = dashed;
            if (several) series.keys.push_back(k);
            if (by_wheel && of_wheel) series.keys.push_back(sides + w);
            if (series.keys.empty()) series.keys = {0};
            if (of_wheel) series.title += (several ? ", " : "") + curve.wheel;
            if (series.title.empty()) series.title = "full solution";
            figure.series.push_back(std::move(series));
        }
    for (const auto& curve : given) {
        const bool first = curve.legend == chart.rings.front();
        Series series{.title = curve.legend,
                      .style = rings,
                      .colour = first ? purple : green,
                      .mark = first ? 5 : 4};
        const auto entry = std::ranges::find(legend, curve.legend, &Series::title);
        series.keys = {static_cast<std::size_t>(entry - legend.begin())};
        if (entry == legend.end() && !legend.empty()) legend.push_back(series);
        series.rows = curve.rows;
        figure.series.push_back(std::move(series));
    }
    return figure;
}

// Bars: rows of (low end of the bar, high end, height). Marks are vertical lines.
Figure bars_of(const compare::Chart& chart, const Table& table) {
    Figure figure{.description = fmt::format("{} of {}.", chart.title, chart.only),
                  .x = chart.axis,
                  .y = chart.y.back()};
    figure.y_low = 0;
    Series bars{.style = Series::Style::bars, .colour = blue},
        limits{.title = "limit", .style = Series::Style::dashed, .colour = vermilion};
    double highest = 0;
    for (const auto& row : chart_rows(chart, table)) {
        bars.rows.push_back({(row[0] + row[1]) / 2, row[2], row[0], row[1], 0, row[2]});
        highest = std::max(highest, row[2]);
    }
    for (const double mark : chart.marks)
        if (std::isfinite(mark))
            limits.rows.insert(limits.rows.end(), {{mark, 0}, {mark, highest}, {}});
    figure.series.push_back(std::move(bars));
    if (!limits.rows.empty()) figure.series.push_back(std::move(limits));
    return figure;
}

// A horizontal bar for each of the largest rows: rows of (NaN, value) or (NaN, value, low and high
// end of its interval).
Figure ranking_of(const compare::Chart& chart, const Table& table) {
    constexpr std::size_t max_bars = 8;
    struct Ranked {
        std::string name;
        std::vector<double> values;
    };
    std::vector<Ranked> ranked;
    const auto numbers = chart_rows(chart, table);
    for (const auto& row : table.rows)
        if (has_row(chart, row))
            ranked.push_back(
                {std::get<std::string>(row[place_of(table, chart.x)]), numbers[ranked.size()]});
    std::ranges::stable_sort(ranked, std::ranges::greater{},
                             [](const Ranked& r) { return std::abs(r.values[1]); });
    ranked.resize(std::min(ranked.size(), max_bars));
    Figure figure{.description = chart.axis + (chart.only.empty() ? "" : " of " + chart.only) + ":",
                  .x = chart.axis};
    Series bars{.style = Series::Style::bars, .colour = blue},
        intervals{.title = "interval of 95 %"};
    for (const auto& [name, values] : ranked) {
        const double value = values[1], place = -1. - static_cast<double>(figure.y_ticks.size());
        figure.description += fmt::format("{} {} {:.2g}", place < -1 ? ";" : "", name, value);
        figure.y_ticks.emplace_back(place, name);
        bars.rows.push_back(
            {value / 2, place, std::min(value, 0.), std::max(value, 0.), place - 0.3, place + 0.3});
        if (values.size() > 2)
            intervals.rows.insert(intervals.rows.end(),
                                  {{values[2], place}, {values[3], place}, {}});
    }
    figure.description += ".";
    figure.y_low = -0.6 - static_cast<double>(ranked.size());
    figure.y_high = -0.4;
    figure.height = 0.45 + 0.08 * static_cast<double>(ranked.size());
    figure.series.push_back(std::move(bars));
    if (!intervals.rows.empty()) figure.series.push_back(std::move(intervals));
    return figure;
}

}  // namespace

Figure figure_of(const compare::Chart& chart, const Table& table, const std::string& y) {
    using enum compare::Chart::Kind;
    if (chart.kind != curves) {
        Figure figure = chart.kind == lines    ? lines_of(chart, table)
                        : chart.kind == points ? scatter_of(chart, table)
                        : chart.kind == bars   ? bars_of(chart, table)
                                               : ranking_of(chart, table);
        figure.id = chart.id;
        figure.title = chart.title;
        return figure;
    }
    const std::size_t x = place_of(table, chart.x);
    Figure figure{.id = chart.id,
                  .title = chart.title,
                  .x = heading_of(table.columns[x]),
                  .y = y.empty() ? heading_of(table.columns[place_of(table, chart.y.front())]) : y,
                  .log_x = chart.log_x,
                  .log_y = chart.log_y};
    for (const auto& name : chart.y) {
        const std::size_t ordinate = place_of(table, name);
        for (const auto& row : table.rows) {
            const auto can_be_drawn = [](const double* number, bool logarithmic) {
                return number != nullptr && std::isfinite(*number) && (!logarithmic || *number > 0);
            };
            const auto *abscissa = std::get_if<double>(&row[x]),
                       *value = std::get_if<double>(&row[ordinate]);
            if (!can_be_drawn(abscissa, chart.log_x) || !can_be_drawn(value, chart.log_y)) continue;
            std::string title = chart.y.size() > 1 ? name : "";
            for (const auto& column : chart.by)
                title += (title.empty() ? "" : ", ") +
                         std::get<std::string>(row[place_of(table, column)]);
            auto curve = std::ranges::find(figure.series, title, &Series::title);
            if (curve == figure.series.end()) {
                const std::size_t n = figure.series.size();
                curve = figure.series.insert(
                    curve, {title, Series::Style::line_points,
                            curve_colours[n % std::size(curve_colours)], static_cast<int>(n)});
            }
            curve->rows.push_back({*abscissa, *value});
        }
    }
    return figure;
}

void add_tolerance(Figure& figure, double tolerance, const std::string& unit, int decades) {
    double low = INFINITY, high = -INFINITY;
    const auto take = [&](double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    };
    if (std::isfinite(tolerance)) take(tolerance);
    for (const auto& series : figure.series)
        for (const auto& row : series.rows) take(row[1]);
    if (!(low <= high)) return;
    figure.y_high = std::pow(10, std::ceil(std::log10(high * 1.2)));
    figure.y_low =
        std::max(std::pow(10, std::floor(std::log10(low))), figure.y_high * std::pow(10, -decades));
    std::erase_if(figure.series, [&](const Series& series) {
        return std::ranges::none_of(series.rows,
                                    [&](const auto& row) { return row[1] > figure.y_low; });
    });
    if (std::isfinite(tolerance))
        figure.bands.push_back({figure.y_low, tolerance, "within " + setting(tolerance, unit)});
}

}  // namespace elastocheck::reports
