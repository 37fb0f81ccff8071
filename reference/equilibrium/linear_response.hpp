// Forward sensitivity of a state to small disturbances, by the Jacobian of the full equations.
#pragma once

#include <memory>
#include <span>

#include "elastocheck/equilibrium.hpp"
#include "models/response.hpp"

namespace elastocheck::reference::equilibrium {

// (dr, dπ) of every body per unit of each disturbance s. The disturbance is a driver of rate one,
// all other drivers at rest: E(x; s) = 0 differentiated at s = 0,
//
//   ∂E/∂x dx = -∂E/∂s      [n × n], n = 6 nb + m (system.hpp)
//
// Both derivatives by automatic differentiation at the poses and the load factor of `state`. The
// reactions of `state` are not used: E is linear in the reactions, and those with the least
// imbalance are computed.
//
// Outcomes. not_finite: the state or the result. singular: ∂E/∂x cannot be factorised, a
// disturbance meets only round-off stiffness, or a limit point prevents the motion of the
// branch's own drivers. loaded_idle_mode, inconsistent_constraints: a disturbance lies outside
// the range of ∂E/∂x; the detail names a body or joints. Throws std::invalid_argument as `solve`
// does, and where a wrench acts on no body, a moved joint has no offset, or `state` does not have
// one pose per body.
//
// `orders`: elimination orders, kept for the states of models of one structure
// (models/structure.hpp); made where empty. They save time and change no digit.
struct Orders;
Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances,
                         std::shared_ptr<const Orders>* orders = nullptr);

}  // namespace elastocheck::reference::equilibrium
