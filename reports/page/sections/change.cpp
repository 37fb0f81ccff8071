// Section: what to change. Effects of the numbers of the scene on the key figures: the largest five
// of each, a map of hardpoints, and arrows on the drawing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/suspension.hpp"
#include "reports/text/labels.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::EffectRow;

constexpr std::size_t most_bars = 5, most_charts = 6, most_columns = 8;
constexpr double rounding = 1e-9;  // of the largest effect on a figure

// An output at one place, and the effects of the numbers on it.
struct KeyFigure {
    std::string title, unit;
    std::vector<EffectRow> effects{};  // finite, the largest first

    double largest() const { return effects.empty() ? 0 : std::abs(effects.front().effect); }
};

std::vector<KeyFigure> key_figures(const std::vector<EffectRow>& rows) {
    std::vector<KeyFigure> figures;
    for (const EffectRow& row : rows) {
        std::string title = as_words(row.output);
        std::ranges::replace(title, '.', ' ');
        if (row.at != 0)
            title += fmt::format(" at {} {}", short_number(row.at), row.parameter_unit);
        auto known = std::ranges::find(figures, title, &KeyFigure::title);
        if (known == figures.end())
            known = figures.insert(figures.end(), KeyFigure{title, row.unit});
        if (std::isfinite(row.effect)) known->effects.push_back(row);
    }
    for (auto& figure : figures)
        std::ranges::stable_sort(figure.effects, std::ranges::greater{},
                                 [](const EffectRow& row) { return std::abs(row.effect); });
    std::erase_if(figures, [](const KeyFigure& figure) { return !(figure.largest() > 0); });
    return figures;
}

// "tie rod inner z", "coil rate (1 %)" of a path in the scene file.
std::string number_label(const EffectRow& row) {
    std::string path = row.number.substr(0, row.number.find(','));
    const bool several = path.size() < row.number.size();
    if (const auto dot = path.find('.'); dot != path.npos) path.erase(0, dot + 1);
    std::ranges::replace(path, '.', ' ');
    return as_words(path) + (several ? " and others" : "") +
           (row.step == "1 mm" ? "" : fmt::format(" ({})", row.step));
}

// The coordinate of a hardpoint that a path is: its name and axis (0, 1, 2).
struct Coordinate {
    std::string point;
    std::size_t axis = 0;
};
std::optional<Coordinate> coordinate(const std::string& path) {
    constexpr std::string_view group = "points.";
    if (!path.starts_with(group) || path.size() < group.size() + 3 || path[path.size() - 2] != '.')
        return std::nullopt;
    const char axis = path.back();
    if (axis < 'x' || axis > 'z') return std::nullopt;
    return Coordinate{path.substr(group.size(), path.size() - group.size() - 2),
                      static_cast<std::size_t>(axis - 'x')};
}

// Gradient of a figure by the position of a hardpoint, per 1 mm; zero where there is none.
Position gradient_by(const std::string& point, const KeyFigure& figure) {
    Position gradient{};
    for (const EffectRow& row : figure.effects)
        if (const auto c = coordinate(row.number); c && c->point == point)
            gradient[c->axis] = row.effect;
    return gradient;
}

// The hardpoints in the order of the file, with the gradient of a figure by each.
std::vector<std::pair<std::string, Position>> gradients_of(const KeyFigure& figure,
                                                           const std::vector<EffectRow>& rows) {
    std::vector<std::pair<std::string, Position>> points;
    for (const EffectRow& row : rows)
        if (const auto c = coordinate(row.number);
            c && std::ranges::none_of(points, [&](auto& p) { return p.first == c->point; }))
            points.emplace_back(c->point, gradient_by(c->point, figure));
    return points;
}

double norm(const Position& v) { return std::hypot(v[0], v[1], v[2]); }

// The five numbers with the largest effects as bars.
Figure tornado(const KeyFigure& of) {
    Figure figure{.id = fmt::format("change-{}", slug(of.title)),
                  .title = of.title,
                  .description = fmt::format("The largest effects on {}:", of.title),
                  .x = fmt::format("change of {} [{}]", of.title, of.unit),
                  .y = ""};
    Series bars{.style = Series::Style::bars, .colour = blue};
    double row = 0;
    for (const EffectRow& effect : of.effects) {
        if (row <= -static_cast<double>(most_bars) ||
            std::abs(effect.effect) <= rounding * of.largest())
            break;
        --row;
        const std::string label = number_label(effect);
        figure.y_ticks.emplace_back(row, label);
        bars.rows.push_back({effect.effect / 2, row, std::min(0.0, effect.effect),
                             std::max(0.0, effect.effect), row - 0.3, row + 0.3});
        figure.description +=
            fmt::format(" {} {} {};", label, signed_number(effect.effect, 2), of.unit);
    }
    figure.description.back() = '.';
    figure.series.push_back(std::move(bars));
    figure.y_low = row - 0.6;
    figure.y_high = -0.4;
    figure.height = 0.45 + 0.08 * -row;
    return figure;
}

// A title in lines that fit the width.
std::vector<std::string> wrapped(const std::string& text, double most) {
    std::vector<std::string> lines{""};
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t end = std::min(text.find(' ', from), text.size());
        const std::string word = text.substr(from, end - from);
        const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
        if (lines.back().empty() || text_width(longer, 10) <= most)
            lines.back() = longer;
        else
            lines.push_back(word);
        from = end + 1;
    }
    return lines;
}

// Size of the gradient of each figure by each hardpoint; shade: share of the figure's largest.
FigureGroup heat_map(const std::vector<KeyFigure>& figures, const std::vector<EffectRow>& rows) {
    constexpr double names = 118, cell = 64, line = 17, word = 12;  // [px]
    auto points = gradients_of(figures.front(), rows);
    std::erase_if(points, [&](const auto& point) {
        return std::ranges::none_of(figures, [&](const KeyFigure& figure) {
            return norm(gradient_by(point.first, figure)) > rounding * figure.largest();
        });
    });
    std::size_t heading = 0;
    for (const auto& figure : figures)
        heading = std::max(heading, wrapped(figure.title, cell - 4).size() + 1);
    const double bottom = 4, top = bottom + line * static_cast<double>(points.size());
    Figure map{.id = "change-map",
               .title = "Effect of moving a hardpoint by 1 mm in its most effective direction",
               .description = "Of each figure by each hardpoint; the numbers are in the table."};
    map.sheet = Sheet{.width = static_cast<int>(names + cell * static_cast<double>(figures.size())),
                      .height = static_cast<int>(top + 8 + word * static_cast<double>(heading))};
    Table table{.caption = "Effect of 1 mm in the most effective direction",
                .columns = {{"hardpoint", true}}};
    for (std::size_t p = 0; p < points.size(); ++p) {
        const std::string name = as_words(points[p].first);
        map.words.push_back({2, top - line * (static_cast<double>(p) + 0.5), name, ink});
        table.rows.push_back({name});
    }
    for (std::size_t f = 0; f < figures.size(); ++f) {
        const double left = names + cell * static_cast<double>(f);
        auto title = wrapped(figures[f].title, cell - 4);
        title.push_back("[" + figures[f].unit + "]");
        for (std::size_t k = 0; k < title.size(); ++k)
            map.words.push_back({left + 2,
                                 top + 8 + word * (static_cast<double>(title.size() - k) - 0.5),
                                 title[k], slate});
        table.columns.push_back({fmt::format("{} [{}]", figures[f].title, figures[f].unit)});
        std::vector<double> sizes;
        for (const auto& [name, gradient] : points)
            sizes.push_back(norm(gradient_by(name, figures[f])));
        const double largest = std::ranges::max(sizes);
        for (std::size_t p = 0; p < points.size(); ++p) {
            const double size = sizes[p];
            const double high = top - line * static_cast<double>(p), low = high - line;
            table.rows[p].push_back(size > rounding * largest ? number(size) : "0");
            if (!(size > rounding * largest)) continue;
            map.series.push_back({.style = Series::Style::face,
                                  .colour = vermilion,
                                  .rows = {{left, low},
                                           {left + cell - 2, low},
                                           {left + cell - 2, high - 2},
                                           {left, high - 2}},
                                  .opacity = 0.6 * size / largest});
            if (size >= 0.01 * largest)
                map.words.push_back({left + 4, low + line / 2 - 1, number(size, 2), ink});
        }
    }
    FigureGroup group{"Hardpoints against figures; shade: share of the largest of the column.",
                      {},
                      std::move(table)};
    group.figures.push_back(std::move(map));
    return group;
}

// The suspension with an arrow at each hardpoint in the direction in which the figure grows most.
std::optional<FigureGroup> arrows(const SceneAnalyses& scene, const KeyFigure& figure,
                                  const std::vector<EffectRow>& rows) {
    Suspension suspension = suspension_of(scene);
    suspension.moved.clear();
    std::erase_if(suspension.symbols, [](const auto& symbol) { return symbol.kind == "drive"; });
    const auto points = gradients_of(figure, rows);
    double largest = 0, extent = 0;
    for (const auto& [name, gradient] : points) largest = std::max(largest, norm(gradient));
    if (!(largest > 0)) return std::nullopt;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::ranges::minmax(
            suspension.points, {}, [axis](const auto& point) { return point.at[axis]; });
        extent = std::max(extent, high.at[axis] - low.at[axis]);
    }
    constexpr double longest = 0.25, least = 0.02;  // of the extent; of the largest
    for (const auto& [name, gradient] : points) {
        const auto at = std::ranges::find(suspension.points, name, &Suspension::Point::name);
        if (at == suspension.points.end() || norm(gradient) < least * largest) continue;
        const double scale = longest * extent / largest;
        suspension.arrows.push_back(
            {at->at,
             {at->at[0] + scale * gradient[0], at->at[1] + scale * gradient[1],
              at->at[2] + scale * gradient[2]},
             fmt::format("{} {}", as_words(name), number(norm(gradient), 2))});
    }
    FigureGroup group;
    group.table = {.caption = fmt::format("Effect of 1 mm on {} [{}]", figure.title, figure.unit),
                   .columns = {{"hardpoint", true}, {"x"}, {"y"}, {"z"}, {"along the arrow"}}};
    for (const auto& [name, gradient] : points) {
        std::vector<std::string> row{as_words(name)};
        for (const double v : gradient)
            row.push_back(std::abs(v) > rounding * largest ? signed_number(v) : "0");
        row.push_back(number(norm(gradient)));
        group.table.rows.push_back(std::move(row));
    }
    const std::vector<View> views{front_view, side_view, top_view};
    group.figures = draw_views(suspension, views, small_frame(suspension));
    for (std::size_t k = 0; k < views.size(); ++k) {
        group.figures[k].id = fmt::format("change-{}", views[k].id);
        group.figures[k].description =
            fmt::format("Arrows at the hardpoints, {}: the direction in which {} grows most.",
                        views[k].from, figure.title);
    }
    group.caption = fmt::format(
        "Arrows: a hardpoint moved by 1 mm along its arrow increases {} by the number [{}], moved "
        "against it decreases it. Effects below 2 % of the largest have none.",
        figure.title, figure.unit);
    return group;
}

}  // namespace

std::optional<Section> change_section(const SceneAnalyses& scene) {
    if (!scene.effects) return std::nullopt;
    const auto& [rows, reasons, compared, apart] = *scene.effects;
    auto figures = key_figures(rows);
    if (figures.empty()) return std::nullopt;
    Section section{.id = "change",
                    .title = "Effects of the numbers of the scene",
                    .part = Part::change,
                    .mark = reasons.empty() ? Mark::none : Mark::open};
    section.words = {{"conclusive", reasons.empty()},      {"reasons", reasons},
                     {"compared", whole_number(compared)}, {"apart", number(apart, 2)},
                     {"trim", scene.trim.has_value()},     {"branch", rows.front().branch}};
    if (auto group = arrows(scene, figures.front(), rows))
        section.figures.push_back(std::move(*group));
    FigureGroup charts;
    for (const auto& figure : figures)
        if (charts.figures.size() < most_charts) charts.figures.push_back(tornado(figure));
    charts.caption = "The five numbers with the largest effect on each figure, for 1 mm or 1 %.";
    charts.table = {
        .caption = "Effects on each figure, the largest ten, for 1 mm or 1 %",
        .columns = {{"figure", true}, {"number", true}, {"for"}, {"effect"}, {"unit", true}}};
    for (const auto& figure : figures)
        for (std::size_t k = 0; k < std::min<std::size_t>(10, figure.effects.size()); ++k) {
            const EffectRow& row = figure.effects[k];
            if (std::abs(row.effect) <= rounding * figure.largest()) break;
            charts.table.rows.push_back(
                {figure.title, row.number, row.step, signed_number(row.effect), figure.unit});
        }
    section.figures.push_back(std::move(charts));
    if (figures.size() > most_columns) figures.resize(most_columns);
    const auto by_a_point = [](const KeyFigure& figure) {
        return std::ranges::any_of(figure.effects, [&](const EffectRow& row) {
            return coordinate(row.number) && std::abs(row.effect) > rounding * figure.largest();
        });
    };
    if (std::ranges::any_of(figures, by_a_point))
        section.figures.push_back(heat_map(figures, rows));
    return section;
}

}  // namespace elastocheck::reports
