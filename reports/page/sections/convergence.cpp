// Section: errors over the number of steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
    group.table.caption =
        fmt::format("Errors at the end of branch {}, published recursion [mm]", branch);
    group.table.columns = {{"steps"}, {"|Φ|, eq. (31)"}};
    group.table.folded = true;
    std::vector<Levels> both;
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
        figure.description = fmt::format(
            "Logarithmic plot, {}: from {} to {} steps the constraint error of eq. (31) goes from "
            "{} to {} "
            "mm, "
            "the step error from {} to {} mm, the error against the reference from {} to {} mm.",
            name, number(steps.front(), 4), number(steps.back(), 4), number(phi.front(), 2),
            number(phi.back(), 2), number(step.front(), 2), number(step.back(), 2),
            number(truth.front(), 2), number(truth.back(), 2));
        group.table.columns.push_back({fmt::format("step error, {}", name)});
        group.table.columns.push_back({fmt::format("error against the reference, {}", name)});
        group.figures.push_back(std::move(figure));
        both.push_back(levels);
    }
    if (group.figures.empty()) return std::nullopt;
    for (std::size_t l = 0; l < both.front().steps.size(); ++l) {
        std::vector<std::string> row{whole_number(std::lround(both.front().steps[l])),
                                     number(both.front().phi[l])};
        for (const auto& levels : both) {
            row.push_back(number(levels.step[l]));
            row.push_back(number(levels.truth[l]));
        }
        group.table.rows.push_back(row);
    }
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
        section.tables.push_back(
            page_table(fmt::format("Orders and gaps, branch {}, {}", branch, reading),
                       where(found, &StudyRow::reading, reading)));
        section.tables.back().folded = true;
    }
    return section;
}

}  // namespace elastocheck::reports
