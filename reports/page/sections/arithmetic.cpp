// Section: step counts beyond which round-off dominates.
#include <fmt/format.h>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/tables/studies/precision_tables.hpp"

namespace elastocheck::reports {

std::optional<Section> arithmetic_section(const Field& scene) {
    const auto study = scene.find("precision");
    if (!study) return std::nullopt;
    const std::string branch = (*study)["branch"].text();
    Section section{.id = "arithmetic", .title = "The arithmetic’s share"};
    section.words = {{"branch", branch}, {"reasons", (*study)["inconclusive"].texts()}};
    section.tables.push_back(page_table(
        fmt::format(
            "Least errors over the step count, and the steps beyond which nothing is gained; "
            "end of branch {}",
            branch),
        read_table((*study)["floors"], compare::floor_table({})), floor_columns));
    return section;
}

}  // namespace elastocheck::reports
