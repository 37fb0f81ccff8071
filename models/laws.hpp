// Force laws of springs and bushings: values, scaling, reversal.
#pragma once

#include "elastocheck/mechanism.hpp"

namespace elastocheck {

// f(x), for compile() and the reader, which need the force at the design position. Each leg has its
// own evaluation.
double force(const ScalarLaw& law, double x);

// No force at any deformation.
bool is_zero(const ScalarLaw& law);
bool is_zero(const SpatialLaw& law);

// The law x ↦ -f(-x), of the same element with the opposite sign of its deformation.
Curve reversed(const Curve& curve);
ScalarLaw reversed(const ScalarLaw& law);
// The law for deformations and forces multiplied by `signs`, each 1 or -1.
SpatialLaw with_signs(const SpatialLaw& law, const Vector6& signs);

// The law for a deformation `stretch` times and a force `force` times as large: f'(x) = force · f(x / stretch).
// A full matrix remains symmetric: its coupling terms take the square roots of the factors of both axes.
ScalarLaw scaled(const ScalarLaw& law, double stretch, double force);
SpatialLaw scaled(const SpatialLaw& law, const Vector6& stretch, const Vector6& force);

// The same bushing with its markers i and j swapped; deformations, preload and undeformed offset
// change sign. A frame on j becomes a frame on i and vice versa.
Bushing markers_swapped(const Bushing& bushing);

}  // namespace elastocheck
