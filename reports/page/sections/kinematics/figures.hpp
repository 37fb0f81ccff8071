// Figures of the report's first part (kinematics): one per quantity, with the curves of all load
// cases and wheels.
#pragma once

#include <string>
#include <vector>

#include "reports/page/page.hpp"
#include "reports/page/sections/kinematics/cases.hpp"

namespace elastocheck::reports {

// Adds a curve unless one of the same load case coincides with it, as of the other wheel; returns whether it did.
bool add_curve(std::vector<DrawnCurve>& curves, DrawnCurve curve);

// The figure of these curves and some of their points as a table. `chart` has id, title,
// the names of its axes and what is drawn as rings.
FigureGroup figure_of_curves(compare::Chart chart, const std::vector<DrawnCurve>& curves,
                             const std::string& description, std::string caption = {});

// Adds a figure of every quantity that changes, or of which there are measured or candidate values.
void add_figures(Section& section, const SceneAnalyses& scene, const Family& family);

}  // namespace elastocheck::reports
