// Minimum of the energy of a large model: Newton steps of its sparse quadratic model (quadratic.hpp),
// each shortened until V + λᵀΦ + ½ |Φ|² falls, and each from a chart about the last pose. The
// multipliers start as at the equilibrium `near` and change by those of each step; the least-squares
// ones, which cost more than the step, judge the minimum.
#pragma once

#include "reference/energy/minimise/branch.hpp"

namespace elastocheck::reference::energy {

Attempt descend(const Path& path, double a, const std::vector<Pose>& start, const State& near);

}  // namespace elastocheck::reference::energy
