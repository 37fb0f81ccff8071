// Section: the suspension in three views, with a table of its points.
#include <fmt/format.h>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/suspension.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::optional<Section> drawing_section(const SceneAnalyses& scene) {
    const Suspension suspension = suspension_of(scene);
    const std::string noun = noun_of(suspension);
    Section section{.id = "drawing",
                    .title = fmt::format("The {} in three views", noun),
                    .part = Part::behaviour};
    section.words["wheel"] = !suspension.wheels.empty();
    std::vector<std::string> moved;
    for (const auto& position : suspension.moved) moved.push_back(position.title);
    FigureGroup group;
    const std::vector<View> views{front_view, side_view, top_view};
    group.figures = draw_views(suspension, views, small_frame(suspension));
    for (std::size_t k = 0; k < views.size(); ++k)
        group.figures[k].description = fmt::format(
            "The {} {} at the design position, to scale{}. The coordinates are in the table.", noun,
            views[k].from,
            moved.empty() ? "" : ", with it at " + enumerated(moved) + " in pale lines");
    group.caption = "All three views have one scale.";
    Table& table = group.table;
    table.caption = fmt::format("Points at the design position{}",
                                moved.empty() ? "" : ", and their displacements (Δ)");
    table.columns = {{"point", true}, {"on", true}, {"x [mm]"}, {"y [mm]"}, {"z [mm]"}};
    for (const auto& position : suspension.moved)
        for (const char* axis : {"Δx", "Δy", "Δz"})
            table.columns.push_back({fmt::format("{} {} [mm]", position.title, axis)});
    table.folded = true;
    for (std::size_t k = 0; k < suspension.points.size(); ++k) {
        const auto& point = suspension.points[k];
        std::vector<std::string> row{point.name, point.body};
        for (const double v : point.at) row.push_back(number(v, 4));
        for (const auto& position : suspension.moved)
            for (std::size_t axis = 0; axis < 3; ++axis)
                row.push_back(point.body == "ground"
                                  ? "–"
                                  : deviation_number(position.points[k][axis] - point.at[axis]));
        table.rows.push_back(row);
    }
    section.figures.push_back(std::move(group));
    return section;
}

}  // namespace elastocheck::reports
