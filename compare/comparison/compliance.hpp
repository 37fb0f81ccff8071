// Response of a state to small changes at its wheels, by one leg: input of the kinematics and
// compliance characteristics.
//
// Compliance is computed with jacks and tyres removed, since both would add their own stiffness.
// Two models replace that of the branch, in the same state:
//
//   free     jacks and tyres removed; the forces that they exert act as dead forces at their points
//   jacked   the free model with one jack under every wheel centre, at the height of that centre
//
// Where the wheels of an axle move only together (heave only, or roll only), the height of one
// wheel centre fixes all of them, and the jacked model has one jack.
//
// A jack and a dead force at its point are both vertical and have the same geometric stiffness when
// the wheel turns. The tangent therefore equals that of the branch except for the removed supports.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "models/response.hpp"
#include "recursive/linear_response.hpp"

namespace elastocheck::compare {

// per Model::bodies, per unit of the cause [m/N, m/(N·m), m/m, ...]
using Motions = std::vector<Increment>;

// Wrenches on a wheel, ground axes: a force at the wheel centre, a moment, a force at the contact
// patch.
inline constexpr int at_centre = 0, moment_on = 3, at_patch = 6, causes = 9;

// Cached analyses of the recursion for the response models of a branch side. They do not depend on
// the state, but for the elimination orders, which are those of the last one: they change rounding.
struct Analyses {
    std::optional<recursive::ResponseAnalysis> free, jacked, tied;  // computed on first use
    std::optional<std::vector<int>> dependent_rows;                 // of diagnosis.hpp, likewise
};

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

// Position of the steering joint in Model::joints: the first joint, other than a jack, that some
// branch drives; -1 if none.
int steering_joint(const Model& model);

// Computes the response with the tangent of the leg at `state`; for the recursion, with the matrix
// that its method factorises. `steering`: position in Model::joints, or -1. `analyses` belong to
// the branch side and are reused over its states: the two models differ between states only in
// loads and jack heights, which an analysis does not use. Without `with_free` the wheels are not
// freed, and WheelResponse::free is empty.
WheelResponse wheel_response(const BranchSide& side, const SolverSettings& solver, int steering,
                             const Equilibrium& state, Analyses& analyses, bool with_free = true);
inline WheelResponse wheel_response(const BranchSide& side, const SolverSettings& solver,
                                    int steering, const Equilibrium& state) {
    Analyses analyses;
    return wheel_response(side, solver, steering, state, analyses);
}

// Response by one leg. `analysis` is that of the recursion, computed here if empty.
Response linear_response(const SolverSettings& solver, const Model& model, const Branch& branch,
                         const Equilibrium& state, std::span<const Disturbance> disturbances,
                         std::optional<recursive::ResponseAnalysis>& analysis);

// Displacement of a point of a body, and rotation of the body.
Eigen::Vector3d moved(const Equilibrium& state, const Motions& motions, const Point& point);
Eigen::Vector3d turned(const Motions& motions, BodyId body);

}  // namespace elastocheck::compare
