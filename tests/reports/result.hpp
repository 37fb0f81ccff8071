// Samples of what `report` finds on a scene, with all parts, for tests of pages and documents.
#pragma once

#include <string>
#include <vector>

#include "reports/document/scene_analyses.hpp"
#include "reports/page/report/report.hpp"
#include "tests/reports/documents.hpp"

namespace elastocheck::reports {

// Made once per scene.
const SceneAnalyses& sample_scene(const std::string& scene = "chrono_mcpherson");

// Of a scene of this name, without studies.
SceneAnalyses small_scene(const std::string& name = "small");

// Without the studies and the judgement: trimmed and compared alone.
const SceneAnalyses& compared_scene(const std::string& scene);

Report report_of(std::vector<SceneAnalyses> scenes);

// Of the equilibrium leg.
compare::Curve& truth_of(compare::BranchComparison& branch);
// Position of a channel. Pre: there is one.
std::size_t channel_of(const SceneAnalyses& scene, std::string_view name);

}  // namespace elastocheck::reports
