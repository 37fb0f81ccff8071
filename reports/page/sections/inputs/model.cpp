// Section: the model as it was compiled.
#include <cctype>

#include "reports/document/inspection.hpp"
#include "reports/page/sections.hpp"

namespace elastocheck::reports {

std::optional<Section> model_section(const SceneAnalyses& scene) {
    compare::Result inspected = shortened(scene.inspected);
    std::erase_if(inspected.tables,
                  [](const Table& table) { return table.detail || table.rows.empty(); });
    if (inspected.tables.empty()) return std::nullopt;
    for (Table& table : inspected.tables) {
        table.caption[0] = static_cast<char>(std::toupper(table.caption[0]));
        table.detail = table.rows.size() > 2;
    }
    return Section{.id = "model",
                   .title = "The model as compiled",
                   .part = Part::evidence,
                   .words = {{"source", scene.scene.source}, {"hash", scene.hash}},
                   .tables = std::move(inspected.tables)};
}

}  // namespace elastocheck::reports
