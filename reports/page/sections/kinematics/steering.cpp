// Sections: figures over the steering, over forces and moments in the road plane, over other drives.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/given/wheels.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/kinematics/figures.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::DrawnAbscissa;
using compare::figures_over;

// Diameter of the circle that the outer front wheel's patch follows, the rear wheels rolling along
// it: 2 l / sin δ of the smaller angle.
std::string turning_circle(const SceneAnalyses& scene, const Case& c) {
    if (!scene.model.vehicle) return {};
    double angle = INFINITY;
    for (const std::size_t k : {std::size_t{0}, c.curve.a.size() - 1}) {
        if (k == c.curve.start) continue;
        for (const auto& wheel : scene.model.wheels) {
            const auto toe = c.curve.channel(output_of(wheel, compare::figure::toe));
            if (!toe.empty()) angle = std::min(angle, std::abs(toe[k]));
        }
    }
    if (!(angle > 2 && angle < 90)) return {};
    const double wheelbase_mm = 1e3 * scene.model.vehicle->wheelbase;
    return fmt::format("{}\u00a0m", number(2e-3 * wheelbase_mm / std::sin(angle * M_PI / 180)));
}

// The main outputs of a scene without wheels, and the efforts of what the parameter drives.
std::vector<Quantity> all_outputs(const SceneAnalyses& scene, const std::vector<Case>& cases) {
    std::vector<Quantity> quantities;
    const auto& channels = scene.comparison.channels;
    for (const auto& c : channels) {
        const bool drives = std::ranges::any_of(cases, [&](const Case& k) {
            const auto efforts = efforts_of(*k.sweep.branches.front().requested, channels);
            return std::ranges::find(efforts, c.name) != efforts.end();
        });
        if (c.main || drives)
            quantities.push_back(
                {c.name, as_words(c.name), "",
                 drives ? compare::Presentation::as_is : compare::Presentation::change});
    }
    return quantities;
}

}  // namespace

std::optional<Section> steering_section(const SceneAnalyses& scene) {
    const auto cases = cases_of(scene, [](const Sweep& s) { return s.kind == "steering"; });
    if (cases.empty()) return std::nullopt;
    Section section{.id = "steering", .title = "Steering", .part = Part::behaviour};
    for (const auto& c : cases) {
        add_figures(section, scene,
                    {slug(c.sweep.name),
                     c.sweep.parameter,
                     By::parameter,
                     {c},
                     figures_over(DrawnAbscissa::steering)});
        if (const std::string circle = turning_circle(scene, c); !circle.empty())
            section.words["circle"] = circle;
    }
    return section;
}

std::optional<Section> compliance_section(const SceneAnalyses& scene) {
    const auto cases = cases_of(scene, is_force_test);
    if (scene.model.wheels.empty() || cases.empty()) return std::nullopt;
    Section section{.id = "compliance",
                    .title = "Compliance under forces and moments",
                    .part = Part::behaviour};
    for (const bool moment : {false, true}) {
        const std::string unit = moment ? "N·m" : "N", id = moment ? "moment" : "force";
        Family family{.id = id, .x = fmt::format("{} [{}]", id, unit), .by = By::push};
        for (const auto& c : cases)
            if (c.sweep.unit == unit) family.cases.push_back(c);
        family.quantities = figures_over(DrawnAbscissa::load);
        if (moment) family.quantities.resize(2);
        add_figures(section, scene, family);
    }
    return section;
}

std::optional<Section> curves_section(const SceneAnalyses& scene) {
    const bool no_wheels = scene.model.wheels.empty();
    const auto cases = cases_of(scene, [&](const Sweep& s) {
        return no_wheels || !(s.lifts() || s.kind == "steering" || is_force_test(s));
    });
    if (cases.empty()) return std::nullopt;
    Section section{.id = "curves", .title = "Outputs over load or drive", .part = Part::behaviour};
    std::vector<std::string> done;
    for (const auto& c : cases) {
        const std::string& x = c.sweep.parameter;
        if (std::ranges::find(done, x) != done.end()) continue;
        done.push_back(x);
        Family family{slug(c.sweep.name), x};
        for (const auto& other : cases)
            if (other.sweep.parameter == x) family.cases.push_back(other);
        family.quantities =
            no_wheels ? all_outputs(scene, family.cases) : figures_over(DrawnAbscissa::load);
        add_figures(section, scene, family);
    }
    if (section.figures.empty()) return std::nullopt;
    return section;
}

}  // namespace elastocheck::reports
