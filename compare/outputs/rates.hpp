// Derivatives of outputs, by dual numbers: along any first-order motion of the bodies, along a
// branch that is a polynomial, and by a number of the model.
#pragma once

#include <span>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/model.hpp"
#include "models/response.hpp"
#include "models/state_rate.hpp"

namespace elastocheck::recursive::series {
struct Path;
struct Place;
}  // namespace elastocheck::recursive::series

namespace elastocheck::compare {

// Derivative of an output along a motion of the bodies, one increment per Model::bodies; in SI, per
// unit of the motion. NaN for outputs that are not kinematic, and where the output is undefined.
double rate_of(const Model& model, const Reads& reads, const Equilibrium& state,
               std::span<const Increment> motion);

// Derivative of an output by a number of the model, in SI per unit of the number: the model changes
// by `rate`, what the output reads by `reads_rate`, the state by `state_rate`. NaN for outputs that
// need more than the state (forces of elements, characteristics), and where it is undefined.
double rate_of(const Model& model, const Reads& reads, const Equilibrium& state, const Model& rate,
               const Reads& reads_rate, const StateRate& state_rate);
// What each of channels(model) reads, by its rates: points in their bodies, numbers of the design
// position.
std::vector<Reads> read_rates(const Model& model, const Model& rate);

// d channel / da of every channel, in its unit per unit of the parameter (unit_of(branch.unit)).
// The inverse of the rate of travel over a load is the wheel rate.
std::vector<double> channel_rates(const Model& model, std::span<const Channel> channels,
                                  const Branch& branch, const recursive::series::Path& path,
                                  recursive::series::Place place);

}  // namespace elastocheck::compare
