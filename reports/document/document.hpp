// result.json: everything a comparison found, for machines and for later reports.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/compare.hpp"
#include "compare/formulations.hpp"
#include "compare/study.hpp"
#include "compare/trim.hpp"
#include "models/scene.hpp"
#include "recursive/diagnosis.hpp"
#include "reports/document/provenance.hpp"

namespace elastocheck::reports {

// Raised when a field changes its meaning or vanishes; new fields may appear without.
inline constexpr const char* result_schema = "elastocheck/result/3";

// "vertical", "left.jack", "free length of coil"
std::string driven_name(const Model& model, const Driven& what);

// {schema, reproduce, provenance, scenes: [...]}. Lengths in mm, angles in deg, forces in N, moments in N·m,
// as every key or neighbouring "unit" says. A number that is not finite is null. `reproduce` is the command
// that made it.
nlohmann::ordered_json document(const std::string& reproduce, const Provenance& provenance);

// A scene in it: name, source, hash, model as compiled. What was computed is added by those below, each under
// a key of its own; a part that was not asked for is absent.
nlohmann::ordered_json scene_document(const Scene& scene, std::string_view input, const Model& model,
                                      const recursive::Diagnosis& diagnosis);

// "channels" and "branches": every point of every leg, deviations, certificates; "findings", "rate_errors":
// what they come to; "forces": of elements and links at the ends of the branches; "drawing": where the
// hardpoints are at the design position and along the branches.
void add_comparison(nlohmann::ordered_json& scene_document, const Scene& scene, const Model& model,
                    const compare::Comparison& comparison);

// "channels", "branches" and the "verdict" of `solve`: every point of the one leg, and no comparison.
void add_curves(nlohmann::ordered_json& scene_document, const Model& model,
                const std::vector<compare::Channel>& channels, compare::Leg leg, const std::string& method,
                const std::vector<compare::Walked>& branches);

// "channels" and "inspection": bodies, elements, branches and where they settle, the numbers of the file.
void add_inspection(nlohmann::ordered_json& scene_document, const Scene& scene, const Model& model);

// "trim": what was adjusted, and how well the conditions are met.
void add_trim(nlohmann::ordered_json& scene_document, const compare::TrimRecord& trim);

// "formulations": how much the outputs depend on what a bushing is taken to measure, a table of spreads.
void add_formulations(nlohmann::ordered_json& scene_document, const compare::FormulationStudy& study,
                      const compare::Comparison& comparison);

// "findings.gap": what part of the published deviation is the formulation's, once both are there.
void add_gap(nlohmann::ordered_json& scene_document, const compare::Comparison& comparison,
             const compare::Study& study);

// "verdict": whether all that was computed could be judged, on how many numbers, and why not.
void add_verdict(nlohmann::ordered_json& scene_document, int numbers_compared,
                 const std::vector<std::string>& reasons);
std::vector<std::string> reasons_of(const compare::Comparison& comparison);

}  // namespace elastocheck::reports
