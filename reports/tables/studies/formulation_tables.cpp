#include "reports/tables/studies/formulation_tables.hpp"

#include <fmt/format.h>

#include <iterator>

#include "compare/tables/table.hpp"
#include "reports/tables/render.hpp"
#include "reports/tables/select.hpp"

namespace elastocheck::reports {

std::string formulation_text(const compare::FormulationStudy& study,
                             const compare::Comparison& comparison) {
    std::string all;
    const auto out = std::back_inserter(all);
    fmt::format_to(out, "\nformulations of the bushings ({}): {}\n", compare::formulations.size(),
                   fmt::join(study.bushings, ", "));
    const compare::Table table = formulation_table(study, comparison);
    for (const auto& branch : study.branches) {
        fmt::format_to(out, "\nbranch '{}': largest less smallest value over {} formulations\n",
                       branch.branch, branch.solved.size());
        for (const auto& why : branch.not_solved) fmt::format_to(out, "  not solved: {}\n", why);
        all +=
            text(where(table, "branch", branch.branch), {{"output"},
                                                         {"unit"},
                                                         {"spread", Digits::three},
                                                         {"at", Digits::given},
                                                         {"parameter unit", Digits::whole, "unit"},
                                                         {"smallest by"},
                                                         {"largest by"},
                                                         {"references apart", Digits::size},
                                                         {"deviation", Digits::three}});
    }
    for (const auto& why : study.inconclusive) fmt::format_to(out, "  inconclusive: {}\n", why);
    if (study.conclusive())
        fmt::format_to(
            out, "\nA correct tool with the same input may differ from this one by the spread.\n");
    return all;
}

}  // namespace elastocheck::reports
