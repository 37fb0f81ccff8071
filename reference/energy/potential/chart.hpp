// Local coordinates: each body's displacement and rotation vector (ground axes) from a centre pose.
//
//   r = r_c + Δr,   A = exp(φ) A_c,   x = (Δr, φ) of every body, [6nb]
//
// The minimisation runs in one chart. After each solution the chart is re-centred (`poses`), so φ
// stays small and the first-order potentials of dead moments and brake forces become exact.
#pragma once

#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck::reference::energy {

// One body in its chart: centre pose and increment.
struct Placement {
    Pose centre;
    Eigen::Matrix3d A_c = Eigen::Matrix3d::Identity();
    Eigen::Vector3d dr = Eigen::Vector3d::Zero();                  // Δr [m]
    Eigen::Vector3d phi = Eigen::Vector3d::Zero();                 // φ [rad]
    Eigen::Matrix3d rotation_minus_one = Eigen::Matrix3d::Zero();  // exp(φ) - 1
    Eigen::Quaterniond quaternion_minus_one = {0, 0, 0, 0};        // the same as a quaternion
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity();               // δπ = J δφ
};

struct Chart {
    std::vector<Placement> placements;  // one per body

    const Placement& operator[](BodyId body) const;  // ground included
};

std::vector<Pose> design_poses(const Model& model);
Chart chart_about(const std::vector<Pose>& centre);
void move_to(Chart& chart, const Eigen::VectorXd& x);  // x [6nb]
void move_to(Placement& body, const Vector6& x);
std::vector<Pose> poses(const Chart& chart);  // current poses of the bodies
Eigen::VectorXd increment(const std::vector<Pose>& from,
                          const std::vector<Pose>& to);  // x of `to` in the chart about `from`

// Current position of a body point, and its displacement from the centre pose.
struct PointMotion {
    Eigen::Vector3d p, displacement;  // [m]
    Eigen::Vector3d lever;            // A s, from the body's origin [m]
};
PointMotion motion(const Placement& body, const Eigen::Vector3d& s_local);

struct DirectionMotion {
    Eigen::Vector3d u, du;
};
DirectionMotion turned(const Placement& body, const Eigen::Vector3d& u_local);

}  // namespace elastocheck::reference::energy
