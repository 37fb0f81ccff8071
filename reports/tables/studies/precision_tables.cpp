#include "reports/tables/studies/precision_tables.hpp"

#include <fmt/format.h>

#include <iterator>

#include "compare/tables/rows.hpp"
#include "reports/tables/render.hpp"

namespace elastocheck::reports {

namespace {

using compare::PrecisionRow;

// The arithmetics of a method side by side, by number of steps.
compare::Table beside(const std::vector<PrecisionRow>& levels,
                      const std::vector<std::string>& arithmetics) {
    compare::Table wide{{{.name = "steps", .digits = Digits::whole}}, {}};
    for (const auto& a : arithmetics) {
        wide.columns.push_back({.name = a, .words = true, .digits = Digits::words});
        wide.columns.push_back({.name = a + ": |Φ|", .unit = "m", .digits = Digits::size});
        wide.columns.push_back({.name = "error", .unit = "mm", .digits = Digits::size});
    }
    for (const double steps : distinct(levels, &PrecisionRow::steps)) {
        auto& cells = wide.rows.emplace_back();
        cells.emplace_back(steps);
        for (const auto& a : arithmetics) {
            const auto at =
                where(where(levels, &PrecisionRow::steps, steps), &PrecisionRow::arithmetic, a);
            const PrecisionRow row = at.empty() ? PrecisionRow{} : at.front();
            // An outcome column is shown only where an outcome is not `converged`.
            cells.emplace_back(row.outcome == name(Outcome::converged) ? "" : row.outcome);
            cells.emplace_back(row.constraint_error);
            cells.emplace_back(row.error);
        }
    }
    return wide;
}

}  // namespace

std::string precision_text(const compare::PrecisionStudy& study) {
    std::string all;
    const auto out = std::back_inserter(all);
    fmt::format_to(out, "The arithmetic, at the end of branch '{}'; references {:.2e} mm apart\n",
                   study.branch, study.uncertainty.mm);
    for (const auto& reason : study.inconclusive) fmt::format_to(out, "INCONCLUSIVE: {}\n", reason);
    const auto levels = precision_rows(study);
    const auto arithmetics = distinct(levels, &PrecisionRow::arithmetic);
    for (const auto& method : distinct(levels, &PrecisionRow::method))
        fmt::format_to(out, "\n  {}\n{}", method,
                       text(beside(where(levels, &PrecisionRow::method, method), arithmetics)));
    fmt::format_to(out, "\n  Steps beyond which nothing is gained:\n{}", text(floor_rows(study)));
    return all;
}

nlohmann::ordered_json precision_json(const compare::PrecisionStudy& study) {
    return {{"branch", study.branch},
            {"inconclusive", study.inconclusive},
            {"levels", table_json(precision_rows(study))},
            {"floors", table_json(floor_rows(study))}};
}

}  // namespace elastocheck::reports
