// Parameter of a branch in its display unit, for messages.
#pragma once

#include <fmt/format.h>

#include <numbers>
#include <string>

#include "elastocheck/scene.hpp"

namespace elastocheck {

// "1200 N", "35.2 mm" for a in SI.
inline std::string parameter_text(ParameterUnit unit, double a, int digits = 6) {
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

}  // namespace elastocheck
