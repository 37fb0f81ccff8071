// Constraint values at any poses, implemented from the comments in model.hpp.
#pragma once

#include <cmath>
#include <variant>
#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck {

using Poses = std::vector<Pose>;

inline Pose pose_of(BodyId body, const Poses& poses) {
    return body == ground ? Pose{} : poses[static_cast<std::size_t>(body)];
}
inline Eigen::Vector3d at(const Point& p, const Poses& poses) {
    const Pose pose = pose_of(p.body, poses);
    return pose.r + pose.p * p.s_local;
}
inline Eigen::Vector3d along(const Direction& u, const Poses& poses) {
    return pose_of(u.body, poses).p * u.u_local;
}

inline void append(const CoincidentPoints& c, const Poses& q, std::vector<double>& Phi) {
    const Eigen::Vector3d gap = at(c.i, q) - at(c.j, q);
    Phi.insert(Phi.end(), {gap.x(), gap.y(), gap.z()});
}
inline void append(const PointInPlane& c, const Poses& q, std::vector<double>& Phi) {
    Phi.push_back(along(c.normal_j, q).dot(at(c.i, q) - at(c.j, q)) - c.offset);
}
inline void append(const PerpendicularDirections& c, const Poses& q, std::vector<double>& Phi) {
    Phi.push_back(along(c.i, q).dot(along(c.j, q)));
}
inline void append(const DistanceBetween& c, const Poses& q, std::vector<double>& Phi) {
    Phi.push_back((at(c.i, q) - at(c.j, q)).norm() - c.length);
}
inline void append(const DirectionAtAngle& c, const Poses& q, std::vector<double>& Phi) {
    Phi.push_back(
        along(c.i, q).dot(std::cos(c.angle) * along(c.y_j, q) - std::sin(c.angle) * along(c.j, q)));
}

inline Eigen::VectorXd Phi(const std::vector<ConstraintKind>& constraints, const Poses& poses) {
    std::vector<double> values;
    for (const auto& constraint : constraints)
        std::visit([&](const auto& c) { append(c, poses, values); }, constraint);
    return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace elastocheck
