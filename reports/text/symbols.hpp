// Symbols of technical drawings as strokes on paper [px].
#pragma once

#include <vector>

#include "reports/text/labels.hpp"

namespace elastocheck::reports {

using Stroke = std::vector<Spot>;
using Strokes = std::vector<Stroke>;

Stroke ring(Spot at, double radius);
Strokes coil(Spot a, Spot b);    // coil spring in side view; a ring in end view
Strokes damper(Spot a, Spot b);  // a tube from a, a rod to b, the piston between
Strokes barrel(Spot at, Spot along,
               // a sleeve along its axis `along` (foreshortened, length up to 1)
               double half_length);
Strokes cross(Spot at, double radius);
Strokes diamond(Spot at, double radius);
Strokes square(Spot at, double half_side);
Strokes hatching(Spot at);  // ground symbol
Strokes arrow(Spot from, Spot to, bool both_ways = false);

}  // namespace elastocheck::reports
