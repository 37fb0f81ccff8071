// The four basic constraints as equations Φ(x) = 0, with their Jacobian by hand.
#pragma once

#include "models/model.hpp"
#include "reference/energy/chart.hpp"

namespace elastocheck::reference::energy {

struct ConstraintValues {
    Eigen::VectorXd Phi;    // [m]: lengths [m], cosines [-]
    Eigen::VectorXd dPhi;   // Φ(x) - Φ(0), with its own relative accuracy [m]
    Eigen::MatrixXd Phi_q;  // ∂Φ/∂x [m × 6nb]
};
ConstraintValues constraints(const Model& model, const Chart& chart);

}  // namespace elastocheck::reference::energy
