// Sensitivity of an equilibrium to the numbers of the scene, by the second derivatives of the
// energy.
#pragma once

#include <span>

#include "elastocheck/energy.hpp"
#include "models/state_rate.hpp"

namespace elastocheck::reference::energy {

// Derivative of the state (poses and reactions) by each number at a constant a, from the stationarity
// of V + λᵀΦ: its Hessian, and its mixed derivatives by x and the numbers (number_rates.hpp). Each of
// `rates` is a rate of `model` (models/state_rate.hpp), with its branch first. `state` must be an
// equilibrium. Outcomes besides those of StateRate: not_conservative, too_large, branch_lost as of
// solve(). Throws std::invalid_argument for a state or a rate of another model; else as solve().
std::vector<StateRate> sensitivity(const Model& model, const Branch& branch,
                                   const Equilibrium& state, std::span<const Model> rates);

}  // namespace elastocheck::reference::energy
