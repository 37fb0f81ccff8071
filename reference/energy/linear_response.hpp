// Forward sensitivity of a state to small disturbances, by the reduced Hessian of the energy.
#pragma once

#include <span>

#include "elastocheck/energy.hpp"
#include "models/response.hpp"

namespace elastocheck::reference::energy {

// (dr, dπ) of every body per unit of each disturbance s, at the poses and the load factor of
// `state`. λ are the least-squares multipliers there; Equilibrium::reactions are not used. In the
// chart about these poses, with J = ∂Φ/∂ξ, J Z = 0 and H = ∂²(V + λᵀΦ)/∂ξ², as for the tangent of a
// branch (branch.cpp):
//
//   J t = -∂Φ/∂s                  Zᵀ ((H + A) t + ∂²(V + λᵀΦ)/∂ξ∂s) = 0
//
// A is that of the acting loads without potential (balance.hpp). A disturbing moment m on a body adds -m to
// the gradient: at the centre of a chart it has the potential -m·φ, whose A is of second order.
//
// Outcomes. not_conservative, too_large: as in solve() for one value. branch_lost: a bushing is at
// the end of its law. singular: a resisting motion has lost its stiffness, or the branch's own
// drivers push an unresisted motion, at a limit point. loaded_idle_mode: a disturbance pushes an
// unresisted motion. inconsistent_constraints: redundant joints prevent the motion of an offset.
// not_finite. Pre: as for `solve`; a wrench acts on a body, a moved joint has an offset, the state
// has one pose per body; std::invalid_argument otherwise.
Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances);

}  // namespace elastocheck::reference::energy
