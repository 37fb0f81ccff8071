#include "reports/page/sections.hpp"

namespace elastocheck::reports {

// First the results for a chassis engineer, then the fast methods and the evidence.
std::vector<Section> sections_of(const SceneAnalyses& scene) {
    constexpr std::optional<Section> (*makers[])(const SceneAnalyses&) = {
        against_section,   candidate_section,   first_section,        conditions_section,
        drawing_section,   measured_section,    kinematics_section,   roll_section,
        springs_section,   steering_section,    compliance_section,   curves_section,
        gradients_section, rates_section,       forces_section,       loads_section,
        change_section,    methods_section,     references_section,   deviation_section,
        price_section,     convergence_section, formulations_section, model_section};
    const auto left_out = [&](Part part) {
        return !scene.only.empty() &&
               part == (scene.only == "kc" ? Part::evidence : Part::behaviour);
    };
    std::vector<Section> sections;
    for (const auto make : makers)
        if (auto section = make(scene); section && !left_out(section->part))
            sections.push_back(std::move(*section));
    return sections;
}

}  // namespace elastocheck::reports
