#include "reports/page/sections/inputs/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections/inputs/suspension.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

using compare::EffectRow;

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

std::string number_label(const EffectRow& row) {
    std::string path = row.number.substr(0, row.number.find(','));
    const bool several = path.size() < row.number.size();
    if (const auto dot = path.find('.'); dot != path.npos) path.erase(0, dot + 1);
    std::ranges::replace(path, '.', ' ');
    return as_words(path) + (several ? " and others" : "") +
           (row.step == "1 mm" ? "" : fmt::format(" ({})", row.step));
}

namespace {

// Hardpoint and axis (0, 1, 2) of a path such as points.tie_rod_inner.z.
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

// Gradient of a figure by the position of a hardpoint; zero along an axis without an effect.
Position gradient_by(const std::string& point, const KeyFigure& figure) {
    Position gradient{};
    for (const EffectRow& row : figure.effects)
        if (const auto c = coordinate(row.number); c && c->point == point)
            gradient[c->axis] = row.effect;
    return gradient;
}

}  // namespace

std::vector<Gradient> gradients_of(const KeyFigure& figure, const std::vector<EffectRow>& rows) {
    std::vector<Gradient> points;
    for (const EffectRow& row : rows)
        if (const auto c = coordinate(row.number);
            c && std::ranges::none_of(points, [&](auto& p) { return p.first == c->point; }))
            points.emplace_back(c->point, gradient_by(c->point, figure));
    return points;
}

double size_of(const Gradient& gradient) {
    const Position& v = gradient.second;
    return std::hypot(v[0], v[1], v[2]);
}

std::optional<FigureGroup> effect_arrows(const SceneAnalyses& scene, const KeyFigure& figure,
                                         const std::vector<EffectRow>& rows) {
    Suspension suspension = suspension_of(scene);
    suspension.moved.clear();
    std::erase_if(suspension.symbols, [](const auto& symbol) { return symbol.kind == "drive"; });
    const auto points = gradients_of(figure, rows);
    double largest = 0, extent = 0;
    for (const auto& point : points) largest = std::max(largest, size_of(point));
    if (!(largest > 0)) return std::nullopt;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::ranges::minmax(
            suspension.points, {}, [axis](const auto& point) { return point.at[axis]; });
        extent = std::max(extent, high.at[axis] - low.at[axis]);
    }
    constexpr double longest = 0.25, least = 0.02;  // of the extent; of the largest
    for (const auto& point : points) {
        const auto& [name, gradient] = point;
        const auto at = std::ranges::find(suspension.points, name, &Suspension::Point::name);
        if (at == suspension.points.end() || size_of(point) < least * largest) continue;
        const double scale = longest * extent / largest;
        suspension.arrows.push_back(
            {at->at,
             {at->at[0] + scale * gradient[0], at->at[1] + scale * gradient[1],
              at->at[2] + scale * gradient[2]},
             fmt::format("{} {}", as_words(name), number(size_of(point), 2))});
    }
    FigureGroup group;
    const auto along = [=](std::size_t axis) {
        return [=](const Gradient& gradient) {
            return std::abs(gradient.second[axis]) > rounded_effect * largest
                       ? gradient.second[axis]
                       : 0;
        };
    };
    group.table = compare::table<Gradient>(
        {.caption = fmt::format("Effect of 1 mm on {} [{}]", figure.title, figure.unit),
         .detail = true},
        {{"hardpoint", Digits::words,
          [](const Gradient& gradient) { return as_words(gradient.first); }},
         {"x", Digits::deviation, along(0)},
         {"y", Digits::deviation, along(1)},
         {"z", Digits::deviation, along(2)},
         {"along the arrow", Digits::three, size_of}},
        points);
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

}  // namespace elastocheck::reports
