#include "reports/page/sections.hpp"

namespace elastocheck::reports {

// First the results for a chassis engineer, then the accuracy of each number.
std::vector<Section> sections_of(const JsonCursor& scene) {
    struct Part {
        const char* title;
        std::vector<std::optional<Section> (*)(const JsonCursor&)> sections;
    };
    const Part parts[] = {
        {"", {candidate_section, first_section, drawing_section}},
        {"Behaviour", {characteristics_section, curves_section, forces_section}},
        {"Accuracy",
         {measured_section, verdict_section, deviation_section, price_section, convergence_section,
          attribution_section, orders_section, arithmetic_section, references_section,
          formulations_section, model_section}}};
    std::vector<Section> sections;
    for (const auto& part : parts)
        for (const auto make : part.sections)
            if (auto section = make(scene)) {
                section->part = part.title;
                sections.push_back(std::move(*section));
            }
    return sections;
}

}  // namespace elastocheck::reports
