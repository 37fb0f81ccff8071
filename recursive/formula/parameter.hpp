// Parameter of a branch with its display unit, for messages: "1200 N", "35.2 mm".
#pragma once

#include <fmt/format.h>

#include <numbers>
#include <string>

#include "models/vanishing_length.hpp"

namespace elastocheck::recursive {

inline std::string in_unit(ParameterUnit unit, double a, int digits = 6) {
    switch (unit) {
        case ParameterUnit::newton: return fmt::format("{:.{}g} N", a, digits);
        case ParameterUnit::newton_metre: return fmt::format("{:.{}g} N·m", a, digits);
        case ParameterUnit::metre: return fmt::format("{:.{}g} mm", 1e3 * a, digits);
        case ParameterUnit::radian:
            return fmt::format("{:.{}g} deg", a * 180 / std::numbers::pi, digits);
        case ParameterUnit::none: break;
    }
    return fmt::format("{:.{}g}", a, digits);
}

inline std::string no_length(const Model& model, const Branch& branch, const Vanishing& gone) {
    return fmt::format("joint '{}' would have no length from {} on",
                       model.joints[static_cast<std::size_t>(gone.joint)].name,
                       in_unit(branch.unit, gone.at));
}

}  // namespace elastocheck::recursive
