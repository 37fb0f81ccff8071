// Section: travel and force of springs, stops and dampers over wheel travel, and where stops touch.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "models/kinds.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/kinematics/cases.hpp"
#include "reports/page/sections/kinematics/figures.hpp"
#include "reports/tables/elements.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

// Force of a spring or stop over the travel of its wheel, at the stations of the leading sweep.
struct SpringForce {
    std::string element;  // "coil bump stop"
    std::size_t wheel = 0;
    double clearance = compare::nan;                 // of a stop [mm]
    std::vector<std::vector<double>> stations = {};  // travel, force, deformation
};

std::vector<SpringForce> spring_forces(const SceneAnalyses& scene, const Sweep& sweep) {
    const Model& model = scene.model;
    std::vector<SpringForce> forces;
    for (const Elastic& elastic : model.elastics) {
        const auto* law = member<ScalarLaw>(elastic.kind);
        const auto owner = wheel_of(elastic.name, model.wheels);
        if (law == nullptr || !owner) continue;
        SpringForce force{owner->first, owner->second};
        for (const auto& branch : sweep.branches)
            std::ranges::move(force_over_travel(model, *branch.requested, *branch.result,
                                                elastic.name, owner->second),
                              std::back_inserter(force.stations));
        if (force.stations.empty()) continue;
        std::ranges::stable_sort(force.stations, {}, [](const auto& row) { return row[0]; });
        if (elastic.written_as == WrittenAs::stop)
            force.clearance = 1e3 * clearance_of(*law).value_or(compare::nan);
        forces.push_back(std::move(force));
    }
    return forces;
}

// The curve with an additional point where a stop touches, also added to `touches`: where the
// deformation equals the clearance, between a station without force and one with force.
std::vector<std::vector<double>> curve_of(const SpringForce& force, std::vector<double>& touches) {
    std::vector<std::vector<double>> rows;
    for (std::size_t k = 0; k < force.stations.size(); ++k) {
        const auto& at = force.stations[k];
        if (k > 0 && std::isfinite(force.clearance)) {
            const auto& before = force.stations[k - 1];
            const double from = std::abs(before[2]) - force.clearance,
                         to = std::abs(at[2]) - force.clearance;
            if ((before[1] == 0) != (at[1] == 0) && from * to < 0) {
                touches.push_back(before[0] + (at[0] - before[0]) * from / (from - to));
                rows.push_back({touches.back(), 0});
            }
        }
        rows.push_back({without_rounding(at[0]), without_rounding(at[1])});
    }
    return rows;
}

}  // namespace

std::optional<Section> springs_section(const SceneAnalyses& scene) {
    const auto sweep = leading_sweep(scene);
    const auto& wheels = scene.model.wheels;
    if (wheels.empty() || !sweep || !sweep->lifts()) return std::nullopt;
    Section section{
        .id = "springs", .title = "Springs, stops and dampers", .part = Part::behaviour};
    std::vector<DrawnCurve> curves;
    std::vector<std::string> contacts;
    DrawnCurve marks{"a stop touches"};
    for (const auto& force : spring_forces(scene, *sweep)) {
        std::vector<double> touches;
        auto rows = curve_of(force, touches);
        if (std::ranges::all_of(rows, [](const auto& row) { return row[1] == 0; })) continue;
        if (!add_curve(curves, {force.element, wheels[force.wheel].name, std::move(rows)}))
            continue;  // coincides with that of the other wheel
        for (const double at : touches) {
            marks.rows.push_back({at, 0});
            contacts.push_back(fmt::format("{} at {}\u00a0mm", force.element, number(at)));
        }
    }
    if (!marks.rows.empty()) curves.push_back(marks);
    if (!curves.empty())
        section.figures.push_back(figure_of_curves(
            {.id = "force-springs",
             .title = "Force of springs and stops",
             .x = "wheel travel [mm]",
             .y = {"force [N]"},
             .rings = {marks.legend}},
            curves,
            fmt::format("Force of springs and stops over wheel travel, {}, by the full solution at "
                        "its stations.",
                        sweep->name),
            contacts.empty() ? "Compression positive"
                             : "Compression positive; touches: " + enumerated(contacts)));
    add_figures(section, scene,
                {.id = "springs",
                 .x = "wheel travel [mm]",
                 .by = By::travel,
                 .cases = {{*sweep, SweepCurve(scene, *sweep)}},
                 .quantities = compare::figures_over(compare::DrawnAbscissa::springs),
                 .with_given_only = false});
    if (section.figures.empty()) return std::nullopt;
    section.words["branch"] = sweep->name;
    return section;
}

}  // namespace elastocheck::reports
