// Constrained minimisation in one chart: V(x) → min subject to Φ(x) = 0, by SLSQP (Kraft
// 1988) of NLopt.
#pragma once

#include "reference/energy/minimise/branch.hpp"

namespace elastocheck::reference::energy {

struct Minimisation {
    std::vector<Pose> poses;  // the best point seen
    double excess = 0;        // its acceptance measure; NaN when no finite point was seen
    long evaluations = 0;
};

// In the chart about the poses of `centre`, starting there, in coordinates that make its H the unit
// matrix along the constraints. Stops at a point well within the options' tolerance, at stagnation,
// or at the limit of evaluations. NLopt's status is not used. Where an idle motion (columns of
// `idle`, in ξ) leads through a family of equal minima, the nearest is taken.
Minimisation minimise(const Path& path, const State& centre, const Eigen::MatrixXd& idle,
                      int evaluation_limit);

}  // namespace elastocheck::reference::energy
