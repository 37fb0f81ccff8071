// Angles of the relative rotation B, a rotation matrix, and their derivatives by β, the rotation
// vector of a further turn exp(β) B. Entries of B and functions of them, each as value at the
// centre (index c), change (Δ) and slope in β:
//
//   B_rc = e_r·(B e_c):   δB_rc = e_r·(β × B e_c) = (B e_c × e_r)·β
//   h = √(x² + y²):       h - h_c = (Δx (x + x_c) + Δy (y + y_c)) / (h + h_c)
//   α = atan2(y, x):      α - α_c = atan2(x_c Δy - y_c Δx, x x_c + y y_c),
//                         δα = (x δy - y δx)/(x² + y²)
//
// and with B_rc = e_r·(exp(β) B e_c), h and α as functions of β, their second derivatives; s is a
// slope, C a curvature, ( )ₛ the symmetric part:
//
//   C(B_rc) = T(e_r, B e_c)                                                  (curvature.hpp)
//   C(h) = (s_x s_xᵀ + s_y s_yᵀ + x C_x + y C_y - s_h s_hᵀ)/h
//   C(α) = (x C_y - y C_x)/(x² + y²) - 2 (s_α (x s_x + y s_y)ᵀ)ₛ/(x² + y²)
#include "reference/energy/potential/relative_rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "reference/energy/potential/curvature.hpp"
#include "reference/energy/potential/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::RowVector3d;
using Eigen::Vector3d;

// Value c at the centre, its change, and slope in β.
struct Varying {
    double c, change;
    RowVector3d slope;  // at c + change

    double now() const { return c + change; }
};

Varying operator-(const Varying& x) { return {-x.c, -x.change, -x.slope}; }

Varying entry(const RelativeRotation& rotation, int r, int c) {
    const Vector3d column = rotation.B_c.col(c) + rotation.dB.col(c);
    return {rotation.B_c(r, c), rotation.dB(r, c), column.cross(Vector3d::Unit(r)).transpose()};
}

Varying hypot(const Varying& x, const Varying& y) {
    const double h_c = std::hypot(x.c, y.c), h = std::hypot(x.now(), y.now());
    return {h_c, (x.change * (x.now() + x.c) + y.change * (y.now() + y.c)) / (h + h_c),
            (x.now() * x.slope + y.now() * y.slope) / h};
}

Varying atan2(const Varying& y, const Varying& x) {
    return {std::atan2(y.c, x.c),
            std::atan2(x.c * y.change - y.c * x.change, x.now() * x.c + y.now() * y.c),
            (x.now() * y.slope - y.now() * x.slope) / (x.now() * x.now() + y.now() * y.now())};
}

// Value, slope and curvature in β at the centre.
struct SecondOrder {
    double value;
    Vector3d slope;
    Matrix3d curvature;
};

Matrix3d symmetric(const Matrix3d& M) { return 0.5 * (M + M.transpose()); }

SecondOrder operator-(const SecondOrder& x) { return {-x.value, -x.slope, -x.curvature}; }

SecondOrder second_order_entry(const Matrix3d& B, int r, int c) {
    const Vector3d e = Vector3d::Unit(r), b = B.col(c);
    return {b[r], b.cross(e), turn_curvature(e, b)};
}

SecondOrder hypot(const SecondOrder& x, const SecondOrder& y) {
    const double h = std::hypot(x.value, y.value);
    const Vector3d slope = (x.value * x.slope + y.value * y.slope) / h;
    return {h, slope,
            (x.slope * x.slope.transpose() + y.slope * y.slope.transpose() + x.value * x.curvature +
             y.value * y.curvature - slope * slope.transpose()) /
                h};
}

SecondOrder atan2(const SecondOrder& y, const SecondOrder& x) {
    const double square = x.value * x.value + y.value * y.value;
    const Vector3d slope = (x.value * y.slope - y.value * x.slope) / square,
                   along = x.value * x.slope + y.value * y.slope;
    return {
        std::atan2(y.value, x.value), slope,
        (x.value * y.curvature - y.value * x.curvature - 2 * symmetric(slope * along.transpose())) /
            square};
}

AngleChange angle_change(const std::array<Varying, 3>& theta) {
    const auto& [x, y, z] = theta;
    AngleChange angles;
    angles.theta_c << x.c, y.c, z.c;
    angles.dtheta << x.change, y.change, z.change;
    angles.slope << x.slope, y.slope, z.slope;
    return angles;
}

//            ⎡  c_y c_z                -c_y s_z                 s_y     ⎤
// Rx Ry Rz = ⎢  c_x s_z + s_x s_y c_z   c_x c_z - s_x s_y s_z  -s_x c_y ⎥
//            ⎣  s_x s_z - c_x s_y c_z   s_x c_z + c_x s_y s_z   c_x c_y ⎦
template <class Entry>
auto cardan(const Entry& B) {
    const auto s_x_c_y = -B(1, 2), c_x_c_y = B(2, 2);
    return std::array{atan2(s_x_c_y, c_x_c_y), atan2(B(0, 2), hypot(s_x_c_y, c_x_c_y)),
                      atan2(-B(0, 1), B(0, 0))};
}

template <class Entry>
auto projected(const Entry& B) {
    return std::array{atan2(-B(1, 2), B(2, 2)), atan2(B(0, 2), B(2, 2)), atan2(B(1, 0), B(0, 0))};
}

AngleChange rotation_vector_of(const RelativeRotation& B) {
    const LogChange log = log_change(B.q_c, B.dq);
    return {log.theta_c, log.dtheta, inverse_turn_jacobian(log.theta_c + log.dtheta)};
}

// With Sᵀ σ = σ + ½ θ × σ + c θ × (θ × σ), S = J⁻¹(θ), and δθ = S β:
//
//   δ(Sᵀ σ) = (-½ σ̃ - c ((θ × σ)~ + θ̃ σ̃) + c'/θ (θ × (θ × σ)) θᵀ) S β
//
// c = (1 - h cot h)/(4 h²), c'/θ = (h cot h + h²/sin² h - 2)/(16 h⁴), h = θ/2. The derivative by
// exp(β) B is its symmetric part.
Matrix3d rotation_vector_curvature(const Vector3d& theta, const Vector3d& sigma) {
    constexpr double small = 0.1;  // below: the series is exact to 1e-14
    const double h = 0.5 * theta.norm(), h2 = h * h;
    double c = 1.0 / 12 + h2 / 180 + h2 * h2 / 1890 + h2 * h2 * h2 / 18900,
           slope = 1.0 / 360 + h2 / 1890 + h2 * h2 / 12600 + h2 * h2 * h2 / 93555;
    if (h > small) {
        const double cot = h / std::tan(h), csc = h / std::sin(h);
        c = (1 - cot) / (4 * h2);
        slope = (cot + csc * csc - 2) / (16 * h2 * h2);
    }
    const Vector3d moment = theta.cross(sigma);
    const Matrix3d turned = -0.5 * skew(sigma) - c * (skew(moment) + skew(theta) * skew(sigma)) +
                            slope * theta.cross(moment) * theta.transpose();
    return symmetric(turned * inverse_turn_jacobian(theta));
}

RelativeRotation at_centre(Quaterniond q) {
    if (q.w() < 0) q.coeffs() *= -1;
    return {q, Quaterniond(0, 0, 0, 0), q.toRotationMatrix(), Matrix3d::Zero()};
}

}  // namespace

AngleChange angles(Formulation::Angles kind, const RelativeRotation& rotation) {
    const auto B = [&](int r, int c) { return entry(rotation, r, c); };
    switch (kind) {
        case Formulation::Angles::rotation_vector: return rotation_vector_of(rotation);
        case Formulation::Angles::cardan: return angle_change(cardan(B));
        case Formulation::Angles::projected: return angle_change(projected(B));
    }
    return {};
}

Matrix3d angle_curvature(Formulation::Angles kind, const Quaterniond& q, const Vector3d& sigma) {
    const Matrix3d B_matrix = q.toRotationMatrix();
    const auto B = [&](int r, int c) { return second_order_entry(B_matrix, r, c); };
    const auto sum = [&](const std::array<SecondOrder, 3>& theta) -> Matrix3d {
        return sigma[0] * theta[0].curvature + sigma[1] * theta[1].curvature +
               sigma[2] * theta[2].curvature;
    };
    switch (kind) {
        case Formulation::Angles::rotation_vector:
            return rotation_vector_curvature(rotation_vector(q), sigma);
        case Formulation::Angles::cardan: return sum(cardan(B));
        case Formulation::Angles::projected: return sum(projected(B));
    }
    return {};
}

// Halfway from 1 to q lies c = s/|s|, s = 1 + q. The rotation since the centre is the quaternion
//
//   c c_cᴴ = s s_cᴴ / (|s| |s_c|)
//
// whose vector part is that of Δq s_cᴴ / (|s| |s_c|), since s_c s_cᴴ is real, and (w, v) rotates by
// 1 + 2 w ṽ + 2 ṽ². With B = C C and δC = γ̃ C: δB = (γ + C γ)~ B, so β = (1 + C) γ, and by Cayley
//
//   (1 + C)⁻¹ = ½ (1 - g̃),   g = tan(θ/4) n = v/(1 + w) of q.
HalfWay half_way(const RelativeRotation& rotation) {
    Quaterniond s_c = rotation.q_c, s = rotation.q_c;
    s.coeffs() += rotation.dq.coeffs();
    s_c.w() += 1;
    s.w() += 1;
    const double size = s.norm() * s_c.norm();
    const Vector3d v = (rotation.dq * s_c.conjugate()).vec() / size;
    const double w = (s * s_c.conjugate()).w() / size;
    const Matrix3d C_c = s_c.normalized().toRotationMatrix(), V = skew(v);
    HalfWay half;
    half.dC = 2 * (w * V + V * V) * C_c;
    half.C = C_c + half.dC;
    half.share = 0.5 * (Matrix3d::Identity() - skew(s.vec() / s.w()));
    return half;
}

// With γ' = P β', P = ½ (1 - g̃), and q changing by ½ β q:
//
//   δg = G β,   G = ½ (w 1 - ṽ + v vᵀ/(1 + w))/(1 + w),   β·δP β = -½ (G β) × β
//
// so that m·γ has the second derivative (-½ m̃ G)ₛ.
Matrix3d half_way_curvature(const Quaterniond& q, const Vector3d& m) {
    const Vector3d v = q.vec();
    const Matrix3d G = 0.5 *
                       (q.w() * Matrix3d::Identity() - skew(v) + v * v.transpose() / (1 + q.w())) /
                       (1 + q.w());
    return symmetric(-0.5 * skew(m) * G);
}

Vector3d angles_of(Formulation::Angles kind, const Quaterniond& q) {
    return angles(kind, at_centre(q.normalized())).theta_c;
}

double distance_to_singularity(const Formulation& formulation, const Quaterniond& q) {
    using Angles = Formulation::Angles;
    const Vector3d theta = angles_of(formulation.angles, q);
    const Matrix3d B = q.normalized().toRotationMatrix();
    const double half_turn = std::numbers::pi;
    double distance =
        half_turn - (formulation.angles == Angles::rotation_vector ? theta.norm()
                                                                   : theta.cwiseAbs().maxCoeff());
    if (formulation.angles == Angles::cardan)
        distance = std::min(distance, half_turn / 2 - std::abs(theta.y()));
    if (formulation.angles == Angles::projected)
        distance = std::min({distance, std::hypot(B(1, 2), B(2, 2)), std::hypot(B(0, 2), B(2, 2)),
                             std::hypot(B(1, 0), B(0, 0))});
    if (formulation.frame == Formulation::Frame::middle)
        distance = std::min(distance, half_turn - rotation_vector(q).norm());
    return distance;
}

}  // namespace elastocheck::reference::energy
