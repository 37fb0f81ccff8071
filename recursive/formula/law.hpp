// Force laws of the elastic elements: energy u of a deformation, its gradient and Hessian.
// The geometry (measure.hpp, elastic.hpp, tangent.hpp) is separate, so that a new law is one
// overload here.
//
// The Hessian takes a function that returns the deformation, which only nonlinear laws call: many
// callers have not computed the deformation.
//
// A curve is a polynomial only between two knots. A step with smooth equations uses the polynomial
// of one piece and continues it beyond its ends; callers select that piece by its number.
#pragma once

#include <algorithm>
#include <array>

#include "models/kinds.hpp"
#include "recursive/formula/state.hpp"

namespace elastocheck::recursive {

// Number of a curve's piece, 0 before the first knot; `wherever`: the piece that contains the
// deformation.
using Piece = int;
inline constexpr Piece wherever = -1;
using Pieces = std::array<Piece, 6>;
inline constexpr Pieces everywhere{wherever, wherever, wherever, wherever, wherever, wherever};

// Number of knots at or before x.
template <class Real>
Piece piece_at(const Curve& f, Real x) {
    const auto beyond =
        std::upper_bound(f.knots.begin(), f.knots.end(), x,
                         [](Real at, double knot) { return at < static_cast<Real>(knot); });
    return static_cast<Piece>(beyond - f.knots.begin());
}

// A piece c_0 + c_1 t + c_2 t² + c_3 t³ evaluated at x: its coefficients, and t = x - x_k.
template <class Real>
struct Cubic {
    const std::array<double, 4>& c;
    Real t;

    Real coefficient(std::size_t n) const { return static_cast<Real>(c[n]); }
    Real value() const {
        return coefficient(0) + t * (coefficient(1) + t * (coefficient(2) + t * coefficient(3)));
    }
    Real slope() const {
        return coefficient(1) + t * (2 * coefficient(2) + t * (3 * coefficient(3)));
    }
};
template <class Real>
Cubic<Real> piece_of(const Curve& f, Real x, Piece piece) {
    const auto k = static_cast<std::size_t>(piece == wherever ? piece_at(f, x) : piece);
    return {f.pieces[k], x - static_cast<Real>(f.knots[k == 0 ? 0 : k - 1])};
}

// ---- Scalar deformation x [m or rad]: u'(x) [N or N·m], u''(x) [N/m or N·m/rad].

template <class Real>
Real gradient(const LinearRate& law, Real x, Piece = wherever) {
    return static_cast<Real>(law.k) * x;
}
template <class Real, class Deformation>
Real hessian(const LinearRate& law, Deformation&&, Piece = wherever) {
    return static_cast<Real>(law.k);
}

template <class Real>
Real gradient(const Curve& f, Real x, Piece piece = wherever) {
    return piece_of<Real>(f, x, piece).value();
}
template <class Real, class Deformation>
Real hessian(const Curve& f, Deformation&& x, Piece piece = wherever) {
    return piece_of<Real>(f, x(), piece).slope();
}

template <class Real>
Real gradient(const ScalarLaw& law, Real x, Piece piece = wherever) {
    return std::visit([&](const auto& kind) { return gradient<Real>(kind, x, piece); }, law);
}
template <class Real, class Deformation>
Real hessian(const ScalarLaw& law, Deformation&& x, Piece piece = wherever) {
    return std::visit([&](const auto& kind) { return hessian<Real>(kind, x, piece); }, law);
}

// ---- Spatial deformation e = (d, θ) [m, rad]: ∂u/∂e [N, N·m], ∂²u/∂e² [N/m  N; N  N·m/rad].

template <class Real>
Vector6<Real> gradient(const LinearStiffness& law, const Vector6<Real>& e,
                       const Pieces& = everywhere) {
    return law.K.cast<Real>() * e;
}
template <class Real, class Deformation>
Matrix6<Real> hessian(const LinearStiffness& law, Deformation&&, const Pieces& = everywhere) {
    return law.K.cast<Real>();
}
// Whether the law depends on rotation.
inline bool rotational(const LinearStiffness& law) { return !law.K.rightCols<3>().isZero(0); }

template <class Real>
Vector6<Real> gradient(const PerAxis& law, const Vector6<Real>& e,
                       const Pieces& pieces = everywhere) {
    Vector6<Real> stress;
    for (int k = 0; k < 6; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        stress[k] = gradient<Real>(law.axis[axis], e[k], pieces[axis]);
    }
    return stress;
}
template <class Real, class Deformation>
Matrix6<Real> hessian(const PerAxis& law, Deformation&& e, const Pieces& pieces = everywhere) {
    const Vector6<Real> at = e();
    Matrix6<Real> K = Matrix6<Real>::Zero();
    for (int k = 0; k < 6; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        K(k, k) = hessian<Real>(
            law.axis[axis], [&] { return at[k]; }, pieces[axis]);
    }
    return K;
}
inline bool rotational(const PerAxis& law) {
    return std::any_of(law.axis.begin() + 3, law.axis.end(), [](const ScalarLaw& about) {
        const double* rate = rate_of(about);
        return rate == nullptr || *rate != 0;
    });
}

template <class Real>
Vector6<Real> gradient(const SpatialLaw& law, const Vector6<Real>& e,
                       const Pieces& pieces = everywhere) {
    return std::visit([&](const auto& kind) { return gradient<Real>(kind, e, pieces); }, law);
}
template <class Real, class Deformation>
Matrix6<Real> hessian(const SpatialLaw& law, Deformation&& e, const Pieces& pieces = everywhere) {
    return std::visit([&](const auto& kind) { return hessian<Real>(kind, e, pieces); }, law);
}
inline bool rotational(const SpatialLaw& law) {
    return std::visit([](const auto& kind) { return rotational(kind); }, law);
}

}  // namespace elastocheck::recursive
