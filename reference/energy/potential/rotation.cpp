#include "reference/energy/potential/rotation.hpp"

#include <cmath>

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Below this angle the series is exact to the last bit (next term: φ⁴).
constexpr double small_angle = 1e-4;

// sin(x)/x
double sinc(double x) { return std::abs(x) < small_angle ? 1 - x * x / 6 : std::sin(x) / x; }

// (1 - cos φ)/φ² = ½ sinc²(φ/2)
double versine_ratio(double phi) { return 0.5 * sinc(phi / 2) * sinc(phi / 2); }

// α/sin α from the half angle's sine s ≥ 0 and cosine w
double inverse_sinc(double s, double w) { return s > 0 ? std::atan2(s, w) / s : 1; }

}  // namespace

Matrix3d skew(const Vector3d& v) {
    Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

// exp(φ) - 1 = sinc φ φ̃ + (1 - cos φ)/φ² φ̃²
Matrix3d rotation_minus_one(const Vector3d& phi) {
    const double angle = phi.norm();
    const Matrix3d w = skew(phi);
    return sinc(angle) * w + versine_ratio(angle) * w * w;
}

// cos(φ/2) - 1 = -2 sin²(φ/4)
Quaterniond quaternion_minus_one(const Vector3d& phi) {
    const double angle = phi.norm();
    const double quarter = std::sin(angle / 4);
    Quaterniond q;
    q.w() = -2 * quarter * quarter;
    q.vec() = 0.5 * sinc(angle / 2) * phi;
    return q;
}

// J = 1 + (1 - cos φ)/φ² φ̃ + (φ - sin φ)/φ³ φ̃²
Matrix3d turn_jacobian(const Vector3d& phi) {
    const double angle = phi.norm();
    const double b = angle < small_angle ? 1.0 / 6 : (1 - sinc(angle)) / (angle * angle);
    const Matrix3d w = skew(phi);
    return Matrix3d::Identity() + versine_ratio(angle) * w + b * w * w;
}

// J⁻¹ = 1 - ½ θ̃ + (1 - (θ/2) cot(θ/2))/θ² θ̃²
Matrix3d inverse_turn_jacobian(const Vector3d& theta) {
    const double angle = theta.norm();
    const double c = angle < small_angle
                         ? 1.0 / 12
                         : (1 - std::cos(angle / 2) / sinc(angle / 2)) / (angle * angle);
    const Matrix3d w = skew(theta);
    return Matrix3d::Identity() - 0.5 * w + c * w * w;
}

Vector3d rotation_vector(const Quaterniond& q) {
    const double sign = q.w() < 0 ? -1 : 1;
    return 2 * sign * inverse_sinc(q.vec().norm(), sign * q.w()) * q.vec();
}

// With q = (w, v), s = |v|, the half angle α = atan2(s, w) and g = α/s: θ = 2 g v. Then
//   Δθ = 2 (g Δv + Δg v_c),   Δs = Δv·(v + v_c)/(s + s_c),
//   η  = α - α_c = atan2(Δs w_c - Δw s_c, w w_c + s s_c),
//   Δg = (η - g_c Δs)/s = (η - g Δs)/s_c,  of which the one with the larger divisor is used.
LogChange log_change(const Quaterniond& q_c, const Quaterniond& dq) {
    const Vector3d v_c = q_c.vec(), dv = dq.vec(), v = v_c + dv;
    const double w_c = q_c.w(), w = w_c + dq.w();
    const double s_c = v_c.norm(), s = v.norm();
    const double g_c = inverse_sinc(s_c, w_c), g = inverse_sinc(s, w);
    if (s_c == 0 && s == 0) return {Vector3d::Zero(), 2 * g * dv};
    const double ds = dv.dot(v + v_c) / (s + s_c);
    const double eta = std::atan2(ds * w_c - dq.w() * s_c, w * w_c + s * s_c);
    const double dg = s >= s_c ? (eta - g_c * ds) / s : (eta - g * ds) / s_c;
    return {2 * g_c * v_c, 2 * (g * dv + dg * v_c)};
}

}  // namespace elastocheck::reference::energy
