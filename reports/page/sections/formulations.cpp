// Section: spread of the outputs over bushing formulations.
#include "compare/tables/compare_result.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::optional<Section> formulations_section(const SceneAnalyses& scene) {
    const auto& study = scene.formulations;
    if (!study) return std::nullopt;
    Section section{.id = "formulations",
                    .title = "Differences between bushing formulations of tools",
                    .part = Part::evidence};
    const auto rows = formulation_rows(*study, scene.comparison);
    Table table = with_columns(compare::table_of(rows),
                               {"branch", "output", "spread", "unit", "smallest by", "largest by",
                                "distance of references", "deviation"});
    table.caption =
        "Largest minus smallest value over the formulations, at the point where it is largest";
    table.detail = true;
    section.tables.push_back(std::move(table));
    double most = 1e-9;  // [mm]: smaller spreads are rounding
    for (const auto& r : rows) {
        if (r.unit != "mm" || !(r.spread > most)) continue;
        most = r.spread;
        section.words["most"] = {{"value", quantity(r.spread, r.unit)}, {"channel", r.output}};
    }
    std::vector<std::string> names;
    for (const auto& formulation : compare::formulations) names.emplace_back(formulation.name);
    section.words["formulations"] = enumerated(names);
    section.words["bushings"] = enumerated(study->bushings);
    auto& reasons = section.words["reasons"] = study->inconclusive;
    for (const auto& branch : study->branches)
        for (const auto& why : branch.not_solved) reasons.push_back(branch.branch + ": " + why);
    return section;
}

}  // namespace elastocheck::reports
