// Relative rotation of a bushing's two markers, and its angles by formulation.
//
//   B = A_iᵀ A_j,   δB = β̃ B,   β = A_iᵀ (δπ_j - δπ_i)
//
// Changes since the centre of the chart are computed without differences of two numbers.
#pragma once

#include "elastocheck/mechanism.hpp"

namespace elastocheck::reference::energy {

struct RelativeRotation {
    Eigen::Quaterniond q_c, dq;  // of B at the centre, w ≥ 0, and its change since
    Eigen::Matrix3d B_c, dB;     // the same as matrices
};

// The angles θ of B, continuous with those at the centre, where they are the principal values.
struct AngleChange {
    Eigen::Vector3d theta_c, dtheta;  // [rad]
    Eigen::Matrix3d slope;            // δθ = slope · β
};
AngleChange angles(Formulation::Angles kind, const RelativeRotation& rotation);

// σ·∂²θ/∂β² at the centre, where B has the unit quaternion q, w ≥ 0: B → exp(β) B.
Eigen::Matrix3d angle_curvature(Formulation::Angles kind, const Eigen::Quaterniond& q,
                                const Eigen::Vector3d& sigma);

// Axes halfway from i to j, in the axes of marker i: C = B^½.
struct HalfWay {
    Eigen::Matrix3d C, dC;
    Eigen::Matrix3d share;  // γ = share · β, where δC = γ̃ C
};
HalfWay half_way(const RelativeRotation& rotation);

// m·∂²γ/∂β² of C → exp(γ) C, q as above.
Eigen::Matrix3d half_way_curvature(const Eigen::Quaterniond& q, const Eigen::Vector3d& m);

// The same angles, principal values, of B as a quaternion.
Eigen::Vector3d angles_of(Formulation::Angles kind, const Eigen::Quaterniond& q);

// Distance [rad] to the nearest point where the angles (and B^½ if the formulation uses it) are not
// differentiable; zero or negative beyond it:
//   rotation vector, B^½   half a turn
//   cardan                 θ_y = ± π/2, gimbal lock; half a turn of the others
//   projected              half a turn, or both sides of a projection vanish: an axis of j along
//                          an axis of i
double distance_to_singularity(const Formulation& formulation, const Eigen::Quaterniond& q);

}  // namespace elastocheck::reference::energy
