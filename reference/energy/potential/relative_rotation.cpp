// Entries of B and functions of them, each as value at the centre, change and slope in β:
//
//   B_rc = e_r·(B e_c):   δB_rc = e_r·(β × B e_c) = (B e_c × e_r)·β
//   h = √(x² + y²):       h - h_c = (Δx (x + x_c) + Δy (y + y_c)) / (h + h_c)
//   α = atan2(y, x):      α - α_c = atan2(x_c Δy - y_c Δx, x x_c + y y_c),
//                         δα = (x δy - y δx)/(x² + y²)
#include "reference/energy/potential/relative_rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/energy/potential/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::RowVector3d;
using Eigen::Vector3d;

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

AngleChange together(const Varying& x, const Varying& y, const Varying& z) {
    AngleChange angles;
    angles.theta_c << x.c, y.c, z.c;
    angles.dtheta << x.change, y.change, z.change;
    angles.slope << x.slope, y.slope, z.slope;
    return angles;
}

//            ⎡  c_y c_z                -c_y s_z                 s_y     ⎤
// Rx Ry Rz = ⎢  c_x s_z + s_x s_y c_z   c_x c_z - s_x s_y s_z  -s_x c_y ⎥
//            ⎣  s_x s_z - c_x s_y c_z   s_x c_z + c_x s_y s_z   c_x c_y ⎦
AngleChange cardan(const RelativeRotation& B) {
    const Varying s_x_c_y = -entry(B, 1, 2), c_x_c_y = entry(B, 2, 2);
    return together(atan2(s_x_c_y, c_x_c_y), atan2(entry(B, 0, 2), hypot(s_x_c_y, c_x_c_y)),
                    atan2(-entry(B, 0, 1), entry(B, 0, 0)));
}

AngleChange projected(const RelativeRotation& B) {
    return together(atan2(-entry(B, 1, 2), entry(B, 2, 2)), atan2(entry(B, 0, 2), entry(B, 2, 2)),
                    atan2(entry(B, 1, 0), entry(B, 0, 0)));
}

AngleChange rotation_vector_of(const RelativeRotation& B) {
    const LogChange log = log_change(B.q_c, B.dq);
    return {log.theta_c, log.dtheta, inverse_turn_jacobian(log.theta_c + log.dtheta)};
}

RelativeRotation at_rest(Quaterniond q) {
    if (q.w() < 0) q.coeffs() *= -1;
    return {q, Quaterniond(0, 0, 0, 0), q.toRotationMatrix(), Matrix3d::Zero()};
}

}  // namespace

AngleChange angles(Formulation::Angles kind, const RelativeRotation& rotation) {
    switch (kind) {
        case Formulation::Angles::rotation_vector: return rotation_vector_of(rotation);
        case Formulation::Angles::cardan: return cardan(rotation);
        case Formulation::Angles::projected: return projected(rotation);
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

Vector3d angles_of(Formulation::Angles kind, const Quaterniond& q) {
    return angles(kind, at_rest(q.normalized())).theta_c;
}

double way_to_the_end(const Formulation& formulation, const Quaterniond& q) {
    using Angles = Formulation::Angles;
    const Vector3d theta = angles_of(formulation.angles, q);
    const Matrix3d B = q.normalized().toRotationMatrix();
    const double half_turn = std::numbers::pi;
    double way =
        half_turn - (formulation.angles == Angles::rotation_vector ? theta.norm()
                                                                   : theta.cwiseAbs().maxCoeff());
    if (formulation.angles == Angles::cardan)
        way = std::min(way, half_turn / 2 - std::abs(theta.y()));
    if (formulation.angles == Angles::projected)
        way = std::min({way, std::hypot(B(1, 2), B(2, 2)), std::hypot(B(0, 2), B(2, 2)),
                        std::hypot(B(1, 0), B(0, 0))});
    if (formulation.frame == Formulation::Frame::middle)
        way = std::min(way, half_turn - rotation_vector(q).norm());
    return way;
}

}  // namespace elastocheck::reference::energy
