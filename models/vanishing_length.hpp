// A length that the drivers of a branch shorten to zero.
#pragma once

#include <optional>

#include "elastocheck/model.hpp"

namespace elastocheck {

// The first Distance joint whose length the drivers of a side of a branch shorten to zero or below.
struct Vanishing {
    int joint = -1;        // position in Model::joints
    double parameter = 0;  // a at which the length is zero
    double length = 0;     // at the end of the side, not positive [m]
};
// None if all lengths stay positive.
std::optional<Vanishing> vanishing_length(const Model& model, const Branch& side);

}  // namespace elastocheck
