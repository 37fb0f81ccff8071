// Derivatives of the deformation and force of elements by a number of the scene, outputs of
// compare/comparison/elements.hpp.
#pragma once

#include "elastocheck/channels.hpp"
#include "elastocheck/model.hpp"
#include "models/state_rate.hpp"

namespace elastocheck::compare {

// SI per unit of the number: `model` changes by `rate`, both on the branch, the state by
// `state_rate`. NaN where the element is not active.
double element_rate(const Model& model, const Branch& branch, const Equilibrium& state,
                    const OfElement& which, const Model& rate, const StateRate& state_rate);
// Of the argument of the law, ℓ - ℓ₀ for axis 0 of a spring, or e - e₀ of this axis.
double deformation_rate(const Model& model, const Branch& branch, const Equilibrium& state,
                        std::size_t element, std::size_t axis, const Model& rate,
                        const StateRate& state_rate);

}  // namespace elastocheck::compare
