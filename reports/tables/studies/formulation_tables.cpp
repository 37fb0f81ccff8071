#include "reports/tables/studies/formulation_tables.hpp"

#include <fmt/format.h>

#include <iterator>

#include "compare/tables/rows.hpp"
#include "reports/tables/render.hpp"

namespace elastocheck::reports {

std::string formulation_text(const compare::FormulationStudy& study,
                             const compare::Comparison& comparison) {
    std::string all;
    const auto out = std::back_inserter(all);
    fmt::format_to(out, "\nformulations of the bushings ({}): {}\n", compare::formulations.size(),
                   fmt::join(study.bushings, ", "));
    const auto rows = formulation_rows(study, comparison);
    for (const auto& branch : study.branches) {
        fmt::format_to(out, "\nbranch '{}': largest less smallest value over {} formulations\n",
                       branch.branch, branch.solved.size());
        for (const auto& why : branch.not_solved) fmt::format_to(out, "  not solved: {}\n", why);
        all += text(where(rows, &compare::FormulationRow::branch, branch.branch));
    }
    for (const auto& why : study.inconclusive) fmt::format_to(out, "  inconclusive: {}\n", why);
    if (study.conclusive())
        fmt::format_to(
            out, "\nA correct tool with the same input may differ from this one by the spread.\n");
    return all;
}

}  // namespace elastocheck::reports
