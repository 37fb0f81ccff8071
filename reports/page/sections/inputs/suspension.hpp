// The drawing of a scene with the positions at the ends of its leading sweep.
#pragma once

#include "reports/document/scene_analyses.hpp"
#include "reports/page/views.hpp"

namespace elastocheck::reports {

Suspension suspension_of(const SceneAnalyses& scene);

// Names, bodies and coordinates of points, as a table of details.
Table points_table(const std::vector<Suspension::Point>& points);

// "suspension", or "mechanism" for a scene without a wheel.
const char* noun_of(const Suspension& suspension);

// Whether all wheels are on the right side; y points left.
bool is_right(const Suspension& suspension);

}  // namespace elastocheck::reports
