// Elastic laws u(x) of one and of six deformations: value, gradient, second derivative.
//
// A law is evaluated at x_c + δ and returns the *change* of u since x_c, to its own relative
// accuracy however small δ is: the minimisation compares energies that differ only in their last
// bits. The deformation as a function of the poses is in potential.cpp.
#pragma once

#include "elastocheck/mechanism.hpp"

namespace elastocheck::reference::energy {

template <int N>
struct LawValues {
    double change = 0;                     // u(x_c + δ) - u(x_c)
    Eigen::Matrix<double, N, 1> stress_c;  // ∂u/∂x at x_c
    Eigen::Matrix<double, N, 1> stress;    // and at x_c + δ
    // ∂²u/∂x² at x_c + δ; at a knot, that of the following piece
    Eigen::Matrix<double, N, N> stiffness;
};

using Vector1 = Eigen::Matrix<double, 1, 1>;

LawValues<1> values(const ScalarLaw& law, const Vector1& x_c, const Vector1& delta);
LawValues<6> values(const SpatialLaw& law, const Vector6& x_c, const Vector6& delta);

// Whether the energy depends on the deformation at all, and on the rotation θ of x = (d, θ).
bool resists(const SpatialLaw& law);
bool resists_rotation(const SpatialLaw& law);

}  // namespace elastocheck::reference::energy
