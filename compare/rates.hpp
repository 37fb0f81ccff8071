// How fast the outputs change with the parameter, exactly, where the branch is a polynomial; and the way back
// from an output to the parameter.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compare/channels.hpp"
#include "models/model.hpp"
#include "recursive/series/path.hpp"

namespace elastocheck::compare {

// d channel / da of every channel, each in its unit per unit of the parameter (unit_of(branch.unit)); NaN for
// those that are not kinematic. The inverse of the rate of travel over a load is the wheel rate. From the
// derivative of the configuration: with v = dr + ω × s for a point and ω × e for the spin axis e,
//
//   d toe = side (e_y de_x - e_x de_y) / (e_x² + e_y²)      d camber = -de_z / √(1 - e_z²)
//
// and likewise of the others; NaN where the output is undefined.
std::vector<double> channel_rates(const Model& model, std::span<const Channel> channels, const Branch& branch,
                                  const recursive::series::Path& path, recursive::series::Place place);

// The place where a kinematic channel has this value, by Newton on the polynomial between the ends of the
// path; nothing where the path does not lead there. For paths along which the channel rises or falls
// throughout.
std::optional<recursive::series::Place> place_at(const Model& model, const Channel& channel,
                                                 const Branch& branch, const recursive::series::Path& path,
                                                 double value);

}  // namespace elastocheck::compare
