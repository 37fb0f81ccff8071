// Sections: figures over the travel of each wheel; over the roll of an axle.

#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/measured.hpp"
#include "reports/page/sections/kinematics/figures.hpp"

namespace elastocheck::reports {

std::optional<Section> kinematics_section(const SceneAnalyses& scene) {
    const auto cases = cases_of(scene, &Sweep::lifts);
    if (scene.model.wheels.empty() || cases.empty()) return std::nullopt;
    Section section{.id = "kinematics", .title = "Kinematics over travel", .part = Part::behaviour};
    section.words["several"] = scene.model.wheels.size() > 1;
    std::vector<Case> by_parameter;
    Family family{"travel",
                  "wheel travel [mm]",
                  By::travel,
                  {},
                  compare::figures_over(compare::DrawnAbscissa::travel)};
    for (const auto& c : cases)
        (measured_over_parameter(scene, c.sweep) ? by_parameter : family.cases).push_back(c);
    add_figures(section, scene, family);
    for (const auto& c : by_parameter)
        add_figures(section, scene,
                    {slug(c.sweep.name), c.sweep.parameter, By::parameter, {c}, family.quantities});
    return section;
}

std::optional<Section> roll_section(const SceneAnalyses& scene) {
    const Family family{"roll",
                        "roll angle [deg]",
                        By::roll,
                        cases_of(scene, [](const Sweep& s) { return s.kind == "roll"; }),
                        compare::figures_over(compare::DrawnAbscissa::roll),
                        false};
    Section section{.id = "roll", .title = "Roll of the axle", .part = Part::behaviour};
    add_figures(section, scene, family);
    if (section.figures.empty()) return std::nullopt;
    return section;
}

}  // namespace elastocheck::reports
