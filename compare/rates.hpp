// How fast the outputs change with the load, exactly, where the branch is a polynomial; and the way back from
// travel to load.
#pragma once

#include <optional>
#include <vector>

#include "models/model.hpp"
#include "recursive/series/path.hpp"

namespace elastocheck::compare {

struct ChannelRates {
    double travel = 0;          // d travel / d load factor [mm per unit]; its inverse is the wheel rate
    std::vector<double> slope;  // of every main channel, in the order of `channels` [mm or deg per unit]
};

// From the derivative of the configuration: with v = dr + ω × s for a point and ω × e for the spin axis e,
//
//   d toe = side (e_y de_x - e_x de_y) / (e_x² + e_y²)      d camber = -de_z / √(1 - e_z²)
ChannelRates channel_rates(const Model& model, const Branch& branch, const recursive::series::Path& path,
                           recursive::series::Place place);

// The place where the travel is `travel` [mm], by Newton on the polynomial between the ends of the path;
// nothing where the path does not lead there. For paths along which travel grows or falls throughout.
std::optional<recursive::series::Place> place_at_travel(const Model& model, const Branch& branch,
                                                        const recursive::series::Path& path, double travel);

}  // namespace elastocheck::compare
