// The two readings of a curve: at equal parameter, at equal abscissa.
#pragma once

#include <string>
#include <string_view>

namespace elastocheck::compare {

// "load" for a parameter in N or N·m, else "parameter".
inline std::string parameter_word(std::string_view unit) {
    return unit == "N" || unit == "N·m" ? "load" : "parameter";
}
inline std::string parameter_reading(std::string_view unit) {
    return "at equal " + parameter_word(unit);
}

// An abscissa that moves less than this [mm] is not used: over the tenths of a millimetre by which a
// longitudinal force lifts the wheel, a camber curve has no meaning.
inline constexpr double min_travel = 1;

// "at equal travel"; without such a channel "at equal abscissa".
inline std::string abscissa_reading(std::string_view channel) {
    return "at equal " + std::string(channel.empty() ? "abscissa" : channel);
}

}  // namespace elastocheck::compare
