// Deformation measures of a bushing, with first and second derivatives.
// They are the position and angles of marker j relative to marker i, for each
// formulation of include/elastocheck/mechanism.hpp.
//
// Relative to i, j is at x = A_iᵀ D, D = p_j - p_i, rotated by B = A_iᵀ A_j. A small motion is
//
//   δx = A_iᵀ (δp_j - δp_i - δπ_i × D),   δφ = A_iᵀ (δπ_j - δπ_i),   δB = (δφ)~ B ,
//
// ~ the cross product matrix of a vector.
//
// Three angles θ of B, with H = ∂θ/∂φ and ∂(Hᵀ m)/∂φ for a constant m:
//
//   rotation vector   θ = log B, H = J(θ)⁻¹, J the left Jacobian of the rotation group
//   Cardan            B = R_x(θ_x) R_y(θ_y) R_z(θ_z):  δφ = δθ_x e_x + δθ_y R_x e_y
//                                                   + δθ_z R_x R_y e_z, solved for δθ
//   projected         each θ_k = atan2(n, c), n = u·w, c = v·w: column w of B, axes u, v of i.
//                     With δw = δφ × w its row of H is
//                     h = w × g / r²,  g = c u - n v,  r² = n² + c²
//
// The frame in the middle is rotated from i by S = B^½. From B = S S follows δφ = S (I + S) δη, δη
// the rotation increment of S in its own axes. Since S is the Cayley transform of t = tan(|θ|/4)
// θ/|θ|, the Rodrigues vector of S,
//
//   δη = P δφ,   P = (I + S)⁻¹ Sᵀ = ½ (I - t̃) Sᵀ,   δt = ½ (I + t̃ + t tᵀ) δη
//   d = Sᵀ x,   δd = Sᵀ δx - δη × d
//
// which is singular only at a whole turn.
#pragma once

#include <array>
#include <limits>

#include "recursive/formula/state.hpp"

namespace elastocheck::recursive {

// ---- Rotation vector.

// The rotation vector θ of R, |θ| ≤ π.
template <class Real>
Vector3<Real> logarithm(const Matrix3<Real>& R) {
    using std::atan2;
    Eigen::Quaternion<Real> p(R);
    if (p.w() < 0) p.coeffs() = -p.coeffs();
    const Real sine = p.vec().norm();
    // θ = 2 atan2(|v|, w) along v/|v|. Near zero 2/w replaces the quotient and is exact to
    // the last bit.
    const Real factor =
        sine > std::numeric_limits<Real>::epsilon() ? 2 * atan2(sine, p.w()) / sine : 2 / p.w();
    return factor * p.vec();
}

// J(θ)⁻¹ = I - ½ θ̃ + c(θ) θ̃²,  c = (1 - (θ/2) cot(θ/2)) / θ², the inverse left Jacobian.
template <class Real>
Matrix3<Real> inverse_left_jacobian(const Vector3<Real>& theta) {
    using std::sqrt;
    using std::tan;
    const Real t2 = theta.squaredNorm();
    // Below 0.03 rad the series 1/12 + t²/720 + t⁴/30240 + t⁶/1209600 is exact to 1e-16; above it
    // cancellation is small.
    Real c;
    if (t2 < Real(1e-3)) {
        c = Real(1) / 12 + t2 * (Real(1) / 720 + t2 * (Real(1) / 30240 + t2 * (Real(1) / 1209600)));
    } else {
        const Real half = sqrt(t2) / 2;
        c = (1 - half / tan(half)) / t2;
    }
    const Matrix3<Real> t = tilde(theta);
    return Matrix3<Real>::Identity() - t / 2 + c * (t * t);
}

// ∂(J(θ)⁻ᵀ m)/∂θ. With J⁻ᵀ = I + ½ θ̃ + c θ̃² and ∇c = h θ, h = c'(θ)/θ:
//   δ(J⁻ᵀ m) = ½ δθ × m + c (δθ × (θ × m) + θ × (δθ × m)) + h (θ·δθ) θ × (θ × m)
template <class Real>
Matrix3<Real> moment_derivative(const Vector3<Real>& theta, const Vector3<Real>& m) {
    using std::sin;
    using std::sqrt;
    using std::tan;
    const Real t2 = theta.squaredNorm();
    Real c, h;
    if (t2 < Real(1e-3)) {
        c = Real(1) / 12 + t2 * (Real(1) / 720 + t2 * (Real(1) / 30240 + t2 * (Real(1) / 1209600)));
        h = Real(1) / 360 +
            t2 * (Real(1) / 7560 + t2 * (Real(1) / 201600 + t2 * (Real(1) / 5987520)));
    } else {
        const Real t = sqrt(t2), u = t / 2;
        c = (1 - u / tan(u)) / t2;
        h = ((u / (sin(u) * sin(u)) - 1 / tan(u)) / (2 * t) - 2 * c) / t2;
    }
    const Vector3<Real> theta_m = theta.cross(m);
    return -tilde(m) / 2 - c * (tilde(theta_m) + tilde(theta) * tilde(m)) +
           h * theta.cross(theta_m) * theta.transpose();
}

// ---- Cardan angles. H is divided by cos θ_y: singular at θ_y = ±90°, as any three
// angles are somewhere.

template <class Real>
Vector3<Real> cardan(const Matrix3<Real>& B) {
    using std::atan2;
    using std::hypot;
    return {atan2(-B(1, 2), B(2, 2)), atan2(B(0, 2), hypot(B(0, 0), B(0, 1))),
            atan2(-B(0, 1), B(0, 0))};
}
template <class Real>
Matrix3<Real> cardan_jacobian(const Vector3<Real>& theta) {
    using std::cos;
    using std::sin;
    using std::tan;
    const Real s = sin(theta.x()), c = cos(theta.x()), t = tan(theta.y()), r = 1 / cos(theta.y());
    Matrix3<Real> H;
    H << Real(1), s * t, -c * t, Real(0), c, s, Real(0), -s * r, c * r;
    return H;
}
// ∂(Hᵀ m)/∂θ
template <class Real>
Matrix3<Real> cardan_moment_derivative(const Vector3<Real>& theta, const Vector3<Real>& m) {
    using std::cos;
    using std::sin;
    using std::tan;
    const Real s = sin(theta.x()), c = cos(theta.x()), t = tan(theta.y()), r = 1 / cos(theta.y());
    const Real along = m.x() * t - m.z() * r, change = r * (m.x() * r - m.z() * t);  // ∂along/∂θ_y
    // of Hᵀ m = (m_x, s · along + c m_y, -c · along + s m_y)
    Matrix3<Real> N = Matrix3<Real>::Zero();
    N.col(0) << Real(0), c * along - s * m.y(), s * along + c * m.y();
    N.col(1) << Real(0), s * change, -c * change;
    return N;
}

// ---- Projected angles.

// One projected angle atan2(n, c), in the letters above. `u_axis`, `v_axis`: the axes u and v of i,
// u times `u_sign`.
template <class Real>
struct Projection {
    Vector3<Real> w, u, v;  // column of B; axes of i
    Real n, c;

    Projection(const Matrix3<Real>& B, int column, int u_axis, Real u_sign, int v_axis)
        : w(B.col(column)),
          u(u_sign * Vector3<Real>::Unit(u_axis)),
          v(Vector3<Real>::Unit(v_axis)),
          n(u.dot(w)),
          c(v.dot(w)) {}
    Vector3<Real> g() const { return c * u - n * v; }
    Real r2() const { return n * n + c * c; }
};
template <class Real>
std::array<Projection<Real>, 3> projections(const Matrix3<Real>& B) {
    return {Projection<Real>(B, 2, 1, Real(-1), 2), Projection<Real>(B, 2, 0, Real(1), 2),
            Projection<Real>(B, 0, 1, Real(1), 0)};
}
template <class Real>
Vector3<Real> projected(const Matrix3<Real>& B) {
    using std::atan2;
    Vector3<Real> theta;
    for (int k = 0; const auto& plane : projections<Real>(B)) theta[k++] = atan2(plane.n, plane.c);
    return theta;
}
template <class Real>
Matrix3<Real> projected_jacobian(const Matrix3<Real>& B) {
    Matrix3<Real> H;
    for (int k = 0; const auto& plane : projections<Real>(B))
        H.row(k++) = plane.w.cross(plane.g()) / plane.r2();
    return H;
}
// ∂(Hᵀ m)/∂φ: with δn = (w × u)·δφ, δc = (w × v)·δφ
//   δh = (δw × g + w × (u δc - v δn) - h δ(r²)) / r²
template <class Real>
Matrix3<Real> projected_moment_derivative(const Matrix3<Real>& B, const Vector3<Real>& m) {
    Matrix3<Real> N = Matrix3<Real>::Zero();
    for (int k = 0; const auto& [w, u, v, n, c] : projections<Real>(B)) {
        const Vector3<Real> dn = w.cross(u), dc = w.cross(v), g = c * u - n * v;
        const Real r2 = n * n + c * c;
        const Vector3<Real> h = w.cross(g) / r2;
        N += m[k++] / r2 *
             (tilde(g) * tilde(w) + dn * dc.transpose() - dc * dn.transpose() -
              2 * h * (n * dn + c * dc).transpose());
    }
    return N;
}

// ---- Dispatch on the kind of angles.

using Angles = Formulation::Angles;

template <class Real>
Vector3<Real> angles_of(Angles angles, const Matrix3<Real>& B) {
    switch (angles) {
        case Angles::rotation_vector: break;
        case Angles::cardan: return cardan<Real>(B);
        case Angles::projected: return projected<Real>(B);
    }
    return logarithm<Real>(B);
}
// H = ∂θ/∂φ [3 × 3]
template <class Real>
Matrix3<Real> angle_jacobian(Angles angles, const Matrix3<Real>& B, const Vector3<Real>& theta) {
    switch (angles) {
        case Angles::rotation_vector: break;
        case Angles::cardan: return cardan_jacobian<Real>(theta);
        case Angles::projected: return projected_jacobian<Real>(B);
    }
    return inverse_left_jacobian<Real>(theta);
}
// ∂(Hᵀ m)/∂φ [3 × 3]
template <class Real>
Matrix3<Real> moment_derivative(Angles angles, const Matrix3<Real>& B, const Vector3<Real>& theta,
                                const Matrix3<Real>& H, const Vector3<Real>& m) {
    switch (angles) {
        case Angles::rotation_vector: break;
        case Angles::cardan: return cardan_moment_derivative<Real>(theta, m) * H;
        case Angles::projected: return projected_moment_derivative<Real>(B, m);
    }
    return moment_derivative<Real>(theta, m) * H;
}

// ---- Frame in the middle.

template <class Real>
struct Middle {
    Matrix3<Real> S;  // B^½
    Vector3<Real> t;  // its Rodrigues vector
};
template <class Real>
Middle<Real> middle(const Matrix3<Real>& B) {
    Eigen::Quaternion<Real> p(B);
    if (p.w() < 0) p.coeffs() = -p.coeffs();
    // The quaternion halfway between (1, 0) and p.
    const Eigen::Quaternion<Real> half(1 + p.w(), p.x(), p.y(), p.z());
    const Vector3<Real> t = half.vec() / half.w();  // tan(|θ|/4) θ/|θ|
    return {half.normalized().toRotationMatrix(), t};
}
// P = ∂η/∂φ [3 × 3]
template <class Real>
Matrix3<Real> middle_jacobian(const Middle<Real>& frame) {
    return (Matrix3<Real>::Identity() - tilde(frame.t)) * frame.S.transpose() / 2;
}

}  // namespace elastocheck::recursive
