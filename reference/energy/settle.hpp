// The equilibrium at a = 0, where a branch starts.
#pragma once

#include "reference/energy/branch.hpp"

namespace elastocheck::reference::energy {

// From the design pose to the equilibrium at a = 0. On failure the reason says how much of what is held could
// be applied.
std::optional<Failure> settle(const Path& path, State& state);

// The joint that cannot be closed at parameter a, if |Φ|² has a minimum near `poses` that is not zero.
std::optional<std::string> contradicting_joint(const Path& path, double a, const std::vector<Pose>& poses);

}  // namespace elastocheck::reference::energy
