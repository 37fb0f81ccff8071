// Section: the compliance matrices, and the errors of the recursion in the rates.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/tables/rows.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::CharacteristicRow;
using compare::ComplianceRow;

// Compliance matrix of the equilibrium leg at the start of the first branch.
std::optional<Table> matrix_table(const std::vector<ComplianceRow>& compliance,
                                  std::string_view point) {
    auto rows = compliance;
    std::erase_if(rows, [&](const ComplianceRow& r) {
        return r.leg != "equilibrium" || r.point != point ||
               r.branch != compliance.front().branch || r.a != 0;
    });
    if (rows.empty()) return std::nullopt;
    std::vector<std::string> columns{"answer"};
    if (distinct(rows, &ComplianceRow::wheel).size() > 1)
        columns = {"wheel", "answer", "loaded wheel"};
    columns.insert(columns.end(), ComplianceRow::causes.begin(), ComplianceRow::causes.end());
    Table table = with_columns(compare::table_of(rows), columns);
    table.caption = fmt::format(
        "Compliance at the {}: displacement [mm] and rotation [deg] per kN and per 100 N·m, the "
        "wheel free",
        point);
    table.detail = true;
    return table;
}

// Errors of the recursion in the rates; without a percentage where the error exceeds the value, which
// is zero but for rounding.
Table errors_table(std::vector<CharacteristicRow> design) {
    for (auto& r : design) {
        r.output = as_words(r.output);
        if (!(std::abs(r.off_percent) <= 100)) r.off_percent = compare::nan;
    }
    Table table =
        with_columns(compare::table_of(design), {"output", "value", "unit", "off", "off %"});
    table.caption = "Error of the published recursion in the rates at the design position";
    table.detail = true;
    return table;
}

}  // namespace

std::optional<Section> matrices_section(const SceneAnalyses& scene) {
    if (scene.model.wheels.empty()) return std::nullopt;
    const auto design = characteristic_rows(scene.comparison);
    if (design.empty()) return std::nullopt;
    Section section{.id = "matrices",
                    .title = "Compliance matrices, and the recursion’s rates",
                    .part = Part::evidence};
    const auto compliance = compliance_rows(scene.model, scene.comparison);
    for (const char* point : {"contact patch", "wheel centre"})
        if (auto table = matrix_table(compliance, point))
            section.tables.push_back(std::move(*table));
    double worst = 0;
    for (const auto& r : compliance)
        if (r.leg != "recursive" && r.a == 0) worst = std::max(worst, r.reciprocity);
    if (!compliance.empty()) section.words["reciprocity"] = number(worst, 2);
    section.tables.push_back(errors_table(design));
    return section;
}

}  // namespace elastocheck::reports
