// Vectors, unit quaternions and angles of a rotation, for all number types.
#pragma once

#include "elastocheck/mechanism.hpp"
#include "reference/certificate/interval/series.hpp"

namespace elastocheck::reference::certificate {

template <class T>
struct Vec {
    std::array<T, 3> x{};
    T& operator[](std::size_t k) { return x[k]; }
    const T& operator[](std::size_t k) const { return x[k]; }
};

template <class T>
Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) {
    return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}
template <class T>
Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) {
    return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
template <class T>
Vec<T> operator-(const Vec<T>& a) {
    return {{-a[0], -a[1], -a[2]}};
}
template <class T>
Vec<T> operator*(const Vec<T>& a, const T& b) {
    return {{a[0] * b, a[1] * b, a[2] * b}};
}
template <class T>
T dot(const Vec<T>& a, const Vec<T>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
template <class T>
T squared(const Vec<T>& a) {
    return sqr(a[0]) + sqr(a[1]) + sqr(a[2]);
}
template <class T>
Vec<T> constant(const Eigen::Vector3d& v) {
    return {{constant<T>(v[0]), constant<T>(v[1]), constant<T>(v[2])}};
}

template <class T>
struct Quat {
    T w{};
    Vec<T> v{};
};
template <class T>
Quat<T> conjugate(const Quat<T>& p) {
    return {p.w, -p.v};
}
template <class T>
Quat<T> product(const Quat<T>& p, const Quat<T>& q) {
    return {p.w * q.w - dot(p.v, q.v), q.v * p.w + p.v * q.w + cross(p.v, q.v)};
}
// p s p* = s + w u + v × u,  u = 2 v × s
template <class T>
Vec<T> turned(const Quat<T>& p, const Vec<T>& s) {
    const Vec<T> half = cross(p.v, s), u = half + half;
    return s + u * p.w + cross(p.v, u);
}
// p / |p| in intervals: the length of a stored quaternion is one only to rounding.
template <class T>
Quat<T> unit_quaternion(const Eigen::Quaterniond& p) {
    const Interval size = sqrt(sqr(Interval(p.w())) + sqr(Interval(p.x())) + sqr(Interval(p.y())) +
                               sqr(Interval(p.z())));
    const auto part = [&](double x) { return constant<T>(Interval(x) / size); };
    return {part(p.w()), {{part(p.x()), part(p.y()), part(p.z())}}};
}

template <class T>
Base<T> whole(double x) {
    return Base<T>(x);
}

// Quaternion (cos φ/2, sin φ/2 n) of half the rotation: ((1 + w), v) / √(2 + 2w).
template <class T>
Quat<T> half_of(const Quat<T>& q) {
    using std::sqrt;
    const T w = sqrt((q.w + whole<T>(1)) * whole<T>(0.5));
    const T divisor = w + w;
    return {w, {{q.v[0] / divisor, q.v[1] / divisor, q.v[2] / divisor}}};
}
// Of the two quaternions of a rotation, the one with w > 0; undefined where the sign of w is not
// certain, near half a turn.
template <class T>
Quat<T> short_way(const Quat<T>& q) {
    Quat<T> way = mid(range(q.w)) < 0 ? Quat<T>{-q.w, -q.v} : q;
    if (!(range(way.w).lo > 0)) way.w = undefined<T>();
    return way;
}

// θ = log B, and c in J⁻¹(θ) = I - ½ θ̃ + c θ̃², c = (1 - (|θ|/2) cot(|θ|/2)) / |θ|².
//
// The rotation B is halved (half_of) until sin²(|θ|/2) = |v|² is small; there θ = s v with s = 2 w
// turn(|v|²) and c = bend(|v|²) / s². Doubling back, with s, w, c of the half rotation,
//   s of the whole = s / w        c of the whole = c/4 + 1 / (8 s w)
//
// by v_whole = 2 w v and φ cot φ = (φ/2) cot(φ/2) - (φ/2) tan(φ/2).
template <class T>
struct Logarithm {
    Vec<T> theta;
    T c;
};
template <class T>
Logarithm<T> logarithm(const Quat<T>& B) {
    constexpr double small = 0.1;
    std::array<Quat<T>, 5> q;
    q[0] = short_way(B);
    std::size_t halvings = 0;
    while (halvings + 1 < q.size() && mag(range(squared(q[halvings].v))) > small) {
        q[halvings + 1] = half_of(q[halvings]);
        ++halvings;
    }
    const T x = squared(q[halvings].v), turn = q[halvings].w * sum(Series::turn, x);
    T s = turn + turn;
    T c = sum(Series::bend, x) / sqr(s);
    for (; halvings > 0; --halvings) {
        const T& w = q[halvings].w;
        c = c * whole<T>(0.25) + constant<T>(Interval(0.125)) / (s * w);
        s = s / w;
    }
    return {q[0].v * s, c};
}

// Angle of (x, y) in its plane, less than half a turn: the logarithm of the halved rotation about
// one axis.
template <class T>
T plane_angle(const T& y, const T& x) {
    using std::sqrt;
    const T size = sqrt(sqr(x) + sqr(y));
    const Quat<T> half = half_of(Quat<T>{x / size, {{y / size, constant<T>(0.), constant<T>(0.)}}});
    return logarithm(half).theta[0];
}

// Three angles of B = A_iᵀ A_j, and their conjugate moments: δθ = Gᵀ w for a variation exp(w̃) B of
// B, so m = G g is the moment in axes of i that is conjugate to g on θ.
template <class T>
struct Angles {
    Vec<T> theta;
    std::array<Vec<T>, 3> G;  // columns
};

// Axis of a projected angle: a direction u that rotates with w has in the projection along axis n
// an angle with the rate w · (e_n - (u_n / |v|²) v), v = u - u_n e_n.
template <class T>
Vec<T> axis_of_projection(const Vec<T>& u, std::size_t n) {
    Vec<T> v = u;
    v[n] = constant<T>(0.);
    Vec<T> axis = v * -(u[n] / squared(v));
    axis[n] = constant<T>(1.);
    return axis;
}

//   rotation_vector  w = J θ', so G = J⁻ᵀ: column k is e_k + ½ θ × e_k + c θ × (θ × e_k)
//   projected        z of j projected along x and y of i, x of j projected along z of i
//   cardan           w = x_i θ_x' + y' θ_y' + z_j θ_z', y' normal to x_i and z_j. Dual to these
//                    axes: the projection of z_j along x_i; y' = (0, z_z, -z_y) / h;
//                    (0, z_y, z_z) / h², h² = z_y² + z_z²
template <class T>
Angles<T> angles_of(Formulation::Angles kind, const Quat<T>& B) {
    using std::sqrt;
    Angles<T> angles;
    const T zero = constant<T>(0.), one = constant<T>(1.);
    if (kind == Formulation::Angles::rotation_vector) {
        const auto [theta, c] = logarithm(B);
        angles.theta = theta;
        for (std::size_t k = 0; k < 3; ++k) {
            Vec<T> e{{zero, zero, zero}};
            e[k] = one;
            const Vec<T> once = cross(theta, e), twice = cross(theta, once);
            const auto half = whole<T>(0.5);
            for (std::size_t n = 0; n < 3; ++n)
                angles.G[k][n] = e[n] + once[n] * half + c * twice[n];
        }
        return angles;
    }
    const Vec<T> x = turned(B, Vec<T>{{one, zero, zero}}), z = turned(B, Vec<T>{{zero, zero, one}});
    angles.theta[0] = plane_angle(-z[1], z[2]);
    angles.G[0] = axis_of_projection(z, 0);
    if (kind == Formulation::Angles::projected) {
        angles.theta[1] = plane_angle(z[0], z[2]);
        angles.theta[2] = plane_angle(x[1], x[0]);
        angles.G[1] = axis_of_projection(z, 1);
        angles.G[2] = axis_of_projection(x, 2);
        return angles;
    }
    const Vec<T> y = turned(B, Vec<T>{{zero, one, zero}});
    const T h2 = sqr(z[1]) + sqr(z[2]), h = sqrt(h2);
    angles.theta[1] = plane_angle(z[0], h);
    angles.theta[2] = plane_angle(-y[0], x[0]);
    angles.G[1] = {{zero, z[2] / h, -(z[1] / h)}};
    angles.G[2] = {{zero, z[1] / h2, z[2] / h2}};
    return angles;
}

}  // namespace elastocheck::reference::certificate
