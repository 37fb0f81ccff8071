// Values of force curves, and reversal of a law's sign convention.
#pragma once

#include "elastocheck/mechanism.hpp"

namespace elastocheck {

// f(x), for compile() and the reader, which need the force at the design position. Each leg has its
// own evaluation.
double force(const ScalarLaw& law, double x);

// f(x) → -f(-x): the law for the opposite sign of the deformation.
Curve reversed(const Curve& curve);
ScalarLaw reversed(const ScalarLaw& law);

// The same bushing with its markers i and j swapped; deformations, preload and undeformed offset
// change sign. A frame on j becomes a frame on i and vice versa.
Bushing markers_swapped(const Bushing& bushing);

}  // namespace elastocheck
