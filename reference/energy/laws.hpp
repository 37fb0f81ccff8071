// The laws u(x) of elements, of one deformation and of six: value, gradient, second derivative.
//
// A law is asked at x_c + δ and answers with the *change* of u since x_c, which must keep its own relative
// accuracy however small δ is: the minimisation compares energies that differ in their last bits only. What
// deforms, and how that depends on the poses, is no matter of the law (potential.cpp).
#pragma once

#include "models/mechanism.hpp"

namespace elastocheck::reference::energy {

template <int N>
struct LawValues {
    double change = 0;                     // u(x_c + δ) - u(x_c)
    Eigen::Matrix<double, N, 1> stress_c;  // ∂u/∂x at x_c
    Eigen::Matrix<double, N, 1> stress;    // and at x_c + δ
    Eigen::Matrix<double, N, N> stiffness;  // ∂²u/∂x² at x_c + δ; on a knot, that of the piece behind it
};

using Vector1 = Eigen::Matrix<double, 1, 1>;

LawValues<1> values(const ScalarLaw& law, const Vector1& x_c, const Vector1& delta);
LawValues<6> values(const SpatialLaw& law, const Vector6& x_c, const Vector6& delta);

// Whether the energy depends on the deformation at all, and whether on the rotation θ of x = (d, θ).
bool resists(const SpatialLaw& law);
bool resists_rotation(const SpatialLaw& law);

}  // namespace elastocheck::reference::energy
