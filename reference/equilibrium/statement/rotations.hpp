// Vectors and unit quaternions, for double and for Ceres' Jets.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

#include "elastocheck/mechanism.hpp"

namespace elastocheck::reference::equilibrium {

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;

template <class T>
Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class T>
T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// A(p) v = v + w u + p⃗ × u with u = 2 p⃗ × v, p = (w, p⃗) a unit quaternion; S is T or double.
template <class T, class S>
Vec3<T> turned(const Eigen::Quaternion<T>& p, const Vec3<S>& v) {
    const T &w = p.w(), &a = p.x(), &b = p.y(), &c = p.z();
    const T ux = (b * v[2] - c * v[1]) * 2.0, uy = (c * v[0] - a * v[2]) * 2.0,
            uz = (a * v[1] - b * v[0]) * 2.0;
    return {w * ux + (b * uz - c * uy) + v[0], w * uy + (c * ux - a * uz) + v[1],
            w * uz + (a * uy - b * ux) + v[2]};
}

template <class T>
Eigen::Quaternion<T> conjugate(const Eigen::Quaternion<T>& p) {
    return {p.w(), -p.x(), -p.y(), -p.z()};
}

// The Hamilton product p q: A(p q) = A(p) A(q); S is T or double.
template <class T, class S>
Eigen::Quaternion<T> product(const Eigen::Quaternion<T>& p, const Eigen::Quaternion<S>& q) {
    return {p.w() * q.w() - p.x() * q.x() - p.y() * q.y() - p.z() * q.z(),
            p.w() * q.x() + p.x() * q.w() + p.y() * q.z() - p.z() * q.y(),
            p.w() * q.y() - p.x() * q.z() + p.y() * q.w() + p.z() * q.x(),
            p.w() * q.z() + p.x() * q.y() - p.y() * q.x() + p.z() * q.w()};
}

// θ = log A and the coefficient c of the inverse left Jacobian of SO(3),
//
//   J⁻¹(θ) = I - ½ θ̃ + c θ̃²,   c = (1 - (θ/2) cot(θ/2)) / θ².
//
// With the quaternion of A as (w, v), w ≥ 0: |v| = sin(θ/2), w = cos(θ/2), so
// θ = 2 v atan2(|v|, w) / |v| and (θ/2) cot(θ/2) = atan2(|v|, w) w / |v|. Near θ = 0 both are even
// power series, with derivatives there too: atan(t)/t in t = |v|/w, and
// c = 1/12 + θ²/720 + θ⁴/30240 + ... (Bernoulli numbers B₂ₙ over (2n)!).
// At half a turn the logarithm is not unique: within 1e-6 rad of it, all values are NaN.
template <class T>
struct Logarithm {
    Vec3<T> theta;
    T c;
};

template <class T>
Logarithm<T> logarithm(Eigen::Quaternion<T> q) {
    using std::atan2;
    using std::sqrt;
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    const T w = q.w(), sin2 = q.x() * q.x() + q.y() * q.y() + q.z() * q.z();
    if (!(w > 0.5e-6)) {
        const T nan(std::numeric_limits<double>::quiet_NaN());
        return {Vec3<T>::Constant(nan), nan};
    }
    T angle_by_sin, c;  // (θ/2)/sin(θ/2), c
    const T t2 = sin2 / (w * w);
    if (t2 < 2.5e-3) {
        angle_by_sin = T(1.0 / 13);
        for (int n = 11; n >= 1; n -= 2) angle_by_sin = 1.0 / n - t2 * angle_by_sin;
        angle_by_sin /= w;
        const T x = 4.0 * sin2 * angle_by_sin * angle_by_sin;  // θ²
        constexpr double b[] = {1. / 12,      1. / 720,      1. / 30240,
                                1. / 1209600, 1. / 47900160, 691. / 1307674368000.};
        c = T(b[5]);
        for (int n = 4; n >= 0; --n) c = b[n] + x * c;
    } else {
        const T s = sqrt(sin2);
        angle_by_sin = atan2(s, w) / s;
        c = (1.0 - angle_by_sin * w) / (4.0 * sin2 * angle_by_sin * angle_by_sin);
    }
    const T k = 2.0 * angle_by_sin;
    return {{k * q.x(), k * q.y(), k * q.z()}, c};
}

// C with C² = A, and t = tan(|θ|/4) θ/|θ|, so that C = (I + t̃) (I - t̃)⁻¹. With the quaternion of
// A as (w, v), w ≥ 0, that of C bisects the arc from 1, (1 + w, v) / √(2 + 2w), and
// t = v / (1 + w). NaN where the logarithm is.
template <class T>
struct HalfTurn {
    Eigen::Quaternion<T> p;
    Vec3<T> t;
};

template <class T>
HalfTurn<T> half_turn(Eigen::Quaternion<T> q) {
    using std::sqrt;
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    if (!(q.w() > 0.5e-6)) {
        const T nan(std::numeric_limits<double>::quiet_NaN());
        return {{nan, nan, nan, nan}, Vec3<T>::Constant(nan)};
    }
    const T one_w = 1.0 + q.w(), size = sqrt(2.0 * one_w);
    return {{one_w / size, q.x() / size, q.y() / size, q.z() / size},
            {q.x() / one_w, q.y() / one_w, q.z() / one_w}};
}

// Three angles of a rotation B and their axes: for a variation exp(w̃) B of B, δθ_k = a_k · w.
template <class T>
struct Angles {
    Vec3<T> theta;
    std::array<Vec3<T>, 3> a;
};

// Angle of (x, y) in its plane. NaN within 1e-6 rad of half a turn, where it jumps, and at the
// origin, where it is undefined.
template <class T>
T plane_angle(const T& y, const T& x) {
    using std::atan2;
    constexpr double near2 = 1e-12;
    const T xx = x * x, yy = y * y;
    if (!(xx + yy > near2) || (x < 0.0 && yy <= near2 * xx))
        return T(std::numeric_limits<double>::quiet_NaN());
    return atan2(y, x);
}

// Axis of the angle of a rotating unit direction u in the projection along the axis n. Of w × u,
// the in-plane part rotates the projection v = u - (n·u) n about n at the rate
// n · (v × (w × u)) / |v|² = w · (u × (n × v)) / |v|², so
//
//   a = n - (n·u) v / |v|²
template <class T>
Vec3<T> axis_of_projection(const Vec3<T>& u, int n) {
    Vec3<T> v = u;
    v[n] = T(0.0);
    const T along = u[n] / dot(v, v);
    Vec3<T> a = {-along * v[0], -along * v[1], -along * v[2]};
    a[n] += T(1.0);
    return a;
}

// Angles as defined in mechanism.hpp. With x, y, z the axes of j in axes of i, the columns of B:
//
//   rotation_vector  δθ = J⁻¹ w, so a_k is column k of J⁻ᵀ:  e_k + ½ θ × e_k + c θ × (θ × e_k)
//   projected        θ_x, θ_y from z along x_i, y_i; θ_z from x along z_i
//   cardan           w = x_i δθ_x + y' δθ_y + z δθ_z, y' = (0, z_z, -z_y) / h normal to x_i and z,
//                    h = √(z_y² + z_z²) = cos θ_y; the a_k are dual to these three axes:
//                    a_x as projected, a_y = y', a_z = (0, z_y, z_z) / h². Undefined at
//                    θ_y = ±90°, h = 0.
template <class T>
Angles<T> angles_of(Formulation::Angles kind, const Eigen::Quaternion<T>& B) {
    using std::sqrt;
    Angles<T> angles;
    if (kind == Formulation::Angles::rotation_vector) {
        const Logarithm<T> log = logarithm(B);
        angles.theta = log.theta;
        for (int k = 0; k < 3; ++k) {
            Vec3<T>& a = angles.a[static_cast<std::size_t>(k)];
            a = Vec3<T>::Constant(T(0.0));
            a[k] = T(1.0);
            const Vec3<T> once = cross(log.theta, a), twice = cross(log.theta, once);
            a += once * T(0.5) + twice * log.c;
        }
        return angles;
    }
    const Eigen::Vector3d e_x = Eigen::Vector3d::UnitX(), e_y = Eigen::Vector3d::UnitY(),
                          e_z = Eigen::Vector3d::UnitZ();
    const Vec3<T> x = turned(B, e_x), z = turned(B, e_z);
    angles.theta[0] = plane_angle(T(-z[1]), z[2]);
    angles.a[0] = axis_of_projection(z, 0);
    if (kind == Formulation::Angles::projected) {
        angles.theta[1] = plane_angle(z[0], z[2]);
        angles.theta[2] = plane_angle(x[1], x[0]);
        angles.a[1] = axis_of_projection(z, 1);
        angles.a[2] = axis_of_projection(x, 2);
        return angles;
    }
    const Vec3<T> y = turned(B, e_y);
    const T h2 = z[1] * z[1] + z[2] * z[2], h = sqrt(h2);
    angles.theta[1] = plane_angle(z[0], h);
    angles.theta[2] = plane_angle(T(-y[0]), x[0]);
    angles.a[1] = {T(0.0), z[2] / h, -z[1] / h};
    angles.a[2] = {T(0.0), z[1] / h2, z[2] / h2};
    return angles;
}

}  // namespace elastocheck::reference::equilibrium
