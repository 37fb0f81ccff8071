// Sections of a scene's report, in order. A new section takes a function here, a text template, and
// a line in sections.cpp.
#pragma once

#include <optional>
#include <vector>

#include "reports/document/scene_analyses.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// Each makes a section from the results of a scene; empty if these have no data for it.
std::optional<Section> against_section(const SceneAnalyses& scene);
std::optional<Section> candidate_section(const SceneAnalyses& scene);
std::optional<Section> first_section(const SceneAnalyses& scene);
std::optional<Section> conditions_section(const SceneAnalyses& scene);
std::optional<Section> drawing_section(const SceneAnalyses& scene);
std::optional<Section> kinematics_section(const SceneAnalyses& scene);
std::optional<Section> roll_section(const SceneAnalyses& scene);
std::optional<Section> springs_section(const SceneAnalyses& scene);
std::optional<Section> steering_section(const SceneAnalyses& scene);
std::optional<Section> compliance_section(const SceneAnalyses& scene);
std::optional<Section> curves_section(const SceneAnalyses& scene);
std::optional<Section> gradients_section(const SceneAnalyses& scene);
std::optional<Section> rates_section(const SceneAnalyses& scene);
std::optional<Section> forces_section(const SceneAnalyses& scene);
std::optional<Section> loads_section(const SceneAnalyses& scene);
std::optional<Section> measured_section(const SceneAnalyses& scene);
std::optional<Section> methods_section(const SceneAnalyses& scene);
std::optional<Section> change_section(const SceneAnalyses& scene);
std::optional<Section> deviation_section(const SceneAnalyses& scene);
std::optional<Section> price_section(const SceneAnalyses& scene);
std::optional<Section> convergence_section(const SceneAnalyses& scene);
std::optional<Section> references_section(const SceneAnalyses& scene);
std::optional<Section> formulations_section(const SceneAnalyses& scene);
std::optional<Section> model_section(const SceneAnalyses& scene);

// Rates for the first screen; without columns if the scene has none.
Table key_rates(const SceneAnalyses& scene);

std::vector<Section> sections_of(const SceneAnalyses& scene);

}  // namespace elastocheck::reports
