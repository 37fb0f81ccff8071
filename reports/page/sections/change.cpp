// Section: what to change. Effects of the numbers of the scene on the key figures: the largest five
// of each, a map of hardpoints, and arrows on the drawing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/suspension.hpp"
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

// Size of the gradient of each figure by each hardpoint.
Table heat_map(const std::vector<KeyFigure>& figures, const std::vector<EffectRow>& rows) {
    using Gradient = std::pair<std::string, Position>;
    auto points = gradients_of(figures.front(), rows);
    const auto size = [](const KeyFigure& figure, const Gradient& of) {
        const double norm_of = norm(gradient_by(of.first, figure));
        return norm_of > rounding * figure.largest() ? norm_of : 0;
    };
    std::erase_if(points, [&](const Gradient& of) {
        return std::ranges::none_of(figures, [&](const auto& f) { return size(f, of) > 0; });
    });
    std::vector<compare::ColumnOf<Gradient>> columns{
        {"hardpoint", Digits::words, [](const Gradient& of) { return as_words(of.first); }}};
    for (const KeyFigure& figure : figures)
        columns.push_back({figure.title, Digits::shaded,
                           [&](const Gradient& of) { return size(figure, of); }, "", figure.unit});
    Table map = compare::table("", columns, points);
    map.caption =
        "Effect of moving a hardpoint by 1 mm in its most effective direction; shade: share of the "
        "largest of the column";
    return map;
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
    using Gradient = std::pair<std::string, Position>;
    const auto along = [=](std::size_t axis) {
        return [=](const Gradient& of) {
            return std::abs(of.second[axis]) > rounding * largest ? of.second[axis] : 0;
        };
    };
    group.table = compare::table<Gradient>(
        "",
        {{"hardpoint", Digits::words, [](const Gradient& of) { return as_words(of.first); }},
         {"x", Digits::deviation, along(0)},
         {"y", Digits::deviation, along(1)},
         {"z", Digits::deviation, along(2)},
         {"along the arrow", Digits::three, [](const Gradient& of) { return norm(of.second); }}},
        points);
    group.table.caption = fmt::format("Effect of 1 mm on {} [{}]", figure.title, figure.unit);
    group.table.detail = true;
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
    std::vector<std::pair<const KeyFigure*, const EffectRow*>> largest;
    for (const auto& figure : figures)
        for (std::size_t k = 0; k < std::min<std::size_t>(10, figure.effects.size()); ++k)
            if (std::abs(figure.effects[k].effect) > rounding * figure.largest())
                largest.emplace_back(&figure, &figure.effects[k]);
    using L = std::pair<const KeyFigure*, const EffectRow*>;
    charts.table = compare::table<L>(
        "",
        {{"figure", Digits::words, [](const L& l) { return l.first->title; }},
         {"number", Digits::words, [](const L& l) { return l.second->number; }},
         {"for", Digits::words, [](const L& l) { return l.second->step; }},
         {"effect", Digits::deviation, [](const L& l) { return l.second->effect; }},
         {"unit", Digits::words, [](const L& l) { return l.first->unit; }}},
        largest);
    charts.table.caption = "Effects on each figure, the largest ten, for 1 mm or 1 %";
    charts.table.detail = true;
    section.figures.push_back(std::move(charts));
    if (figures.size() > most_columns) figures.resize(most_columns);
    const auto by_a_point = [](const KeyFigure& figure) {
        return std::ranges::any_of(figure.effects, [&](const EffectRow& row) {
            return coordinate(row.number) && std::abs(row.effect) > rounding * figure.largest();
        });
    };
    if (std::ranges::any_of(figures, by_a_point)) section.tables.push_back(heat_map(figures, rows));
    return section;
}

}  // namespace elastocheck::reports
