// Motions of the wheels of a state, from which rates and stiffnesses are read.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "compare/outputs/catalogue/subject.hpp"

namespace elastocheck::compare {

// Why a figure has no value.
inline constexpr auto does_not_roll = "its wheels move only together: the axle does not roll";
inline constexpr auto no_rate =
    "the travel of the wheel is unresisted or blocked, or an element is at a kink of its law";

using Causes = std::vector<std::array<Motions, causes>>;

// Linear combination of motions, each with its weight.
Motions sum(const std::vector<std::pair<double, const Motions*>>& weighted);
// A unit cause on this wheel, and `other` times as much on the others.
Motions of_axle(const Causes& by, const Subject& x, int cause, double other);
// A unit cause on this wheel, the wheel centres held at their height.
const Motions& held(const Subject& x, int cause);
// A unit cause on this wheel at constant wheel loads. Null where nothing resists the wheel.
const Motions* unheld(const Subject& x, int cause);
// Value of a figure where WheelResponse::free is missing: undefined where nothing resists the wheels,
// NaN where the leg failed.
double without_free(const Subject& x);

// Heave: all wheels raised by 1 m; with tied wheels, their common motion scaled so that this wheel
// rises by 1 m.
Motions raised(const Subject& x);
// Roll: the left wheel of an axle raised and the right one lowered by 1 m. Pre: the wheels are not tied.
Motions rolled(const Subject& x);

// Instant centre of the carrier of a wheel, all wheels rising alike: seen from the front, in the
// transverse plane of the wheel centre, and from the side, in its longitudinal plane. At infinity it
// is undefined.
Vector3d front_instant_centre(const Subject& x);
Vector3d side_instant_centre(const Subject& x);

// Vertical force on this wheel, and `other` times as much on the other one, over the rise of a point
// [N/m]; the wheels free.
double vertical_rate(const Subject& x, int force, const Placed& at, double other = 1);

}  // namespace elastocheck::compare
