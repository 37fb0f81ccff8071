// Positions of bodies and points in a state, as computed by compare/.
#pragma once

#include <array>

#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck::compare {

inline constexpr std::array axes{"x", "y", "z"};

inline const Pose& pose(const std::vector<Pose>& poses, BodyId body) {
    static const Pose at_rest;
    return body == ground ? at_rest : poses[static_cast<std::size_t>(body)];
}

inline Eigen::Vector3d position(const std::vector<Pose>& poses, BodyId body,
                                const Eigen::Vector3d& s_local) {
    return pose(poses, body).r + pose(poses, body).p * s_local;
}
inline Eigen::Vector3d position(const std::vector<Pose>& poses, const Point& point) {
    return position(poses, point.body, point.s_local);
}

// In the design position, ground axes [m]: a point; the vector from a wheel's centre to its patch.
inline Eigen::Vector3d drawn(const Model& model, const Point& point) {
    if (point.body == ground) return point.s_local;
    const Pose& on = model.bodies[static_cast<std::size_t>(point.body)].design;
    return on.r + on.p * point.s_local;
}
inline Eigen::Vector3d drawn_arm(const Model& model, const Wheel& wheel) {
    return drawn(model, wheel.contact) - drawn(model, {wheel.body, wheel.centre_local});
}

}  // namespace elastocheck::compare
