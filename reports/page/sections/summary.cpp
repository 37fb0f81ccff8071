// Section: first screen with the suspension, how far the numbers can be trusted, the static alignment
// and the key figures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "reports/document/scene_analyses.hpp"
#include "reports/given/wheels.hpp"
#include "reports/page/answer.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/motion.hpp"
#include "reports/page/sections/inputs/suspension.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::StaticRow;

// 0 below 5e-5 mm or deg, which would be the only digits in a column of zeros.
double settled_value(double value) { return std::abs(value) < 5e-5 ? 0 : value; }

// Outputs of the wheels in rows; as drawn and as settled, left and right, in columns.
Table alignment_table(const SceneAnalyses& scene) {
    const auto values = static_rows(scene.model, scene.comparison);
    const auto outputs = distinct(values, &StaticRow::output);
    using Output = std::string;
    const auto row_of = [&](const Output& output, const std::string& wheel) {
        return std::ranges::find_if(values, [&](const StaticRow& row) {
            return row.output == output && row.wheel == wheel;
        });
    };
    std::vector<compare::ColumnOf<Output>> columns{
        {"of the wheel", Digits::words, [&](const Output& output) {
             return fmt::format("{} [{}]", as_words(output),
                                std::ranges::find(values, output, &StaticRow::output)->unit);
         }}};
    for (const auto& [state, value] :
         {std::pair{"drawn", &StaticRow::drawn}, {"settled", &StaticRow::settled}})
        for (const auto& wheel : scene.model.wheels)
            columns.push_back(
                {fmt::format("{}{}{}", state, wheel.name.empty() ? "" : " ", wheel.name),
                 Digits::four, [&, value](const Output& output) {
                     const auto row = row_of(output, wheel.name);
                     return row == values.end() ? compare::nan : settled_value((*row).*value);
                 }});
    Table table = compare::table(
        {.caption = fmt::format(
             "Static alignment as drawn and as settled{} (toe-in, top outwards positive)",
             scene.trim ? " after the trim" : "")},
        columns, outputs);
    return table;
}

// What the trim adjusted. Preloads of balanced bushings are listed with the model.
Table trim_table(const SceneAnalyses& scene) {
    const bool balanced = scene.trim->bushings == Trim::Bushings::balanced;
    Table table = whole_table(scene.inspected, "trim");
    std::erase_if(table.rows, [&](const auto& row) {
        const auto& name = std::get<std::string>(row.front());
        return balanced && name.starts_with("bushings.") && name.ends_with(".preload");
    });
    table.caption = balanced ? "The trim adjusted; preloads of all bushings (in “The model as "
                               "compiled”) balance the drawn position"
                             : "The trim adjusted; bushings are unloaded as drawn";
    return table;
}

// Changes of each wheel at both ends of the leading sweep.
void add_changes(Table& table, const SceneAnalyses& scene) {
    const auto sweep = leading_sweep(scene);
    const auto& wheels = scene.model.wheels;
    if (!sweep || !sweep->lifts() || wheels.empty()) return;
    const SweepCurve curve(scene, *sweep);
    if (curve.a.size() < 2) return;
    table.caption += fmt::format(
        ", and over the branch {}: changes since its start, track change from the drawn position",
        sweep->name);
    for (const auto& quantity : compare::figures_over(compare::DrawnAbscissa::load))
        for (const std::size_t end : {std::size_t{0}, curve.a.size() - 1}) {
            const compare::Entry& entry = *compare::find_entry(quantity.name);
            if (end == curve.start || entry.point != nullptr) continue;  // a position
            const bool from_drawn = !entry.properties.is_main;
            std::vector<compare::Cell> row{fmt::format(
                "{}{} at {}{}\u00a0{}", as_words(quantity.name), from_drawn ? "" : " change",
                curve.a[end] > 0 ? "+" : "", short_number(curve.a[end]), sweep->unit)};
            for (const auto& wheel : wheels) {
                const auto values = curve.channel(output_of(wheel, quantity.name));
                row.emplace_back(
                    values.empty()
                        ? compare::nan
                        : settled_value(values[end] - (from_drawn ? 0 : values[curve.start])));
            }
            row.emplace_back(symbol(entry.unit));
            if (row.size() == table.columns.size()) table.rows.push_back(std::move(row));
        }
}

// The suspension with its points; the positions at the ends of the leading sweep in pale lines.
FigureGroup picture_of(const Suspension& suspension) {
    const std::string noun = noun_of(suspension);
    const View view = axonometric_view(is_right(suspension));
    FigureGroup group;
    group.figures = draw_views(suspension, {view}, large_frame(suspension));
    Figure& figure = group.figures.front();
    figure.title = fmt::format("The {}", noun);
    std::vector<std::string> names, moved;
    for (const auto& point : suspension.points)
        if (point.hardpoint && std::ranges::find(names, point.name) == names.end())
            names.push_back(point.name);
    for (const auto& position : suspension.moved) moved.push_back(position.title);
    figure.description = fmt::format(
        "The {} seen {}, to scale, with its points {}{}.", noun, view.from, enumerated(names),
        moved.empty() ? "" : ", and in pale lines at " + enumerated(moved));
    group.caption = fmt::format(
        "Design position to scale{}{}.", moved.empty() ? "" : ", pale lines: " + enumerated(moved),
        suspension.wheels.empty() ? "" : "; the tyre’s width is only drawn");
    std::vector<Suspension::Point> points;
    for (const auto& point : suspension.points)
        if (std::ranges::find(points, point.name, &Suspension::Point::name) == points.end())
            points.push_back(point);
    group.table = points_table(points);
    group.table.caption = "Points";
    return group;
}

}  // namespace

std::optional<Section> first_section(const SceneAnalyses& scene) {
    Section section{.id = "first", .title = "At a glance"};
    section.words["trust"] = trust_sentence(scene);
    if (!scene.warnings.empty()) section.words["warnings"] = scene.warnings;
    section.tables.push_back(alignment_table(scene));
    Table key = key_rates(scene);
    if (!key.columns.empty()) add_changes(key, scene);
    section.tables.push_back(std::move(key));
    if (scene.trim) section.tables.push_back(trim_table(scene));
    std::erase_if(section.tables, [](const Table& table) { return table.rows.empty(); });
    const Suspension suspension = suspension_of(scene);
    section.figures.push_back(picture_of(suspension));
    section.motion = motion_of(scene, axonometric_view(is_right(suspension)));
    return section;
}

}  // namespace elastocheck::reports
