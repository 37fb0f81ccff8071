// States of neighbouring models by the Jacobian of the full equations.
#pragma once

#include <span>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "models/neighbours.hpp"

namespace elastocheck::reference::equilibrium {

// models/neighbours.hpp with the residual E of system.hpp in the scales of `model`, one entry per
// stencil, by one factorisation. `state` must be an equilibrium. Throws std::invalid_argument for a
// state or a neighbour of another model; else as solve().
std::vector<NeighbourStates> neighbour_states(const Model& model, const Branch& branch,
                                              const Equilibrium& state,
                                              std::span<const Neighbours> stencils);

}  // namespace elastocheck::reference::equilibrium
