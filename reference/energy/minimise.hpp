// One chart: V(x) → min subject to Φ(x) = 0, by NLopt.
#pragma once

#include "reference/energy/balance.hpp"

namespace elastocheck::reference::energy {

struct Minimisation {
    std::vector<Pose> poses;  // the best point seen
    double excess = 0;        // its measure of acceptance; NaN when nothing finite was seen
    long evaluations = 0;
};

// In the chart about `centre`, from the centre, in coordinates that make H the unit matrix along the
// constraints; `free` are the modes of H. Stops when a point is well within `tolerance`, when it no longer improves, or at the limit.
// NLopt's status is not asked. Of the equilibria that an idle motion (columns of `idle`, in ξ) leads through,
// all alike, the nearest is taken.
Minimisation minimise(const Model& model, const Prescribed& prescribed, const Scales& scales,
                      const std::vector<Pose>& centre, const Balance& at, const Eigen::MatrixXd& H,
                      const Modes& free, const Eigen::MatrixXd& idle, double tolerance, int evaluation_limit);

}  // namespace elastocheck::reference::energy
