// States of neighbouring models by the consistent tangent of this leg.
#pragma once

#include <span>

#include "elastocheck/recursive.hpp"
#include "models/neighbours.hpp"

namespace elastocheck::recursive {

// models/neighbours.hpp with G of (28) and Φ, one entry per stencil:
//
// ⎡ ∂G/∂q  Φ_qᵀ ⎤ ⎧ dq ⎫     ⎧ Σ w_k ΔG_k ⎫
// ⎣ Φ_q     0   ⎦ ⎩ dλ ⎭ = - ⎩ Σ w_k ΔΦ_k ⎭ ,   G = f_elast + Φ_qᵀ λ - f_ext
//
// Two factorisations. `state` must be an equilibrium. Throws
// std::invalid_argument for a state or a neighbour of another model; else as solve().
std::vector<NeighbourStates> neighbour_states(const Model& model, const Branch& branch,
                                              const Equilibrium& state,
                                              std::span<const Neighbours> stencils,
                                              const Analysis& analysis);

}  // namespace elastocheck::recursive
