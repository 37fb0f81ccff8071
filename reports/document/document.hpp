// result.json: all results of a comparison, for programs and for later reports.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/comparison/compare.hpp"
#include "compare/studies/formulations.hpp"
#include "compare/studies/study.hpp"
#include "elastocheck/scene.hpp"
#include "elastocheck/trim.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed; new fields do not increment it.
inline constexpr const char* result_schema = "elastocheck/result/4";

// "vertical", "left.jack", "free length of coil"
std::string driven_name(const Model& model, const Driven& what);

// {schema, reproduce, provenance, scenes: [...]}. Lengths in mm, angles in deg, forces in N,
// moments in N·m, as given by every key or neighbouring "unit". A number that is not finite is
// null. `reproduce` is the command that made it.
nlohmann::ordered_json document(const std::string& reproduce, const Provenance& provenance);

// A scene in the document: name, source, hash, compiled model. The functions below add the results,
// each under its own key; a part that was not requested is absent.
nlohmann::ordered_json scene_document(const Scene& scene, std::string_view input,
                                      const Model& model);

// "channels" and "branches": every point of every leg, deviations, certificates, what the branch does
// to the wheels; "findings", "rate_errors": key figures; "wheels": static alignment; "forces": of
// elements and links at the ends of the branches; "drawing": hardpoints at the design position and
// along the branches.
void add_comparison(nlohmann::ordered_json& scene_document, const Scene& scene, const Model& model,
                    const compare::Comparison& comparison);

// "channels", "branches" and the "verdict" of `solve`: every point of one leg, without a
// comparison.
void add_curves(nlohmann::ordered_json& scene_document, const Model& model,
                const std::vector<compare::Channel>& channels, compare::Leg leg,
                const std::string& method, const std::vector<compare::PathCurve>& branches);

// "channels" and "inspection": bodies, elements, branches and their settled states, the numbers of
// the file.
void add_inspection(nlohmann::ordered_json& scene_document, const Scene& scene, const Model& model);

// "trim": adjusted quantities, and residuals of the conditions.
void add_trim(nlohmann::ordered_json& scene_document, const compare::TrimRecord& trim);

// "formulations": table of the spread of the outputs over bushing formulations.
void add_formulations(nlohmann::ordered_json& scene_document,
                      const compare::FormulationStudy& study,
                      const compare::Comparison& comparison);

// "findings.gap": share of the formulation gap in the deviation of the published method; needs both
// results.
void add_gap(nlohmann::ordered_json& scene_document, const compare::Comparison& comparison,
             const compare::Study& study);

// "verdict": whether everything computed could be judged, the count of compared numbers, and the
// reasons if not.
void add_verdict(nlohmann::ordered_json& scene_document, int numbers_compared,
                 const std::vector<std::string>& reasons);
std::vector<std::string> reasons_of(const compare::Comparison& comparison);

}  // namespace elastocheck::reports
