// Exact rates of the outputs with respect to the parameter where the branch is a polynomial, and
// the inverse: the parameter for a given output value.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "elastocheck/channels.hpp"
#include "elastocheck/model.hpp"
#include "recursive/series/path.hpp"

namespace elastocheck::compare {

// d channel / da of every channel, in its unit per unit of the parameter (unit_of(branch.unit));
// NaN for channels that are not kinematic. The inverse of the rate of travel over a load is the
// wheel rate. Computed from the derivative of the configuration: with v = dr + ω × s for a point
// and ω × e for the spin axis e,
//
//   d toe = side (e_y de_x - e_x de_y) / (e_x² + e_y²)      d camber = -de_z / √(1 - e_z²)
//
// and the other channels likewise; NaN where the output is undefined.
std::vector<double> channel_rates(const Model& model, std::span<const Channel> channels,
                                  const Branch& branch, const recursive::series::Path& path,
                                  recursive::series::Place place);

// Place at which a kinematic channel has this value, by Newton's method on the polynomial between
// the ends of the path; empty where the path does not reach the value. Pre: the channel is
// monotonic along the path.
std::optional<recursive::series::Place> place_at(const Model& model, const Channel& channel,
                                                 const Branch& branch,
                                                 const recursive::series::Path& path, double value);

}  // namespace elastocheck::compare
