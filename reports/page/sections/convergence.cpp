// Section: errors over the number of steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::StepRow;
using compare::StudyRow;

// Largest errors over the positions at the end of a branch, per step count.
struct Levels {
    std::vector<double> steps, phi, step, truth;
};
Levels levels_of(const std::vector<StepRow>& rows) {
    Levels levels;
    for (const auto& row : rows) {
        if (row.unit != "mm") continue;
        const auto at = static_cast<std::size_t>(std::ranges::find(levels.steps, row.steps) -
                                                 levels.steps.begin());
        if (at == levels.steps.size()) {
            levels.steps.push_back(row.steps);
            levels.phi.push_back(1e3 * row.constraint_error);
            levels.step.push_back(0);
            levels.truth.push_back(0);
        }
        levels.step[at] = compare::worse(levels.step[at], std::abs(row.end));
        levels.truth[at] = compare::worse(levels.truth[at], std::abs(row.error));
    }
    return levels;
}

std::vector<std::vector<double>> rows(const std::vector<double>& steps,
                                      const std::vector<double>& values) {
    std::vector<std::vector<double>> result;
    for (std::size_t l = 0; l < steps.size(); ++l)
        if (values[l] > 1e-16) result.push_back({steps[l], values[l]});
    return result;
}

// Step errors of one method over one branch.
std::optional<FigureGroup> group(const std::string& branch, const std::vector<StepRow>& steps_of) {
    FigureGroup group;
    std::vector<std::pair<std::string, Levels>> readings;
    for (const auto& reading : distinct(steps_of, &StepRow::reading)) {
        const Levels levels = levels_of(where(steps_of, &StepRow::reading, reading));
        if (levels.steps.empty()) continue;
        const auto& [steps, phi, step, truth] = levels;
        const std::string name = as_words(reading);
        Figure figure{.id = fmt::format("steps-{}-{}", slug(branch), slug(name)),
                      .title = fmt::format("{}: {}", branch, name),
                      .description = {},
                      .x = "steps per branch",
                      .y = "at the end of the branch [mm]",
                      .log_x = true,
                      .log_y = true};
        figure.series = {{"error against the reference", Series::Style::line_points, vermilion, 6,
                          rows(steps, truth)},
                         {"step error", Series::Style::line_points, blue, 4, rows(steps, step)},
                         {"|Φ|, eq. (31)", Series::Style::rings, green, 5, rows(steps, phi)}};
        std::erase_if(figure.series, [](const Series& s) { return s.rows.empty(); });
        if (figure.series.empty()) continue;
        const auto ends = [](const std::vector<double>& values) {
            return fmt::format("from {} to {} mm", number(values.front(), 2),
                               number(values.back(), 2));
        };
        figure.description = fmt::format(
            "Logarithmic plot, {}: from {} to {} steps the constraint error of eq. (31) goes {}, "
            "the step error {}, the error against the reference {}.",
            name, number(steps.front(), 4), number(steps.back(), 4), ends(phi), ends(step),
            ends(truth));
        group.figures.push_back(std::move(figure));
        readings.emplace_back(name, levels);
    }
    if (group.figures.empty()) return std::nullopt;
    using Level = std::size_t;
    const Levels& first = readings.front().second;
    std::vector<compare::ColumnOf<Level>> columns{
        {"steps", Digits::whole, [&](Level l) { return first.steps[l]; }},
        {"|Φ|, eq. (31)", Digits::three, [&](Level l) { return first.phi[l]; }}};
    for (const auto& [name, levels] : readings) {
        columns.push_back(
            {"step error, " + name, Digits::three, [&levels](Level l) { return levels.step[l]; }});
        columns.push_back({"error against the reference, " + name, Digits::three,
                           [&levels](Level l) { return levels.truth[l]; }});
    }
    group.table = compare::table("", columns, std::views::iota(Level{0}, first.steps.size()));
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
        if (auto made = group(branch, where(steps, &StepRow::branch, branch)))
            section.figures.push_back(std::move(*made));
        const auto found = where(outputs, &StudyRow::branch, branch);
        const std::string reading = found.front().reading;
        for (const auto& row : found)
            if (row.method == "published" && !row.not_studied.empty() && row.reading != reading)
                section.words["notes"].push_back({{"branch", branch},
                                                  {"reading", as_words(row.reading)},
                                                  {"why", row.not_studied}});
        Table& table =
            section.tables.emplace_back(table_of(where(found, &StudyRow::reading, reading)));
        table.caption = fmt::format("Orders and gaps, branch {}, {}", branch, reading);
        table.detail = true;
    }
    return section;
}

}  // namespace elastocheck::reports
