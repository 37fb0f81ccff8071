// The signs of a drawing board as strokes on paper [px].
#pragma once

#include <vector>

#include "reports/page/labels.hpp"

namespace elastocheck::reports {

using Stroke = std::vector<Spot>;
using Strokes = std::vector<Stroke>;

Stroke ring(Spot at, double radius);
Strokes coil(Spot a, Spot b);    // a helix seen from its side; from its end a ring
Strokes damper(Spot a, Spot b);  // a tube from a, a rod to b, the piston between
Strokes barrel(Spot at, Spot along,
               double half_length);  // a sleeve about its axis `along` (foreshortened, up to 1)
Strokes cross(Spot at, double radius);
Strokes diamond(Spot at, double radius);
Strokes square(Spot at, double half_side);
Strokes hatching(Spot at);  // the ground, under what stands on it
Strokes arrow(Spot from, Spot to, bool both_ways = false);

}  // namespace elastocheck::reports
