// result.json: all results of a comparison, for other programs.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "compare/comparison/compare.hpp"
#include "elastocheck/scene.hpp"
#include "reports/document/scene_analyses.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed; new fields do not increment it.
inline constexpr const char* result_schema = "elastocheck/result/6";

// "vertical", "left.jack", "free length of coil"
std::string driven_name(const Model& model, const Driven& driven);

// {schema, reproduce, provenance, scenes: [...]}. Lengths in mm, angles in deg, forces in N,
// moments in N·m, as given by every key or neighbouring "unit". A number that is not finite is
// null. `reproduce` is the command that made it.
nlohmann::ordered_json document(const std::string& reproduce, const Provenance& provenance);

// A scene in the document without results: name, source, hash of its file, warnings.
nlohmann::ordered_json scene_head(const SceneAnalyses& scene);
// A compared scene: its curves and deviations (compared_json); with the results of all other
// analyses of it (scene_json).
nlohmann::ordered_json compared_json(const SceneAnalyses& scene);
nlohmann::ordered_json scene_json(const SceneAnalyses& scene);

// The tables of a comparison that are only in files.
void add_tables(compare::Result& compared, const SceneAnalyses& scene);

// "channels" and "branches" of `solve`: every point of the runs of each branch, without a comparison.
void add_curves(nlohmann::ordered_json& scene_document, const Model& model,
                const std::vector<compare::Channel>& channels,
                std::span<const compare::BranchComparison> branches);

// "verdict": whether everything computed could be judged, the count of compared numbers, and the
// reasons if not.
void add_verdict(nlohmann::ordered_json& scene_document, int numbers_compared,
                 const std::vector<std::string>& reasons);

}  // namespace elastocheck::reports
