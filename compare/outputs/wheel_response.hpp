// How the wheels of a state respond to small changes: the motions from which characteristics are read.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "elastocheck/model.hpp"
#include "models/response.hpp"

namespace elastocheck::compare {

// per Model::bodies, per unit of the cause [m/N, m/(N·m), m/m, ...]
using Motions = std::vector<Increment>;

// Wrenches on a wheel, ground axes: a force at the wheel centre, a moment, a force at
// the contact patch.
inline constexpr int at_centre = 0, moment_on = 3, at_patch = 6, causes = 9;

struct WheelResponse {
    // per wheel, jacked: its centre raised by 1 m, the other wheel centres held
    std::vector<Motions> travel;
    // jacked: steering joint driven by 1 m or 1 rad; empty without a steering joint
    Motions steering;
    std::vector<std::array<Motions, causes>> held;  // per wheel and cause, jacked: per N, per N·m
    std::vector<std::array<Motions, causes>> free;  // likewise, free; empty with `why_not_free`
    // the wheels move only together: `jacked` has one jack, under the first wheel. `travel` then
    // holds that motion first, and its other entries are empty
    bool tied = false;
    std::string why_not;       // reason why travel, steering and held are missing
    std::string why_not_free;  // reason why `free` is missing
    // These reasons are no failures: the joints hold the wheels, so that no jack raises them; a
    // wheel moves freely.
    bool blocked = false, nothing_resists = false;
};

// Rotation of a body.
inline Eigen::Vector3d turned(const Motions& motions, BodyId body) {
    return body == ground ? Eigen::Vector3d::Zero() : motions[static_cast<std::size_t>(body)].dpi;
}

// A jack: a plane that carries a point of a wheel and is active only where driven.
bool is_jack(const Model& model, std::size_t joint);
// Whether a driver turns the joint.
bool drives_an_angle(const Model& model, int joint);
// Position of the steering joint in Model::joints: the first joint, other than a jack, that some
// branch drives, before a column that this branch turns a displacement; -1 if none.
int steering_joint(const Model& model);
// Displacement of the steering joint per angle of the hand wheel, the parameter of a branch that moves
// it by an angle [m/rad]; 0 if there is none, or if that joint is itself turned.
double rack_per_hand_wheel(const Model& model);

}  // namespace elastocheck::compare
