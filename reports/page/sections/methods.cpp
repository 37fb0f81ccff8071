// Section: which of the fast methods is good enough, by error and counted work.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/answer.hpp"
#include "reports/page/sections.hpp"

namespace elastocheck::reports {

std::optional<Section> methods_section(const SceneAnalyses& scene) {
    const std::string sentence = method_sentence(scene);
    if (sentence.empty()) return std::nullopt;
    Section section{
        .id = "methods", .title = "Which fast method is good enough?", .part = Part::evidence};
    const auto rows = method_rows(scene);
    section.words = {{"sentence", sentence}, {"studied", scene.trade.has_value()}};
    if (rows.empty()) return section;
    section.words["not_at_equal_travel"] = std::ranges::any_of(rows, [](const MethodRow& row) {
        return std::isnan(row.mm_at_abscissa) && std::isnan(row.deg_at_abscissa);
    });
    using enum Digits;
    using M = MethodRow;
    Table table = compare::table<M>(
        {.caption = fmt::format("Fast methods against {}", tolerance_of(scene))},
        {{"method", words, &M::method},
         {"steps or tolerance", words, &M::setting},
         {"within the tolerance", words,
          [](const M& m) { return m.chosen   ? "yes, recommended"
                                  : m.within ? "yes"
                                             : "no"; }},
         {"error at equal load or drive", size, &M::mm, "", "mm"},
         {"angle", size, &M::deg, "", "deg"},
         {"error at equal travel", size, &M::mm_at_abscissa, "", "mm"},
         {"angle", size, &M::deg_at_abscissa, "", "deg"},
         {"work, of the full solution", percent, &M::cost}},
        rows);
    section.tables.push_back(std::move(table));
    return section;
}

}  // namespace elastocheck::reports
