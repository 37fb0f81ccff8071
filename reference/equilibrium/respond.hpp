// How a state answers small disturbances, by the Jacobian of the full equations.
#pragma once

#include <span>

#include "models/response.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck::reference::equilibrium {

// (dr, dπ) of every body for a unit of each disturbance s, which stands as a driver of rate one beside all others at rest:
// E(x; s) = 0 differentiated where s = 0,
//
//   ∂E/∂x dx = -∂E/∂s      [n × n], n = 6 nb + m (system.hpp)
//
// Both derivatives by automatic differentiation, at the poses and the load factor of `state`. Its reactions are not read:
// E is linear in them, and those that leave least out of balance are taken.
//
// not_finite: the state or what follows. singular: ∂E/∂x has no factors, none but round-off resists a disturbance, or what
// the branch's own drivers ask is not reached, at a limit point. loaded_idle_mode, inconsistent_constraints: a disturbance asks what ∂E/∂x never reaches, a body or joints are
// named. Throws std::invalid_argument as `solve` does, where a wrench acts on no body, a moved joint has no offset, or the
// state has not one pose a body.
Response respond(const Model& model, const Branch& branch, const Equilibrium& state,
                 std::span<const Disturbance> disturbances);

}  // namespace elastocheck::reference::equilibrium
