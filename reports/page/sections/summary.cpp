// Section: first screen with the suspension, how far the numbers can be trusted, the static alignment
// and the key figures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/outputs/catalogue/catalogue.hpp"
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

// Without rounding: no finer than a thousandth of a mm or deg, no more than four digits.
std::string static_number(double value) { return std::abs(value) < 5e-5 ? "0" : number(value, 4); }

// As drawn and as settled, left and right as columns.
std::optional<Table> alignment(const SceneAnalyses& scene) {
    const auto& wheels = scene.model.wheels;
    const auto values = static_rows(scene.model, scene.comparison);
    Table table{.caption = fmt::format(
                    "Static alignment as drawn and as settled{} (toe-in, top outwards positive)",
                    scene.trim ? " after the trim" : ""),
                .columns = {{"of the wheel", true}}};
    for (const char* state : {"drawn", "settled"})
        for (const auto& wheel : wheels)
            table.columns.push_back(
                {fmt::format("{}{}{}", state, wheel.name.empty() ? "" : " ", wheel.name)});
    for (const auto& output : distinct(values, &StaticRow::output)) {
        const auto rows = where(values, &StaticRow::output, output);
        std::vector<std::string> row{fmt::format("{} [{}]", as_words(output), rows.front().unit)};
        for (const auto state : {&StaticRow::drawn, &StaticRow::settled})
            for (const auto& wheel : wheels) {
                const auto mine = std::ranges::find(rows, wheel.name, &StaticRow::wheel);
                row.push_back(mine == rows.end() ? "–" : static_number((*mine).*state));
            }
        table.rows.push_back(std::move(row));
    }
    if (table.rows.empty()) return std::nullopt;
    return table;
}

// What the trim adjusted. Preloads of balanced bushings are listed with the model.
std::optional<Table> adjusted(const SceneAnalyses& scene) {
    if (!scene.trim) return std::nullopt;
    const bool balanced = scene.trim->bushings == Trim::Bushings::balanced;
    Table table{.caption = balanced
                               ? "The trim adjusted; preloads of all bushings (in “The model as "
                                 "compiled”) balance the drawn position"
                               : "The trim adjusted; bushings are unloaded as drawn",
                .columns = {{"what", true}, {"by"}, {"makes", true, true}}};
    for (const auto& a : scene.trim->adjusted)
        if (!balanced || !a.name.starts_with("bushings.") || !a.name.ends_with(".preload"))
            table.rows.push_back(
                {a.name, fmt::format("{} {}", signed_number(a.by, 4), symbol(a.unit)), a.makes});
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
    for (const auto& quantity : compare::drawn_over(compare::Over::load))
        for (const std::size_t end : {std::size_t{0}, curve.a.size() - 1}) {
            if (end == curve.start) continue;
            const compare::Entry& entry = *compare::find_entry(quantity.name);
            if (entry.point != nullptr) continue;  // a position
            const bool from_drawn = !entry.is.main;
            std::vector<std::string> row{fmt::format(
                "{}{} at {}{}\u00a0{}", as_words(quantity.name), from_drawn ? "" : " change",
                curve.a[end] > 0 ? "+" : "", short_number(curve.a[end]), sweep->unit)};
            for (const auto& wheel : wheels) {
                const auto values = curve.channel(output_of(wheel, quantity.name));
                row.push_back(
                    values.empty()
                        ? "–"
                        : static_number(values[end] - (from_drawn ? 0 : values[curve.start])));
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
    std::vector<std::string> names, moved, listed;
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
    group.table = {.caption = "Points",
                   .columns = {{"point", true}, {"x [mm]"}, {"y [mm]"}, {"z [mm]"}}};
    for (const auto& point : suspension.points) {
        if (std::ranges::find(listed, point.name) != listed.end()) continue;
        listed.push_back(point.name);
        group.table.rows.push_back(
            {point.name, number(point.at[0], 4), number(point.at[1], 4), number(point.at[2], 4)});
    }
    group.table.folded = true;
    return group;
}

}  // namespace

std::optional<Section> first_section(const SceneAnalyses& scene) {
    Section section{.id = "first", .title = "At a glance"};
    section.words["trust"] = trust_sentence(scene);
    if (!scene.warnings.empty()) section.words["warnings"] = scene.warnings;
    if (auto table = alignment(scene)) section.tables.push_back(std::move(*table));
    Table key = key_rates(scene);
    if (!key.columns.empty()) add_changes(key, scene);
    if (!key.rows.empty()) section.tables.push_back(std::move(key));
    if (auto table = adjusted(scene)) section.tables.push_back(std::move(*table));
    const Suspension suspension = suspension_of(scene);
    section.figures.push_back(picture_of(suspension));
    section.motion = motion_of(scene, axonometric_view(is_right(suspension)));
    return section;
}

}  // namespace elastocheck::reports
