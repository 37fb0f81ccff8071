#include "reports/page/chart.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "reports/render/render.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

constexpr Colour curve_colours[] = {vermilion, ochre, pink, blue, sky, purple, green, slate};

std::size_t place_of(const Table& table, const std::string& name) {
    const auto of = std::ranges::find(table.columns, name, &compare::Column::name);
    if (of == table.columns.end()) throw std::out_of_range("no column " + name);
    return static_cast<std::size_t>(of - table.columns.begin());
}

std::string heading_of(const compare::Column& column) {
    return with_unit(column.heading.empty() ? column.name : column.heading, column.unit);
}

}  // namespace

Figure figure_of(const compare::Chart& chart, const Table& table, const std::string& y) {
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
            const auto *at = std::get_if<double>(&row[x]),
                       *value = std::get_if<double>(&row[ordinate]);
            if (at == nullptr || value == nullptr || !std::isfinite(*at) ||
                !std::isfinite(*value) || (chart.log_x && !(*at > 0)) ||
                (chart.log_y && !(*value > 0)))
                continue;
            std::string title = chart.y.size() > 1 ? name : "";
            for (const auto& by : chart.by)
                title +=
                    (title.empty() ? "" : ", ") + std::get<std::string>(row[place_of(table, by)]);
            auto of = std::ranges::find(figure.series, title, &Series::title);
            if (of == figure.series.end()) {
                const std::size_t n = figure.series.size();
                of = figure.series.insert(
                    of, {title, Series::Style::line_points,
                         curve_colours[n % std::size(curve_colours)], static_cast<int>(n)});
            }
            of->rows.push_back({*at, *value});
        }
    }
    return figure;
}

void add_tolerance(Figure& figure, double tolerance, const std::string& unit, int decades) {
    double low = INFINITY, high = -INFINITY;
    const auto take = [&](double value) {
        low = std::min(low, value), high = std::max(high, value);
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
