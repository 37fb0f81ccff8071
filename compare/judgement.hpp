// Pass or fail: whether the recursion is as near to the references as was asked for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/findings.hpp"
#include "compare/trade.hpp"

namespace elastocheck::compare {

inline constexpr Tolerance default_tolerance{0.01, 0.001};

enum class Grade { pass, fail, not_judged };
const char* name(Grade verdict);  // "pass", "fail", "not judged"

struct Assessment {
    Grade verdict = Grade::not_judged;
    std::vector<std::string> reasons;  // why not judged
    std::string method;                // of the recursion
    Tolerance tolerance = default_tolerance;
    bool asked = false;  // the tolerance was given, not the default
    // The largest deviations by reading; nothing where there is nothing to compare.
    std::optional<Worst> position, angle;                // at equal parameter: load, travel of a jack
    std::optional<Worst> position_across, angle_across;  // at equal abscissa: equal travel
    std::optional<RateError> wheel_rate;                 // of those that are off, the one off most
};

// A wheel rate is judged as a position. Rates k (1 + off) and k give, under one force F = k z,
//
//   z' - z = F/(k (1 + off)) - z ≈ -off · z
//
// so that |off · z| [mm] is what the tolerance for positions is about, also where a jack dictates the travel and all
// positions are exact, whatever it takes to hold them.
double as_position(const RateError& rate);

Assessment assess(const Model& model, const Comparison& comparison, const Tolerance& tolerance,
                  bool asked = true);

}  // namespace elastocheck::compare
