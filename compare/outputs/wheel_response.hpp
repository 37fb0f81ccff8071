// Linear response of a state to small changes at its wheels, from which characteristics are read. The
// models `jacked` and `free` are those of comparison/compliance.hpp.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "elastocheck/model.hpp"
#include "models/response.hpp"

namespace elastocheck::compare {

// per Model::bodies, per unit of the cause [m/N, m/(N·m), m/m, ...]
using Motions = std::vector<Increment>;

// Unit wrenches on a wheel, ground axes: first index of the three forces at the wheel centre, of the three
// moments, of the three forces at the contact patch; and their number.
inline constexpr int at_centre = 0, moment_on = 3, at_patch = 6, causes = 9;

struct WheelResponse {
    // per wheel, jacked: its centre raised by 1 m, the other wheel centres held
    std::vector<Motions> travel;
    // jacked: steering joint driven by 1 m or 1 rad; empty without a steering joint
    Motions steering;
    std::vector<std::array<Motions, causes>> held;  // per wheel and cause, jacked: per N, per N·m
    std::vector<std::array<Motions, causes>> free;  // likewise, free; empty with `why_not_free`
    // the wheels move only together: `jacked` has one jack, under the first wheel. `travel` then has
    // its motion first, and zero for the other wheels
    bool tied = false;
    std::string why_not;       // reason why travel, steering and held are missing
    std::string why_not_free;  // reason why `free` is missing
    // Two of these reasons are properties of the model, not failures: the joints hold the wheels, so
    // that no jack raises them; nothing resists a wheel.
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
// Position of the steering joint in Model::joints, -1 if none: of the first branch that drives a joint
// other than a jack the first such joint, a displacement (rack) before an angle (column).
int steering_joint(const Model& model);
// Displacement of the steering joint per angle of the hand wheel, the parameter of a branch that moves
// it by an angle [m/rad]; 0 if there is none, or if that joint is itself turned.
double rack_per_hand_wheel(const Model& model);

}  // namespace elastocheck::compare
