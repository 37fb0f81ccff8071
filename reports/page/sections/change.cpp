// Section: what to change. Effects of the numbers of the scene on the key figures: the largest five
// of each, a map of hardpoints, and arrows on the drawing.
#include <fmt/format.h>

#include <algorithm>

#include "reports/page/chart.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/effects.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::EffectRow;

constexpr std::size_t max_bars = 5, max_charts = 6, max_columns = 8;

// The five numbers with the largest effects as bars.
Figure tornado(const KeyFigure& key) {
    auto largest = key.effects;
    std::erase_if(largest, [&](const EffectRow& row) { return !key.counts(row.effect); });
    largest.resize(std::min(largest.size(), max_bars));
    return figure_of({.id = fmt::format("change-{}", slug(key.title)),
                      .title = key.title,
                      .x = "number",
                      .y = {"effect"},
                      .kind = compare::Chart::Kind::ranked,
                      .axis = fmt::format("change of {} [{}]", key.title, key.unit)},
                     compare::table<EffectRow>({},
                                               {{"number", Digits::words, number_label},
                                                {"effect", Digits::deviation, &EffectRow::effect}},
                                               largest));
}

// Size of the gradient of each figure by each hardpoint; empty where none has an effect.
Table heat_map(const std::vector<KeyFigure>& figures, const std::vector<EffectRow>& rows) {
    std::vector<std::vector<double>> sizes;  // by figure and hardpoint
    const auto points = gradients_of(figures.front(), rows);
    std::vector<std::size_t> moving;
    for (const KeyFigure& figure : figures) {
        auto& of_figure = sizes.emplace_back();
        for (const auto& gradient : gradients_of(figure, rows))
            of_figure.push_back(figure.counts(size_of(gradient)) ? size_of(gradient) : 0);
    }
    for (std::size_t k = 0; k < points.size(); ++k)
        if (std::ranges::any_of(sizes, [&](const auto& of_figure) { return of_figure[k] > 0; }))
            moving.push_back(k);
    using K = std::size_t;
    std::vector<compare::ColumnOf<K>> columns{
        {"hardpoint", Digits::words, [&](K k) { return as_words(points[k].first); }}};
    for (K f = 0; f < figures.size(); ++f)
        columns.push_back({figures[f].title, Digits::shaded, [&, f](K k) { return sizes[f][k]; },
                           "", figures[f].unit});
    Table map = compare::table({.caption = "Effect of moving a hardpoint by 1 mm in its most "
                                           "effective direction; shade: share of the "
                                           "largest of the column"},
                               columns, moving);
    return map;
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
    if (auto group = effect_arrows(scene, figures.front(), rows))
        section.figures.push_back(std::move(*group));
    FigureGroup charts;
    for (const auto& figure : figures)
        if (charts.figures.size() < max_charts) charts.figures.push_back(tornado(figure));
    charts.caption = "The five numbers with the largest effect on each figure, for 1 mm or 1 %.";
    std::vector<std::pair<const KeyFigure*, const EffectRow*>> largest;
    for (const auto& figure : figures)
        for (std::size_t k = 0; k < std::min<std::size_t>(10, figure.effects.size()); ++k)
            if (figure.counts(figure.effects[k].effect))
                largest.emplace_back(&figure, &figure.effects[k]);
    using L = std::pair<const KeyFigure*, const EffectRow*>;
    charts.table = compare::table<L>(
        {.caption = "Effects on each figure, the largest ten, for 1 mm or 1 %", .detail = true},
        {{"figure", Digits::words, [](const L& l) { return l.first->title; }},
         {"number", Digits::words, [](const L& l) { return l.second->number; }},
         {"for", Digits::words, [](const L& l) { return l.second->step; }},
         {"effect", Digits::deviation, [](const L& l) { return l.second->effect; }},
         {"unit", Digits::words, [](const L& l) { return l.first->unit; }}},
        largest);
    section.figures.push_back(std::move(charts));
    if (figures.size() > max_columns) figures.resize(max_columns);
    if (Table map = heat_map(figures, rows); !map.rows.empty())
        section.tables.push_back(std::move(map));
    return section;
}

}  // namespace elastocheck::reports
