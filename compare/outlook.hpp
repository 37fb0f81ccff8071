// What lies ahead of a path whose points give account of themselves: where the stiffness that is left will be gone.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "models/equilibrium_path.hpp"
#include "models/scene.hpp"

namespace elastocheck::compare {

// The value of the parameter near which the stiffness is gone if it goes on falling as over the last three points: as a
// straight line where the branch will divide, as the root of one where it will turn back (towards a limit point a* it is
// √(a* - a)); whichever of both the three points fit. None where it does not fall, or nobody has given account.
std::optional<double> stiffness_gone_near(std::span<const Equilibrium> points);

// "at this rate the stiffness is gone near -211.5 N"; empty where there is nothing to announce: no such value, or one
// farther ahead than the way behind.
std::string outlook(std::span<const Equilibrium> points, ParameterUnit unit);

}  // namespace elastocheck::compare
