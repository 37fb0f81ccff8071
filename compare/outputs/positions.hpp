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

// From the wheel's centre to its patch at the design position, ground axes [m].
inline Eigen::Vector3d drawn_arm(const Model& model, const Wheel& wheel) {
    const auto drawn = [&](const Point& p) -> Eigen::Vector3d {
        const Pose& on = model.bodies[static_cast<std::size_t>(p.body)].design;
        return on.r + on.p * p.s_local;
    };
    return drawn(wheel.contact) - drawn({wheel.body, wheel.centre_local});
}

}  // namespace elastocheck::compare
