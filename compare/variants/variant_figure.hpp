// A figure of the variants of a scene: an output at a station of a branch, or its extreme over the
// branch.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "elastocheck/channels.hpp"

namespace elastocheck::compare::variants {

enum class Over { station, least, largest };

struct VariantFigure {
    std::string name;    // the user's own
    std::string output;  // "toe", "bump_steer"
    std::string branch;
    Over over = Over::station;
    double at = 0;  // parameter of the branch [SI], of a station
    Unit unit = Unit::none;
};

// Of "toe@jounce:3000", "min toe@jounce", "bump_steer". `outputs`: figure_outputs() of the model.
// Throws std::invalid_argument for what the scene has not, with the nearest name, and for a reaction
// that redundant joints share.
VariantFigure parse_variant_figure(const std::string& name, std::string words, const Model& model,
                                   std::span<const Channel> outputs);

}  // namespace elastocheck::compare::variants
