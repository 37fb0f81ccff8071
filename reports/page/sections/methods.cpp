// Section: which of the fast methods is good enough, by error and counted work.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/answer.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::optional<Section> methods_section(const SceneAnalyses& scene) {
    const std::string sentence = method_sentence(scene);
    if (sentence.empty()) return std::nullopt;
    Section section{
        .id = "methods", .title = "Which fast method is good enough?", .part = Part::methods};
    section.words = {{"sentence", sentence}, {"tolerance", tolerance_of(scene)}};
    const auto rows = method_rows(scene);
    section.words["studied"] = scene.trade.has_value();
    if (rows.empty()) return section;
    Table table{.caption = fmt::format("Fast methods against {}", tolerance_of(scene)),
                .columns = {{"method", true},
                            {"steps or tolerance", true},
                            {"within the tolerance", true},
                            {"error at equal load or drive [mm]"},
                            {"[deg]"},
                            {"error at equal travel [mm]"},
                            {"[deg]"}}};
    if (scene.trade) table.columns.push_back({"work, of the full solution"});
    const auto size = [](double value) { return number(value, 2); };
    for (const auto& row : rows) {
        table.rows.push_back({row.method, row.setting,
                              row.chosen   ? "yes, recommended"
                              : row.within ? "yes"
                                           : "no",
                              size(row.mm), size(row.deg), size(row.mm_across),
                              size(row.deg_across), percent(row.cost)});
        table.rows.back().resize(table.columns.size());
    }
    section.words["not_across"] = std::ranges::any_of(rows, [](const MethodRow& row) {
        return std::isnan(row.mm_across) && std::isnan(row.deg_across);
    });
    section.tables.push_back(std::move(table));
    return section;
}

}  // namespace elastocheck::reports
