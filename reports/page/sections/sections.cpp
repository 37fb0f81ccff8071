#include "reports/page/sections/sections.hpp"

namespace elastocheck::reports {

std::vector<Section> sections_of(const Field& scene) {
    std::vector<Section> sections;
    for (const auto make :
         {verdict_section, deviation_section, price_section, drawing_section, characteristics_section, curves_section, forces_section,
          measured_section, convergence_section, attribution_section, orders_section, arithmetic_section,
          references_section, formulations_section, model_section})
        if (auto section = make(scene)) sections.push_back(std::move(*section));
    return sections;
}

}  // namespace elastocheck::reports
