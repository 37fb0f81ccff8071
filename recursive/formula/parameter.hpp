// Parameter of a branch with its display unit, for messages: "1200 N", "35.2 mm".
#pragma once

#include <fmt/format.h>

#include <numbers>
#include <string>

#include "elastocheck/scene.hpp"

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

}  // namespace elastocheck::recursive
