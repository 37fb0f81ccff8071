// Where more steps stop helping because of the arithmetic.
#include <fmt/format.h>

#include "reports/page/numbers.hpp"
#include "reports/page/sections/common.hpp"
#include "reports/page/sections/sections.hpp"

namespace elastocheck::reports {
namespace {

std::string useful(const Field& floor) {
    if (floor["useful_steps"].whole() == 0) return "–";
    if (!floor["reached"].truth()) return "more still help";
    return whole_number(floor["useful_steps"].whole()) +
           (floor["at_reference_uncertainty"].truth() ? " (reference uncertainty)" : "");
}

}  // namespace

std::optional<Section> arithmetic_section(const Field& scene) {
    const auto study = scene.find("precision");
    if (!study) return std::nullopt;
    Section section{.id = "arithmetic", .title = "The arithmetic’s share"};
    section.words = {{"branch", (*study)["branch"].text()}, {"reasons", (*study)["inconclusive"].texts()}};
    Table table{.caption = fmt::format("Least errors over the step count, and the steps beyond which nothing "
                                       "is gained; end of branch {}",
                                       (*study)["branch"].text()),
                .columns = {{"method", true},
                            {"arithmetic", true},
                            {"least |Φ| [mm]"},
                            {"useful steps"},
                            {"least error [mm]"},
                            {"useful steps"}}};
    for (const auto& series : (*study)["series"].items())
        table.rows.push_back({series["method"].text(), series["arithmetic"].text(),
                              number(1e3 * series["constraint_error_floor"]["least"].number(), 2),
                              useful(series["constraint_error_floor"]),
                              number(series["error_mm_floor"]["least"].number(), 2),
                              useful(series["error_mm_floor"])});
    section.tables.push_back(std::move(table));
    return section;
}

}  // namespace elastocheck::reports
