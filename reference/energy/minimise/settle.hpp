// The equilibrium at a = 0, where a branch starts.
#pragma once

#include "reference/energy/minimise/branch.hpp"

namespace elastocheck::reference::energy {

// Homotopy from the design pose to the equilibrium at a = 0. On failure the reason gives the
// applied share of the held loads and offsets.
std::optional<Failure> settle(const Path& path, State& state);

// The joint that cannot be closed at parameter a, if |Φ|² has a nonzero minimum near `poses`.
std::optional<std::string> contradicting_joint(const Path& path, double a,
                                               const std::vector<Pose>& poses);

}  // namespace elastocheck::reference::energy
