// Sections of a scene's report, in order. A new section takes a function here, a text template, and
// a line in sections.cpp.
#pragma once

#include <optional>
#include <vector>

#include "reports/json/json_cursor.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// Each makes its section from one scene of result.json, or none if the scene has no data for it.
// Throws ResultError for missing fields.
std::optional<Section> against_section(const JsonCursor& scene);
std::optional<Section> candidate_section(const JsonCursor& scene);
std::optional<Section> first_section(const JsonCursor& scene);
std::optional<Section> drawing_section(const JsonCursor& scene);
std::optional<Section> kinematics_section(const JsonCursor& scene);
std::optional<Section> steering_section(const JsonCursor& scene);
std::optional<Section> compliance_section(const JsonCursor& scene);
std::optional<Section> curves_section(const JsonCursor& scene);
std::optional<Section> rates_section(const JsonCursor& scene);
std::optional<Section> forces_section(const JsonCursor& scene);
std::optional<Section> measured_section(const JsonCursor& scene);
std::optional<Section> methods_section(const JsonCursor& scene);
std::optional<Section> change_section(const JsonCursor& scene);
std::optional<Section> deviation_section(const JsonCursor& scene);
std::optional<Section> price_section(const JsonCursor& scene);
std::optional<Section> convergence_section(const JsonCursor& scene);
std::optional<Section> attribution_section(const JsonCursor& scene);
std::optional<Section> references_section(const JsonCursor& scene);
std::optional<Section> formulations_section(const JsonCursor& scene);
std::optional<Section> matrices_section(const JsonCursor& scene);
std::optional<Section> model_section(const JsonCursor& scene);

// Rates for the first screen; without columns if the scene has none.
Table key_rates(const JsonCursor& scene);

std::vector<Section> sections_of(const JsonCursor& scene);

}  // namespace elastocheck::reports
