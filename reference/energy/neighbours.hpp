// States of neighbouring models by the second derivatives of the energy.
#pragma once

#include <span>

#include "elastocheck/energy.hpp"
#include "models/neighbours.hpp"

namespace elastocheck::reference::energy {

// models/neighbours.hpp with G = (∂V/∂x + Φ_qᵀ λ, Φ) in the chart about the state, one entry per
// stencil. `state` must be an equilibrium. Outcomes besides those of NeighbourStates:
// not_conservative, too_large, branch_lost as of solve(). Throws std::invalid_argument for a state or
// a neighbour of another model; else as solve().
std::vector<NeighbourStates> neighbour_states(const Model& model, const Branch& branch,
                                              const Equilibrium& state,
                                              std::span<const Neighbours> stencils);

}  // namespace elastocheck::reference::energy
