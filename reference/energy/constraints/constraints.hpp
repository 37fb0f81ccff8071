// Basic constraints as equations Φ(x; a) = 0, with hand-derived derivatives.
#pragma once

#include <optional>

#include "elastocheck/model.hpp"
#include "reference/energy/constraints/jacobian.hpp"
#include "reference/energy/potential/chart.hpp"
#include "reference/energy/potential/curvature.hpp"
#include "reference/energy/potential/prescribed.hpp"

namespace elastocheck::reference::energy {

struct ConstraintValues {
    Eigen::VectorXd Phi;   // minus the prescribed gap [m]: lengths [m], cosines [-]
    Eigen::VectorXd dPhi;  // Φ(x) - Φ(0), to its own relative accuracy [m]
    Jacobian Phi_q;        // ∂Φ/∂x [m × 6nb]
};
ConstraintValues constraints(const Model& model, const Prescribed& prescribed, const Chart& chart);

// Adds λᵀ ∂²Φ/∂x² of one constraint to H [6nb × 6nb], at the centre of the chart; `lambda` of its
// rows, `offset` as in Prescribed.
void add_curvature(const ConstraintKind& kind, double offset, const Chart& chart,
                   const double* lambda, Blocks& H);

// ∂/∂a of both where `prescribed` moves with `rate`.
struct ConstraintRates {
    Eigen::VectorXd Phi_a;  // ∂Φ/∂a [m]
    Jacobian Phi_qa;        // ∂²Φ/∂x∂a [m × 6nb]
};
ConstraintRates constraint_rates(const Model& model, const Prescribed& prescribed,
                                 const Prescribed& rate, const Chart& chart);

// Length, offset [m] or angle [rad] of a constraint at the centre of the chart; an angle within
// half a turn of the constraint's own. Empty for constraints without an offset.
std::optional<double> measured_offset(const ConstraintKind& kind, const Chart& chart);

// The constraint's own length, offset or angle; 0 where it has none.
double own_offset(const ConstraintKind& kind);

}  // namespace elastocheck::reference::energy
