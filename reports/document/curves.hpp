// Curves and forces as CSV.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "reports/document/scene_analyses.hpp"

namespace elastocheck::reports {

// Every point of every leg of these scenes, by their names; one number per row, since scenes differ
// in their outputs: scene,branch,leg,parameter,parameter unit,output,unit,value. An undefined value
// is an empty cell.
std::string curves_csv(
    const std::vector<std::pair<std::string, const compare::Comparison*>>& scenes);

// Forces of elements and links at the ends of the branches, with the scene's name first.
std::string forces_csv(const std::vector<SceneAnalyses>& scenes);

}  // namespace elastocheck::reports
