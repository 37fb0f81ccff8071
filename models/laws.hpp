// Data of force laws: values, scaling, reversal, and the curves of an element.
#pragma once

#include "elastocheck/mechanism.hpp"
#include "models/overloaded.hpp"

namespace elastocheck {

// f(x), for compile() and the reader, which need the force at the design position. Each leg has its
// own evaluation.
double force(const ScalarLaw& law, double x);

// No force at any deformation.
bool is_zero(const ScalarLaw& law);
bool is_zero(const SpatialLaw& law);

// f(x) → -f(-x): the law for the opposite sign of the deformation.
Curve reversed(const Curve& curve);
ScalarLaw reversed(const ScalarLaw& law);
// The law for deformations and forces multiplied by `signs`, each 1 or -1.
SpatialLaw with_signs(const SpatialLaw& law, const Vector6& signs);

// The law for a deformation `stretch` times and a force `force` times as large:
// f'(x) = force · f(x / stretch). A full matrix remains symmetric: its coupling terms take the
// square roots of the factors of both axes.
ScalarLaw scaled(const ScalarLaw& law, double stretch, double force);
SpatialLaw scaled(const SpatialLaw& law, const Vector6& stretch, const Vector6& force);

// Calls f(double&) for every number of a law; the entries of a symmetric matrix once each.
template <class F>
void each_number(ScalarLaw& law, F&& f) {
    std::visit(overloaded{[&](LinearRate& u) { f(u.k); },
                          [&](Curve& u) {
                              for (double& knot : u.knots) f(knot);
                              for (auto& piece : u.pieces)
                                  for (double& c : piece) f(c);
                          }},
               law);
}
template <class F>
void each_number(SpatialLaw& law, F&& f) {
    std::visit(overloaded{[&](LinearStiffness& u) {
                              for (int i = 0; i < 6; ++i)
                                  for (int j = 0; j <= i; ++j) {
                                      f(u.K(i, j));
                                      u.K(j, i) = u.K(i, j);
                                  }
                          },
                          [&](PerAxis& u) {
                              for (ScalarLaw& axis : u.axis) each_number(axis, f);
                          }},
               law);
}

// The same bushing with its markers i and j swapped; deformations, preload and undeformed offset
// change sign. A frame on j becomes a frame on i and vice versa.
Bushing markers_swapped(const Bushing& bushing);

}  // namespace elastocheck
