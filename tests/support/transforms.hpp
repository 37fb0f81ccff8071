// Transforms that must not change the result of any solver.
#pragma once

#include <vector>

#include "compare/stress/transforms.hpp"

namespace elastocheck::support {

inline Scene moved(const Scene& scene, const Eigen::Quaterniond& R, const Eigen::Vector3d& t) {
    return compare::transformed(scene, {.M = R.toRotationMatrix(), .t = t});
}
// y → -y: the other side of the vehicle.
inline Scene mirrored(const Scene& scene) {
    const Eigen::Matrix3d M = Eigen::Vector3d(1, -1, 1).asDiagonal();
    return compare::transformed(scene, {.M = M});
}
inline Scene scaled(const Scene& scene, double length, double force) {
    return compare::transformed(scene, {.length = length, .force = force});
}

// The same bodies in other body axes: the axes of body b are rotated by turns[b % size].
Scene with_body_axes(const Scene& scene, const std::vector<Eigen::Quaterniond>& turns);

// Bodies, joints and elements in reverse order.
Scene reversed(const Scene& scene);

}  // namespace elastocheck::support
