// Section: the suspension in three views, with a table of its points.
#include <fmt/format.h>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/suspension.hpp"

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
    Table& table = group.table = points_table(suspension.points);
    table.caption = fmt::format("Points at the design position{}",
                                moved.empty() ? "" : ", and their displacements (Δ)");
    for (const auto& position : suspension.moved)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            table.columns.push_back({.name = fmt::format("{} Δ{}", position.title, "xyz"[axis]),
                                     .unit = "mm",
                                     .digits = Digits::deviation});
            for (std::size_t k = 0; k < table.rows.size(); ++k) {
                const auto& point = suspension.points[k];
                table.rows[k].emplace_back(point.body == "ground"
                                               ? compare::nan
                                               : position.points[k][axis] - point.at[axis]);
            }
        }
    section.figures.push_back(std::move(group));
    return section;
}

}  // namespace elastocheck::reports
