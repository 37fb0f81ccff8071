#include "reports/tables/studies/precision_tables.hpp"

#include <fmt/format.h>

#include <iterator>

#include "reports/tables/select.hpp"

namespace elastocheck::reports {

const std::vector<ShownColumn> floor_columns{
    {"method"},
    {"arithmetic"},
    {"least constraint error", Digits::size, "least |Φ|"},
    {"steps that lower it", Digits::whole, "useful steps"},
    {"constraint remark", {}, "remark"},
    {"least error", Digits::size},
    {"steps that lower the error", Digits::whole, "useful steps"},
    {"error remark", {}, "remark"}};

std::string precision_text(const compare::PrecisionStudy& study) {
    std::string all;
    const auto out = std::back_inserter(all);
    fmt::format_to(out, "The arithmetic, at the end of branch '{}'; references {:.2e} mm apart\n",
                   study.branch, study.uncertainty.mm);
    for (const auto& reason : study.inconclusive) fmt::format_to(out, "INCONCLUSIVE: {}\n", reason);
    const auto levels = precision_table(study);
    const auto arithmetics = distinct(levels, "arithmetic");
    auto wide =
        spread(levels, "arithmetic", {"outcome", "constraint error", "error", "angle error"});
    // An outcome column is shown only where an outcome is not `converged`.
    for (auto& row : wide.rows)
        for (auto& cell : row)
            if (cell == compare::Cell(std::string(name(Outcome::converged)))) cell = std::string();
    for (const auto& method : distinct(wide, "method")) {
        std::vector<ShownColumn> shown{{"steps"}};
        for (const auto& a : arithmetics) {
            shown.push_back({a + ": outcome", {}, a});
            shown.push_back({a + ": constraint error", Digits::size, a + ": |Φ|"});
            shown.push_back({a + ": error", Digits::size, "error"});
        }
        fmt::format_to(out, "\n  {}\n{}", method, text(where(wide, "method", method), shown));
    }
    fmt::format_to(out, "\n  Steps beyond which nothing is gained:\n{}",
                   text(floor_table(study), floor_columns));
    return all;
}

nlohmann::ordered_json precision_json(const compare::PrecisionStudy& study) {
    return {{"branch", study.branch},
            {"inconclusive", study.inconclusive},
            {"levels", table_json(precision_table(study))},
            {"floors", table_json(floor_table(study))}};
}

}  // namespace elastocheck::reports
