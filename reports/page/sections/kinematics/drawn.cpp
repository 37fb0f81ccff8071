// Colours, legend and numbers of the curves of a figure of part 1.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "reports/page/sections/kinematics/figures.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using Rows = std::vector<std::vector<double>>;

// Whether two curves coincide point by point.
bool coincide(const Rows& a, const Rows& b) {
    double size = 0;
    for (const auto& row : a)
        for (const double v : row) size = std::max(size, std::abs(v));
    return std::ranges::equal(a, b, [&](const auto& one, const auto& other) {
        return std::ranges::equal(
            one, other, [&](double v, double w) { return std::abs(v - w) <= 1e-6 * size; });
    });
}

constexpr Colour case_colours[] = {vermilion, blue, green, purple, ochre, pink, slate, sky};

// Up to seven points of every curve.
Table numbers_of(const Figure& figure) {
    constexpr std::size_t most = 7;
    Table table{.rows = std::vector<std::vector<compare::Cell>>(most),
                .caption = fmt::format("{} over {}", figure.y, figure.x),
                .detail = true};
    for (const auto& series : figure.series) {
        Rows rows = series.rows;
        std::erase_if(rows, [](const auto& row) { return row.empty(); });
        const auto kept = thinned(rows.size(), most);
        table.columns.push_back({.name = series.title + ": " + figure.x, .digits = Digits::place});
        table.columns.push_back({.name = figure.y, .digits = Digits::four});
        for (std::size_t k = 0; k < most; ++k)
            for (std::size_t j = 0; j < 2; ++j)
                table.rows[k].emplace_back(k < kept.size() ? rows[kept[k]][j] : compare::nan);
    }
    std::erase_if(table.rows, [](const auto& row) {
        return std::ranges::all_of(row,
                                   [](const auto& c) { return std::isnan(std::get<double>(c)); });
    });
    return table;
}

}  // namespace

void Bundle::add(const std::string& whose, Rows rows) {
    const Rows reversed(rows.rbegin(), rows.rend());  // as of two wheels in roll
    if (!rows.empty() && std::ranges::none_of(lines, [&](const Line& line) {
            return coincide(line.rows, rows) || coincide(line.rows, reversed);
        }))
        lines.push_back({whose, std::move(rows)});
}

FigureGroup drawn(Figure figure, std::vector<Bundle> bundles, const std::vector<Wheel>& wheels,
                  std::string caption) {
    const bool several = bundles.size() > 1;
    const bool by_wheel =
        wheels.size() > 1 &&
        std::ranges::any_of(bundles, [](const Bundle& bundle) { return bundle.lines.size() > 1; });
    using enum Series::Style;
    const auto entry = [&](const std::string& title, Series::Style style, Colour colour) {
        figure.legend.push_back({.title = title, .style = style, .colour = colour});
    };
    // An entry for each bundle and each wheel instead of one for each curve.
    for (std::size_t k = 0; several && k < bundles.size(); ++k)
        entry(bundles[k].title, k == 0 ? heavy : line, case_colours[k % std::size(case_colours)]);
    const std::size_t sides = figure.legend.size();
    if (by_wheel) {
        entry(wheels[0].name, line, several ? ink : vermilion);
        entry(wheels[1].name, dashed, several ? ink : blue);
    }
    for (std::size_t k = 0; k < bundles.size(); ++k)
        for (std::size_t j = 0; j < bundles[k].lines.size(); ++j) {
            const auto& [whose, rows] = bundles[k].lines[j];
            std::vector<std::size_t> keys;
            if (several) keys.push_back(k);
            if (by_wheel && !whose.empty()) keys.push_back(sides + std::min<std::size_t>(j, 1));
            figure.series.push_back({.title = several && !whose.empty()
                                                  ? bundles[k].title + ", " + whose
                                              : several       ? bundles[k].title
                                              : whose.empty() ? "full solution"
                                                              : whose,
                                     .style = j > 0               ? dashed
                                              : several && k == 0 ? heavy
                                                                  : line,
                                     .colour = several  ? case_colours[k % std::size(case_colours)]
                                               : j == 0 ? vermilion
                                                        : blue,
                                     .rows = rows,
                                     .keys = keys.empty() ? std::vector<std::size_t>{0} : keys});
        }
    for (auto& bundle : bundles)
        for (auto& series : bundle.others) {
            const auto known = std::ranges::find(figure.legend, series.title, &Series::title);
            series.keys = {static_cast<std::size_t>(known - figure.legend.begin())};
            if (known == figure.legend.end() && !figure.legend.empty()) {
                entry(series.title, series.style, series.colour);
                figure.legend.back().mark = series.mark;
            }
            figure.series.push_back(std::move(series));
        }
    if (!caption.empty()) caption[0] = static_cast<char>(std::toupper(caption[0]));
    Table table = numbers_of(figure);
    return {std::move(caption), {std::move(figure)}, std::move(table)};
}

}  // namespace elastocheck::reports
