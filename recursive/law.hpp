// The laws of the elastic elements: energy u of a deformation, its gradient and its Hessian. The geometry
// (elastic.hpp, tangent.hpp) does the rest, so that a new law is a new overload here and nothing elsewhere.
//
// The Hessian is asked for more often than the deformation is at hand: it takes a function that gives the
// deformation where the law needs it.
#pragma once

#include "recursive/state.hpp"

namespace elastocheck::recursive {

// ---- Of one deformation x [m]: u'(x) [N], u''(x) [N/m].

template <class Real>
Real gradient(const LinearRate& law, Real x) {
    return static_cast<Real>(law.k) * x;
}
template <class Real, class Deformation>
Real hessian(const LinearRate& law, Deformation&&) {
    return static_cast<Real>(law.k);
}

// ---- Of six, e = (d, θ) [m, rad]: ∂u/∂e [N, N·m], ∂²u/∂e² [N/m  N; N  N·m/rad].

template <class Real>
Vector6<Real> gradient(const LinearStiffness& law, const Vector6<Real>& e) {
    return law.K.cast<Real>() * e;
}
template <class Real, class Deformation>
Matrix6<Real> hessian(const LinearStiffness& law, Deformation&&) {
    return law.K.cast<Real>();
}
// Whether the law answers to rotation at all, at any deformation.
inline bool rotational(const LinearStiffness& law) { return !law.K.rightCols<3>().isZero(0); }

// ---- Whichever law it is.

template <class Real>
Real gradient(const ScalarLaw& law, Real x) {
    return std::visit([&](const auto& kind) { return gradient<Real>(kind, x); }, law);
}
template <class Real, class Deformation>
Real hessian(const ScalarLaw& law, Deformation&& x) {
    return std::visit([&](const auto& kind) { return hessian<Real>(kind, x); }, law);
}
template <class Real>
Vector6<Real> gradient(const SpatialLaw& law, const Vector6<Real>& e) {
    return std::visit([&](const auto& kind) { return gradient<Real>(kind, e); }, law);
}
template <class Real, class Deformation>
Matrix6<Real> hessian(const SpatialLaw& law, Deformation&& e) {
    return std::visit([&](const auto& kind) { return hessian<Real>(kind, e); }, law);
}
inline bool rotational(const SpatialLaw& law) {
    return std::visit([](const auto& kind) { return rotational(kind); }, law);
}

}  // namespace elastocheck::recursive
