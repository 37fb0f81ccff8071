// Data of the drawing that is turned by hand and moved along the branches (turn.js.mustache).
#pragma once

#include <nlohmann/json.hpp>

#include "reports/document/scene_analyses.hpp"
#include "reports/page/views.hpp"

namespace elastocheck::reports {

// Lengths in 0.01 mm, whole numbers; lists of coordinates x, y, z one after the other.
//   points                       of the drawing, at the design position
//   list                         its parts, as in drawing_json()
//   view                         angles of the first view [deg]: about z from the front, above it
//   branches                     name, unit and parameter `a` of the stations, the one to `start`
//                                at, displacements `d` of the points, spin axes `e`; the positions
//                                `marks` on the figures with the abscissa `x`
// The branches of the leading sweep come first.
nlohmann::ordered_json motion_of(const SceneAnalyses& scene, const View& first);

}  // namespace elastocheck::reports
