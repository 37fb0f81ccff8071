// Section: spread of the outputs over bushing formulations.
#include <algorithm>
#include <cmath>

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
    Table table{
        .caption =
            "Largest minus smallest value over the formulations, at the point where it is largest",
        .columns = {{"branch", true},
                    {"output", true},
                    {"spread"},
                    {"unit", true},
                    {"smallest by", true},
                    {"largest by", true},
                    {"difference of the references"},
                    {"published deviation"}},
        .folded = true};
    double most = 1e-9;  // [mm]: smaller spreads are rounding
    for (const auto& r : formulation_rows(*study, scene.comparison)) {
        table.rows.push_back({r.branch, r.output, deviation_number(r.spread), r.unit, r.smallest_by,
                              r.largest_by, number(r.apart, 2), number(r.deviation, 2)});
        if (r.unit != "mm" || !(r.spread > most)) continue;
        most = r.spread;
        section.words["most"] = {{"value", quantity(r.spread, r.unit)}, {"channel", r.output}};
    }
    std::vector<std::string> names;
    for (const auto& one : compare::formulations) names.emplace_back(one.name);
    section.words["formulations"] = enumerated(names);
    section.words["bushings"] = enumerated(study->bushings);
    auto& reasons = section.words["reasons"] = nlohmann::ordered_json::array();
    for (const auto& branch : study->branches)
        for (const auto& why : branch.not_solved) reasons.push_back(branch.branch + ": " + why);
    for (const auto& why : study->inconclusive) reasons.push_back(why);
    section.tables.push_back(std::move(table));
    return section;
}

}  // namespace elastocheck::reports
