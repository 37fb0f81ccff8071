// A length that the drivers of a branch shorten to zero.
#pragma once

#include <optional>

#include "elastocheck/model.hpp"

namespace elastocheck {

// A joint that holds two points at a distance, and the parameter from 0 on at which the drivers of a
// side of the branch have shortened that distance to zero.
struct Vanishing {
    int joint = -1;
    double at = 0;
    double to = 0;  // the distance at the end of the side, not positive [m]
};
std::optional<Vanishing> vanishing_length(const Model& model, const Branch& side);

}  // namespace elastocheck
