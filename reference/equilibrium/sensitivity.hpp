// Sensitivity of an equilibrium to the numbers of the scene, by automatic differentiation of the
// balances.
#pragma once

#include <span>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "models/state_rate.hpp"

namespace elastocheck::reference::equilibrium {

// Derivative of the state (poses and reactions) by each number at a constant a:
// ∂E/∂x dx = -∂E/∂m dm (number_rates.hpp). Each of `rates` is a rate of `model`
// (models/state_rate.hpp), with its branch first. One factorisation, one back-substitution per
// number. `state` must be an equilibrium. Throws std::invalid_argument for a state or a rate of
// another model; else as solve().
std::vector<StateRate> sensitivity(const Model& model, const Branch& branch,
                                   const Equilibrium& state, std::span<const Model> rates);

}  // namespace elastocheck::reference::equilibrium
