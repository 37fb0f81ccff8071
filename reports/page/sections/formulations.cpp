// Section: spread of the outputs over bushing formulations.
#include <algorithm>
#include <cmath>

#include "compare/tables/table.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/tables/render.hpp"
#include "reports/tables/select.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::optional<Section> formulations_section(const JsonCursor& scene) {
    const auto study = scene.find("formulations");
    if (!study) return std::nullopt;
    Section section{.id = "formulations",
                    .title = "Differences between bushing formulations of tools",
                    .part = Part::evidence};
    const compare::Table spread =
        read_table((*study)["spread"], compare::formulation_table({}, {}));
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
    for (std::size_t r = 0; r < spread.rows.size(); ++r) {
        const double value = reports::number(spread, r, "spread");
        const std::string& unit = words(spread, r, "unit");
        table.rows.push_back({words(spread, r, "branch"), words(spread, r, "output"),
                              deviation_number(value), unit, words(spread, r, "smallest by"),
                              words(spread, r, "largest by"),
                              number(reports::number(spread, r, "references apart"), 2),
                              number(reports::number(spread, r, "deviation"), 2)});
        if (unit != "mm" || !(value > most)) continue;
        most = value;
        section.words["most"] = {{"value", quantity(value, unit)},
                                 {"channel", words(spread, r, "output")}};
    }
    section.words["formulations"] = enumerated((*study)["formulations"].texts());
    section.words["bushings"] = enumerated((*study)["bushings"].texts());
    section.words["reasons"] = nlohmann::ordered_json::array();
    for (const auto& why : (*study)["not_solved"].texts()) section.words["reasons"].push_back(why);
    for (const auto& why : (*study)["inconclusive"].texts())
        section.words["reasons"].push_back(why);
    section.tables.push_back(std::move(table));
    return section;
}

}  // namespace elastocheck::reports
