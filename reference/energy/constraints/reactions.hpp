// Joint reactions from the Lagrange multipliers.
#pragma once

#include "elastocheck/equilibrium_path.hpp"
#include "reference/energy/constraints/balance.hpp"

namespace elastocheck::reference::energy {

// One wrench per Model::joints, exerted by the joint on its body i about ModelJoint::at. `lambda`
// [m], SI, of Φ.
std::vector<Wrench> reactions(const Model& model, const Chart& centre,
                              const ConstraintValues& values, const Eigen::VectorXd& lambda);

}  // namespace elastocheck::reference::energy
