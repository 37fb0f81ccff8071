// Vectors and unit quaternions, for double and for Ceres' Jets.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace elastocheck::reference::equilibrium {

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;

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
// With the quaternion of A as (w, v), w ≥ 0: |v| = sin(θ/2), w = cos(θ/2), so θ = 2 v atan2(|v|, w) / |v| and
// (θ/2) cot(θ/2) = atan2(|v|, w) w / |v|. Near θ = 0 both are even power series, with derivatives there too:
// atan(t)/t in t = |v|/w, and c = 1/12 + θ²/720 + θ⁴/30240 + ... (Bernoulli numbers B₂ₙ over (2n)!).
// At half a turn the logarithm is not unique: from 1e-6 rad before, all is NaN rather than one of two.
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

template <class T>
Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class T>
T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace elastocheck::reference::equilibrium
