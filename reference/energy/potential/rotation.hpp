// Finite rotations as rotation vectors: exp, its exact Jacobian, log, and *changes* of both without
// cancellation.
//
// The solver compares energies that differ by 1e-20 J at a level of 100 J. So no quantity is
// computed as "new minus old": every change is written in terms of the increment and keeps its
// relative accuracy, however small it is.
#pragma once

#include <Eigen/Geometry>

namespace elastocheck::reference::energy {

Eigen::Matrix3d skew(const Eigen::Vector3d& v);  // skew(v) w = v × w

// exp(φ) - 1 as a matrix, and as a quaternion.
Eigen::Matrix3d rotation_minus_one(const Eigen::Vector3d& phi);
Eigen::Quaterniond quaternion_minus_one(const Eigen::Vector3d& phi);

// δπ = J(φ) δφ: the small rotation (ground axes) of exp(φ) when φ changes by δφ.
Eigen::Matrix3d turn_jacobian(const Eigen::Vector3d& phi);

// δθ = J⁻¹(θ) δπ, the inverse. Regular up to |θ| < 2π.
Eigen::Matrix3d inverse_turn_jacobian(const Eigen::Vector3d& theta);

// log of a unit quaternion with w ≥ 0 after choosing its sign: |θ| ≤ π.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q);

// θ(q_c + dq) = θ_c + dtheta on the sheet that is continuous with q_c, which passes smoothly
// through |θ| = π.
struct LogChange {
    Eigen::Vector3d theta_c, dtheta;  // [rad]
};
LogChange log_change(const Eigen::Quaterniond& q_c, const Eigen::Quaterniond& dq);

}  // namespace elastocheck::reference::energy
