// Derivatives of outputs along motions of the bodies.
#pragma once

#include <span>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/model.hpp"
#include "models/response.hpp"

namespace elastocheck::recursive::series {
struct Path;
struct Place;
}  // namespace elastocheck::recursive::series

namespace elastocheck::compare {

// The state with its bodies moved by t times a motion, one increment per body.
Equilibrium moved_by(Equilibrium state, std::span<const Increment> motion, double t);

// d channel / da of every channel, in its unit per unit of the parameter (unit_of(branch.unit)); NaN
// of channels that are not kinematic. Four-point differences along the motion of the path, of 1e-4 m
// or rad. The rate of travel over a load is the inverse of the wheel rate.
std::vector<double> channel_rates(const Model& model, std::span<const Channel> channels,
                                  const Branch& branch, const recursive::series::Path& path,
                                  recursive::series::Place place);

}  // namespace elastocheck::compare
