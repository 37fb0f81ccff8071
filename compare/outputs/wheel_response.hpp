// Linear response of a state to small changes at its wheels, from which characteristics are read. The
// models `jacked` and `free` are those of comparison/compliance.hpp.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "elastocheck/model.hpp"
#include "models/response.hpp"

namespace elastocheck::compare {

// Displacement [m] and rotation [rad] of every body in Model::bodies, per unit of the load or motion that
// causes them (1 N, 1 N·m, 1 m, 1 rad).
using Motions = std::vector<Increment>;

// Indices of the unit wrenches on a wheel along the ground axes x, y, z: three forces at the wheel centre
// begin at `first_centre_force`, three moments at `first_moment`, three forces at the contact patch at
// `first_patch_force`.
inline constexpr int first_centre_force = 0, first_moment = 3, first_patch_force = 6,
                     wrench_count = 9;

struct WheelResponse {
    // Per wheel, of the jacked model: its centre rises by 1 m, the other wheel centres keep their height.
    std::vector<Motions> travel;
    // Of the jacked model: the steering joint moves by 1 m or 1 rad. Empty without a steering joint.
    Motions steering;
    double rack_per_hand_wheel = 0;  // that of the scene, also on a branch that holds the rack
    // Per wheel and wrench index, of the jacked model: motions per N or N·m.
    std::vector<std::array<Motions, wrench_count>> jacked;
    // The same of the free model; empty where `why_not_free` has a reason.
    std::vector<std::array<Motions, wrench_count>> free;
    // The wheels move only together: the jacked model has one jack, under the first wheel. `travel` has
    // its motion for the first wheel, and zero for the others.
    bool tied = false;
    std::string why_not;       // reason why travel, steering and jacked are missing
    std::string why_not_free;  // reason why `free` is missing
    // Two reasons are properties of the model and not failures. `blocked`: the joints hold the wheels, so
    // that no jack raises them. `nothing_resists`: a motion of a wheel has no stiffness.
    bool blocked = false, nothing_resists = false;
};

// Rotation of a body [rad], ground axes; zero for the ground.
inline Eigen::Vector3d turned(const Motions& motions, BodyId body) {
    return body == ground ? Eigen::Vector3d::Zero() : motions[static_cast<std::size_t>(body)].dpi;
}

// A jack: a plane that carries a point of a wheel and is active only where driven.
bool is_jack(const Model& model, std::size_t joint);
// Whether a driver turns the joint.
bool drives_an_angle(const Model& model, int joint);
// Position of the steering joint in Model::joints, -1 if none: of the first branch that drives a joint
// other than a jack the first such joint, a displacement (rack) before an angle (column).
int steering_joint(const Model& model);
// Displacement of the steering joint per angle of the hand wheel, the parameter of a branch that moves
// it by an angle [m/rad]; 0 if there is none, or if that joint is driven by an angle.
double rack_per_hand_wheel(const Model& model);

}  // namespace elastocheck::compare
