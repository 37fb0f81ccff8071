#include "reports/tables/studies/study_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "compare/tables/rows.hpp"
#include "reports/tables/render.hpp"

namespace elastocheck::reports {

namespace {

using compare::GapRow;
using compare::StepRow;
using compare::StudyRow;

// Levels side by side: one row per method, or method and output, one column per step count.
std::string over_steps(const std::vector<StepRow>& levels, bool by_output, double StepRow::*value,
                       const char* unit) {
    compare::Table wide;
    for (const char* key : {"method", "output", "unit"})
        if (by_output || wide.columns.empty())
            wide.columns.push_back({.name = key, .words = true, .digits = Digits::words});
    const std::size_t keys = wide.columns.size();
    const auto steps = distinct(levels, &StepRow::steps);
    for (const double n : steps)
        wide.columns.push_back(
            {.name = fmt::format("{:g}", n), .unit = unit, .digits = Digits::size});
    for (const auto& level : levels) {
        std::vector<compare::Cell> row{level.method, level.output, level.unit};
        row.resize(keys);
        auto into = std::ranges::find_if(wide.rows, [&](const auto& other) {
            return std::equal(row.begin(), row.end(), other.begin());
        });
        if (into == wide.rows.end()) {
            row.resize(keys + steps.size(), compare::nan);
            into = wide.rows.insert(into, std::move(row));
        }
        const auto at = std::ranges::find(steps, level.steps) - steps.begin();
        (*into)[keys + static_cast<std::size_t>(at)] = level.*value;
    }
    return text(wide);
}

}  // namespace

std::string study_text(const Model& model, const compare::Study& study,
                       const std::vector<compare::BranchAttribution>& attribution) {
    std::string all = fmt::format(
        "{}\nvalue - truth = step error (to the method's own limit) + formulation gap (own limit - "
        "reference) + reference uncertainty\nStudied are positions and angles; forces, moments and "
        "rates are "
        "compared by `elastocheck compare`.\n",
        model.name);
    const auto out = std::back_inserter(all);
    const auto outputs = study_rows(study);
    const auto steps = step_rows(study);
    const auto gaps = gap_rows(study.channels, attribution);
    for (const auto& branch : distinct(outputs, &StudyRow::branch)) {
        const auto levels = where(steps, &StepRow::branch, branch);
        const auto found = where(outputs, &StudyRow::branch, branch);
        for (const auto& reading : distinct(levels, &StepRow::reading))
            fmt::format_to(
                out,
                "\nbranch '{0}' {1}: order at which the largest step error over the branch falls, "
                "and what no step count removes\n{2}"
                "\nbranch '{0}' {1}: step errors, largest over the branch, over the steps\n{3}",
                branch, reading, text(where(found, &StudyRow::reading, reading)),
                over_steps(where(levels, &StepRow::reading, reading), true, &StepRow::largest, ""));
        // A candidate does not give |Φ|.
        if (std::ranges::any_of(
                levels, [](const StepRow& row) { return std::isfinite(row.constraint_error); }))
            fmt::format_to(out, "\nbranch '{}': |Φ| at its end, eq. (31), over the steps\n{}",
                           branch, over_steps(levels, false, &StepRow::constraint_error, "m"));
        const auto made = where(gaps, &GapRow::branch, branch);
        for (const auto& reading : distinct(made, &GapRow::reading))
            fmt::format_to(
                out,
                "\nbranch '{}' {}: what the gap of the recursion is made of, whole = lever + axis "
                "+ load + rest\n{}",
                branch, reading, text(where(made, &GapRow::reading, reading)));
    }
    for (const auto& reason : study.inconclusive) fmt::format_to(out, "\ninconclusive: {}", reason);
    all += study.conclusive() ? "\nconclusive\n" : "\nINCONCLUSIVE\n";
    return all;
}

nlohmann::ordered_json study_json(const compare::Study& study,
                                  const std::vector<compare::BranchAttribution>& attribution) {
    return {{"conclusive", study.conclusive()},
            {"reasons", study.inconclusive},
            {"steps", study.steps},
            {"outputs", table_json(study_rows(study))},
            {"step_errors", table_json(step_rows(study))},
            {"gap", table_json(gap_rows(study.channels, attribution))}};
}

}  // namespace elastocheck::reports
