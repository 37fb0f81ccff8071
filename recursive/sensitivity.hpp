// Sensitivity of an equilibrium to the numbers of the scene, by the consistent tangent.
#pragma once

#include <span>

#include "elastocheck/recursive.hpp"
#include "models/state_rate.hpp"

namespace elastocheck::recursive {

// Derivative of the state (poses and reactions) by each number at a constant load factor,
//
// ⎡ ∂G/∂q  Φ_qᵀ ⎤ ⎧ dq ⎫     ⎧ ∂G/∂m dm ⎫
// ⎣ Φ_q     0   ⎦ ⎩ dλ ⎭ = - ⎩ ∂Φ/∂m dm ⎭ ,   G = f_elast + Φ_qᵀ λ - f_ext
//
// with ∂/∂m by number_rates.hpp. Each of `rates` is a rate of `model` (models/state_rate.hpp), with
// its branch first. Two factorisations, one back-substitution per number. `state` must be an
// equilibrium: what its balance misses is missed by the derivative too. Throws std::invalid_argument
// for a state or a rate of another model; else as solve().
std::vector<StateRate> sensitivity(const Model& model, const Branch& branch,
                                   const Equilibrium& state, std::span<const Model> rates,
                                   const Analysis& analysis);
std::vector<StateRate> sensitivity(const Model& model, const Branch& branch,
                                   const Equilibrium& state, std::span<const Model> rates);

}  // namespace elastocheck::recursive
