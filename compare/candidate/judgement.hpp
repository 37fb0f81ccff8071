// Pass or fail: whether the recursion meets the tolerance in every compared output.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/studies/findings.hpp"

namespace elastocheck::compare {

struct Assessment {
    Grade verdict = Grade::not_judged;
    std::vector<std::string> reasons;  // reasons for not_judged
    std::string method;                // of the recursion
    Tolerance tolerance = default_tolerance;
    bool tolerance_given = false;  // the tolerance was given, not the default
    // The user requests a verdict, by a method or a tolerance; else only deviations are reported.
    bool requested = true;
    // Largest deviations; empty where nothing is compared. They are taken from the main outputs,
    // unless these are within their limits and another position or angle takes a larger share of
    // its own limit.
    std::optional<Worst> position, angle;  // at equal parameter (load, jack travel)
    // at equal abscissa: equal travel
    std::optional<Worst> position_at_abscissa, angle_at_abscissa;
    // Deviation of an output that is neither position nor angle (forces, moments, drive forces,
    // rates) with the largest share of its limit, or of its extent where it has no limit. A rate
    // that may be undefined is taken only where all others are within their limits. At equal
    // abscissa the uncertainty of the interpolation is subtracted.
    std::optional<Worst> other, other_at_abscissa;
    std::optional<RateError> wheel_rate;  // the one with the largest relative error
    bool exact = false;                   // every deviation is within rounding
    int outputs = 0;                      // number of judged outputs ...
    int others = 0;                       // ... of which are neither positions nor angles
};

// A wheel-rate error is judged as a position error. Rates k (1 + off) and k give, under one force
// F = k z,
//
//   z' - z = F/(k (1 + off)) - z ≈ -off · z
//
// so |off · z| [mm] is compared with the tolerance for positions. This also covers a jack, which
// fixes the travel so that all positions are exact whatever the error of the jack force.
double as_position(const RateError& rate);

// Judges every determined output of every branch, at equal parameter and, where possible, at equal
// abscissa, against limit_of(its extent on the branch), and every wheel rate as a position.
Assessment assess(const Model& model, const Comparison& comparison, const Tolerance& tolerance,
                  bool tolerance_given = true);

}  // namespace elastocheck::compare
