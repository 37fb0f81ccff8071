// The laws of mechanism.hpp as forces, ∂u/∂x and ∂u/∂e, for double and for Ceres' Jets: each law once,
// whatever the geometry that deforms.
#pragma once

#include "models/mechanism.hpp"
#include "reference/equilibrium/overloaded.hpp"
#include "reference/equilibrium/rotations.hpp"

namespace elastocheck::reference::equilibrium {

template <class T>
using Vec6 = Eigen::Matrix<T, 6, 1>;

// du/dx [N] at the deformation x [m]
template <class T>
T gradient(const ScalarLaw& law, const T& x) {
    return std::visit(overloaded{[&](const LinearRate& u) { return T(u.k * x); }}, law);
}

// ∂u/∂e (force [N], moment [N·m]) at the deformation e = (d [m], θ [rad])
template <class T>
Vec6<T> gradient(const SpatialLaw& law, const Vec6<T>& e) {
    return std::visit(overloaded{[&](const LinearStiffness& u) {
                          Vec6<T> g = Vec6<T>::Constant(T(0.0));
                          for (int row = 0; row < 6; ++row)
                              for (int col = 0; col < 6; ++col)
                                  if (u.K(row, col) != 0) g[row] += u.K(row, col) * e[col];
                          return g;
                      }},
                      law);
}

// Whether u depends on θ.
inline bool resists_rotation(const SpatialLaw& law) {
    return std::visit(overloaded{[](const LinearStiffness& u) {
                          return !(u.K.bottomRows<3>().isZero(0) && u.K.topRightCorner<3, 3>().isZero(0));
                      }},
                      law);
}

}  // namespace elastocheck::reference::equilibrium
