// How a state answers small changes at its wheels, by one leg: what kinematics and compliance are read from.
//
// What holds the wheels on a branch, jacks and tyres, would answer as well. Two models stand in for that of the branch,
// in the same state:
//
//   free     what jacks and tyres exert acts on as a dead force at the same point, and they are gone
//   jacked   the free one with every wheel centre on a jack of its own, which stands at the height where it is
//
// Of an axle that can only go up and down, or only sway, one wheel centre's height is that of all: one jack says it.
//
// A jack and a dead force at its point, both upright, turn alike when the wheel does, so the tangent is that of the branch
// in all but what holds the wheels.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "compare/legs.hpp"
#include "models/response.hpp"

namespace elastocheck::compare {

using Motions = std::vector<Increment>;  // per Model::bodies, per unit of the cause [m/N, m/(N·m), m/m, ...]

// What acts on a wheel, ground axes: a force at the wheel centre, a moment, a force at the contact patch.
inline constexpr int at_centre = 0, moment_on = 3, at_patch = 6, causes = 9;

struct Answers {
    std::vector<Motions> travel;  // per wheel, jacked: its centre raised by 1 m, the others held
    Motions steering;  // jacked: the steering joint driven by 1 m or 1 rad; empty where none stands
    std::vector<std::array<Motions, causes>> held;  // per wheel and cause, jacked: per N, per N·m
    std::vector<std::array<Motions, causes>> free;  // likewise, free; empty where `why_not_free` says why
    bool tied =
        false;  // the wheels move only as one: `jacked` has one jack, under the first wheel; that motion is
                // the first of `travel`, and the others are none
    std::string why_not;           // there is none of the first three
    std::string why_not_free;      // there is none of the last
    bool nothing_resists = false;  // why not: a wheel is free to move, which is no failure
};

// The joint that steers: the first, other than a jack, that some branch drives. -1 where there is none.
int steering_joint(const Model& model);

// By the leg's own tangent at the state; of the recursion the matrix that its method factorises. `steering` is a position in
// Model::joints, or -1. The `analyses` are of the way: from state to state the two models differ in loads and in the height
// of jacks, of which an analysis knows nothing that is used here.
Answers answer(const Way& way, const Gait& gait, int steering, const Equilibrium& state, Analyses& analyses);
inline Answers answer(const Way& way, const Gait& gait, int steering, const Equilibrium& state) {
    Analyses analyses;
    return answer(way, gait, steering, state, analyses);
}

// The response of one leg; the recursion's with the analysis, which is made where there is none.
Response respond(const Gait& gait, const Model& model, const Branch& branch, const Equilibrium& state,
                 std::span<const Disturbance> disturbances, std::optional<recursive::Analysis>& analysis);

// d(position) of a point of a body, and the turning of the body.
Eigen::Vector3d moved(const Equilibrium& state, const Motions& motions, const Point& point);
Eigen::Vector3d turned(const Motions& motions, BodyId body);

}  // namespace elastocheck::compare
