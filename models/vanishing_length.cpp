#include "models/vanishing_length.hpp"

#include <cmath>

#include "models/kinds.hpp"

namespace elastocheck {

std::optional<Vanishing> vanishing_length(const Model& model, const Branch& side) {
    std::optional<Vanishing> first;
    for (const Driver& driver : side.drivers) {
        const int joint = driven_joint(driver.what);
        if (joint < 0 || model.joints.at(static_cast<std::size_t>(joint)).driven < 0) continue;
        const int driven = model.joints[static_cast<std::size_t>(joint)].driven;
        const Constraint& constraint = model.constraints[static_cast<std::size_t>(driven)];
        const auto* link = std::get_if<DistanceBetween>(&constraint.kind);
        if (link == nullptr) continue;
        double start = link->length, rate = 0;
        for (const Driver& other : side.drivers)
            if (driven_joint(other.what) == joint) {
                start += other.start;
                rate += other.rate;
            }
        const double end = start + rate * side.to;
        if (start > 0 && end > 0) continue;
        const double a = start > 0 ? -start / rate : 0;
        if (!first || std::abs(a) < std::abs(first->parameter)) first = Vanishing{joint, a, end};
    }
    return first;
}

}  // namespace elastocheck
