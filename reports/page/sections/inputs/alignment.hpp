// The static alignment, and what the trim made of it.
#pragma once

#include "reports/document/scene_analyses.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

// No finer than a thousandth of a mm or deg, or a column would be of zeros and one digit.
double settled_value(double value);

// As drawn and as settled, left and right as columns.
Table alignment_table(const SceneAnalyses& scene);

// What the trim adjusted. Preloads of balanced bushings are listed with the model.
Table trim_table(const SceneAnalyses& scene);

}  // namespace elastocheck::reports
