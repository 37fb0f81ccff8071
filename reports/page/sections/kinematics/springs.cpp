// Section: travel and force of springs, stops and dampers over wheel travel, and where stops touch.
#include <fmt/format.h>

#include <algorithm>

#include "reports/page/sections.hpp"
#include "reports/page/sections/kinematics/figures.hpp"
#include "reports/page/sections/kinematics/spring_forces.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::optional<Section> springs_section(const SceneAnalyses& scene) {
    const auto sweep = leading_sweep(scene);
    const auto& wheels = scene.model.wheels;
    if (wheels.empty() || !sweep || !sweep->lifts()) return std::nullopt;
    Section section{
        .id = "springs", .title = "Springs, stops and dampers", .part = Part::behaviour};
    std::vector<Bundle> bundles;
    std::vector<std::string> contacts;
    Series marks{
        .title = "a stop touches", .style = Series::Style::rings, .colour = ink, .mark = 5};
    for (const auto& force : spring_forces(scene, *sweep)) {
        std::vector<double> touches;
        auto rows = curve_of(force, touches);
        if (std::ranges::all_of(rows, [](const auto& row) { return row[1] == 0; })) continue;
        auto bundle = std::ranges::find(bundles, force.element, &Bundle::title);
        if (bundle == bundles.end()) bundle = bundles.insert(bundle, Bundle{force.element});
        const auto before = bundle->lines.size();
        bundle->add(wheels[force.wheel].name, std::move(rows));
        if (bundle->lines.size() == before) continue;  // as of the other wheel
        for (const double at : touches) {
            marks.rows.push_back({at, 0});
            contacts.push_back(fmt::format("{} at {}\u00a0mm", force.element, number(at)));
        }
    }
    if (!bundles.empty()) {
        if (!marks.rows.empty()) bundles.back().others.push_back(std::move(marks));
        Figure figure{
            .id = "force-springs",
            .title = "Force of springs and stops",
            .description = fmt::format("Force of springs and stops over wheel travel, {}, "
                                       "by the full solution at its stations.",
                                       sweep->name),
            .x = "wheel travel [mm]",
            .y = "force [N]"};
        section.figures.push_back(
            drawn(std::move(figure), std::move(bundles), wheels,
                  contacts.empty() ? "Compression positive"
                                   : "Compression positive; touches: " + enumerated(contacts)));
    }
    add_figures(section, scene,
                {.id = "springs",
                 .x = "wheel travel [mm]",
                 .by = By::travel,
                 .cases = {{*sweep, SweepCurve(scene, *sweep)}},
                 .quantities = compare::drawn_over(compare::Over::springs),
                 .if_given = false});
    if (section.figures.empty()) return std::nullopt;
    section.words["branch"] = sweep->name;
    return section;
}

}  // namespace elastocheck::reports
