// How a state answers small disturbances, by the Hessian of the energy along the constraints.
#pragma once

#include <span>

#include "models/response.hpp"
#include "reference/energy/solve.hpp"

namespace elastocheck::reference::energy {

// (dr, dπ) of every body for a unit of each disturbance s, at the poses and the load factor of `state`; λ are the best
// multipliers there, Equilibrium::reactions are not read. In the chart about these poses, with J = ∂Φ/∂ξ, J Z = 0 and
// H = ∂²(V + λᵀΦ)/∂ξ², as for the tangent of a branch (branch.cpp):
//
//   J t = -∂Φ/∂s                  Zᵀ ((H + A) t + ∂²(V + λᵀΦ)/∂ξ∂s) = 0
//
// A of the dead moments that act (balance.hpp). A small moment m on a body is -m in the gradient: in the middle of a chart
// it has the potential -m·φ, whose A is of second order.
//
// not_conservative, too_large: where solve() says so of one value. branch_lost: a bushing stands where its law ends.
// singular: no stiffness is left of what resisted, or the branch's own drivers push what nothing resists, at a limit point. loaded_idle_mode: a disturbance pushes what
// nothing resists. inconsistent_constraints: joints that repeat each other do not let an offset move. not_finite.
// Pre: as for `solve`; a wrench acts on a body, a moved joint has an offset, the state has one pose a body:
// std::invalid_argument otherwise.
Response respond(const Model& model, const Branch& branch, const Equilibrium& state,
                 std::span<const Disturbance> disturbances);

}  // namespace elastocheck::reference::energy
