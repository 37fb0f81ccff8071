// Curves as data: their values, and the same law told the other way round.
#pragma once

#include "models/mechanism.hpp"

namespace elastocheck {

// f(x), for those who ask what an element is at the design position (compile() and the reader). A leg evaluates its
// laws by itself.
double force(const ScalarLaw& law, double x);

// f(x) → -f(-x): the law of the deformation counted the other way.
Curve reversed(const Curve& curve);
ScalarLaw reversed(const ScalarLaw& law);

// The same bushing with its markers changed over: i is j, j is i, deformations, preload and undeformed offset
// count the other way. What was a frame on j is a frame on i, and the other way round.
Bushing turned_round(const Bushing& bushing);

}  // namespace elastocheck
