// Symbols of technical drawings as strokes on paper [px].
#pragma once

#include <vector>

#include "reports/text/labels.hpp"

namespace elastocheck::reports {

using Stroke = std::vector<PaperPoint>;
using Strokes = std::vector<Stroke>;

Stroke ring(PaperPoint centre, double radius);
Strokes coil(PaperPoint a, PaperPoint b);    // coil spring in side view; a ring in end view
Strokes damper(PaperPoint a, PaperPoint b);  // a tube from a, a rod to b, the piston between
// A sleeve along its axis `along` (foreshortened, length up to 1).
Strokes barrel(PaperPoint centre, PaperPoint along, double half_length);
Strokes cross(PaperPoint centre, double radius);
Strokes diamond(PaperPoint centre, double radius);
Strokes square(PaperPoint centre, double half_side);
Strokes hatching(PaperPoint centre);  // ground symbol
Strokes arrow(PaperPoint from, PaperPoint to, bool both_ways = false);

}  // namespace elastocheck::reports
