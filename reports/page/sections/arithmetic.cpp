// Section: step counts beyond which round-off dominates.
#include <fmt/format.h>

#include "compare/tables/rows.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"

namespace elastocheck::reports {

std::optional<Section> arithmetic_section(const JsonCursor& scene) {
    const auto study = scene.find("precision");
    if (!study) return std::nullopt;
    const std::string branch = (*study)["branch"].text();
    Section section{.id = "arithmetic", .title = "Round-off", .part = Part::evidence};
    section.words = {{"branch", branch}, {"reasons", (*study)["inconclusive"].texts()}};
    section.tables.push_back(
        page_table(fmt::format("Smallest errors over the number of steps, and the number of steps "
                               "beyond which the error no longer falls; end of branch {}",
                               branch),
                   read_rows<compare::FloorRow>((*study)["floors"])));
    return section;
}

}  // namespace elastocheck::reports
