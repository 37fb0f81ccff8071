// Section: errors over the number of steps.
#include <fmt/format.h>

#include <cmath>

#include "reports/page/chart.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::StepRow;
using compare::StudyRow;

const std::string against_reference = "error against the reference", step_error = "step error",
                  violation = "|Φ|, eq. (31)";

// Largest errors over the positions at the end of a branch by one reading, a row per step count.
Table levels_of(const std::vector<StepRow>& rows) {
    using enum Digits;
    const auto worst = [&](double steps, double StepRow::*value, double factor) {
        double most = 0;
        for (const auto& row : rows)
            if (row.unit == "mm" && row.steps == steps)
                most = compare::worse(most, std::abs(factor * row.*value));
        return most;
    };
    return compare::table<double>(
        {},
        {{"steps", whole, [](double steps) { return steps; }, "", "", "steps per branch"},
         {against_reference, three, [=](double s) { return worst(s, &StepRow::error, 1); }},
         {step_error, three, [=](double s) { return worst(s, &StepRow::end, 1); }},
         {violation, three, [=](double s) { return worst(s, &StepRow::constraint_error, 1e3); }}},
        distinct(where(rows, &StepRow::unit, "mm"), &StepRow::steps));
}

// Step errors of the published recursion over one branch, a figure a reading.
std::optional<FigureGroup> step_errors(const std::string& branch,
                                       const std::vector<StepRow>& rows) {
    FigureGroup group;
    for (const auto& reading : distinct(rows, &StepRow::reading)) {
        const Table levels = levels_of(where(rows, &StepRow::reading, reading));
        const std::string name = as_words(reading);
        Figure figure = figure_of({.id = fmt::format("steps-{}-{}", slug(branch), slug(name)),
                                   .title = fmt::format("{}: {}", branch, name),
                                   .x = "steps",
                                   .y = {against_reference, step_error, violation},
                                   .log_x = true,
                                   .log_y = true},
                                  levels, "at the end of the branch [mm]");
        if (figure.series.empty()) continue;
        figure.description = fmt::format("Logarithmic plot over the steps per branch, {}:", name);
        for (const auto& series : figure.series)
            figure.description +=
                fmt::format(" the {} from {} to {} mm,", series.title,
                            number(series.rows.front()[1], 2), number(series.rows.back()[1], 2));
        figure.description.back() = '.';
        group.figures.push_back(std::move(figure));
        if (group.table.columns.empty()) {
            group.table = levels;
            continue;
        }
        for (std::size_t c = 1; c + 1 < levels.columns.size(); ++c) {
            group.table.columns.push_back(levels.columns[c]);
            group.table.columns.back().heading = levels.columns[c].name + ", " + name;
            for (std::size_t r = 0; r < levels.rows.size(); ++r)
                group.table.rows[r].push_back(levels.rows[r][c]);
        }
    }
    if (group.figures.empty()) return std::nullopt;
    group.table.caption =
        fmt::format("Errors at the end of branch {}, published recursion [mm]", branch);
    group.table.detail = true;
    group.caption =
        fmt::format("Branch {}: worst position at its end, published recursion.", branch);
    return group;
}

}  // namespace

std::optional<Section> convergence_section(const SceneAnalyses& scene) {
    if (!scene.study) return std::nullopt;
    Section section{.id = "convergence",
                    .title = "Convergence with the number of steps",
                    .part = Part::evidence};
    section.words["reasons"] = scene.study->inconclusive;
    const auto outputs = study_rows(*scene.study);
    const auto steps = where(step_rows(*scene.study), &StepRow::method, "published");
    for (const auto& branch : distinct(outputs, &StudyRow::branch)) {
        if (!leads(scene, branch)) continue;
        if (auto errors = step_errors(branch, where(steps, &StepRow::branch, branch)))
            section.figures.push_back(std::move(*errors));
        const auto branch_rows = where(outputs, &StudyRow::branch, branch);
        const std::string reading = branch_rows.front().reading;
        for (const auto& row : branch_rows)
            if (row.method == "published" && !row.not_studied.empty() && row.reading != reading)
                section.words["notes"].push_back({{"branch", branch},
                                                  {"reading", as_words(row.reading)},
                                                  {"why", row.not_studied}});
        Table& table =
            section.tables.emplace_back(table_of(where(branch_rows, &StudyRow::reading, reading)));
        table.caption = fmt::format("Orders and gaps, branch {}, {}", branch, reading);
        table.detail = true;
    }
    return section;
}

}  // namespace elastocheck::reports
