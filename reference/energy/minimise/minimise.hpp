// Constrained minimisation in one chart: V(x) → min subject to Φ(x) = 0, by SLSQP (Kraft 1988) of
// NLopt.
#pragma once

#include "reference/energy/constraints/balance.hpp"

namespace elastocheck::reference::energy {

struct Minimisation {
    std::vector<Pose> poses;  // the best point seen
    double excess = 0;        // its acceptance measure; NaN when no finite point was seen
    long evaluations = 0;
};

// In the chart about `centre`, starting there, in coordinates that make H the unit matrix along the
// constraints; `free` are the modes of H. Stops at a point well within `tolerance`, at stagnation,
// or at the limit. NLopt's status is not used. Where an idle motion (columns of `idle`, in ξ) leads
// through a family of equal minima, the nearest is taken.
Minimisation minimise(const Model& model, const Prescribed& prescribed, const Scales& scales,
                      const std::vector<Pose>& centre, const Balance& at, const Eigen::MatrixXd& H,
                      const Modes& free, const Eigen::MatrixXd& idle, double tolerance,
                      int evaluation_limit);

}  // namespace elastocheck::reference::energy
