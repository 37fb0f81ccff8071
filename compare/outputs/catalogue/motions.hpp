// Motions of the wheels of a state, from which rates and stiffnesses are read.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "compare/outputs/catalogue/subject.hpp"

namespace elastocheck::compare {

// Reasons why a figure has no value.
inline constexpr auto does_not_roll = "its wheels move only together: the axle does not roll";
inline constexpr auto no_rate =
    "the travel of the wheel is unresisted or blocked, or an element is at a kink of its law";

// Motions per unit [N, N·m] of each wrench of wheel_response.hpp: per wheel, then per wrench index.
using ResponsesByWheel = std::vector<std::array<Motions, wrench_count>>;

// Σ weight · motions. Pre: at least one term, all for the same model.
Motions weighted_sum(const std::vector<std::pair<double, const Motions*>>& terms);
// Motions under one unit [N, N·m] of the wrench with index `wrench` on `wheel`, and `other` units on each
// other wheel.
Motions axle_motions(const ResponsesByWheel& responses, const Subject& wheel, int wrench,
                     double other);
// Motions per unit [N, N·m] of the wrench with index `wrench` on `wheel`, while jacks hold all wheel
// centres at their height.
const Motions& motions_at_fixed_height(const Subject& wheel, int wrench);
// The same motions while the vertical load of each wheel stays constant. Null where nothing resists a wheel.
const Motions* motions_at_fixed_load(const Subject& wheel, int wrench);
// Value of a figure that needs WheelResponse::free where that is missing: `undefined` where nothing
// resists a wheel, NaN where the solver failed.
double value_without_free_response(const Subject& wheel);

// Heave, per metre: all wheel centres rise by 1 m. Wheels that move only together do not rise alike; their
// common motion is scaled so that the centre of `wheel` rises by 1 m.
Motions heave_motions(const Subject& wheel);
// Roll, per metre: the left wheel of an axle rises by 1 m and the right one sinks by 1 m. Pre: the wheels
// do not move only together.
Motions roll_motions(const Subject& wheel);

// Instant centre of the carrier of `wheel` while all wheels rise alike, ground axes [m]: seen from the
// front, in the transverse plane of the wheel centre; seen from the side, in its longitudinal plane. At
// infinity every coordinate is `undefined`.
Vector3d front_instant_centre(const Subject& wheel);
Vector3d side_instant_centre(const Subject& wheel);

// Vertical force over the rise of `point` that it causes [N/m], positive where a force up raises the
// point, without jacks and tyres. The force has wrench index `force`; `other` times as much acts on the
// other wheels. `undefined` where the point does not rise.
double vertical_rate(const Subject& wheel, int force, const PlacedPoint& point, double other = 1);

}  // namespace elastocheck::compare
