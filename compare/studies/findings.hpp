// Key figures of a comparison, from which the verdict is made.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "compare/outputs/readings.hpp"
#include "compare/studies/study.hpp"
#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

const Reading& reading_of(const Pair& pair, ReadingKind kind);

// Whether outputs are compared at equal abscissa on a branch: a wheel's travel must change by at
// least `min_travel`; a main output is always accepted.
bool is_readable(const Comparison& comparison, const BranchComparison& branch);
// The worst distance of the second reference from the equilibrium leg among the main outputs of this
// unit, at equal parameter; none if there are no such outputs.
std::optional<Worst> worst_disagreement(const Comparison& comparison, Unit unit);

// Wheel rate (force over travel from a = 0) at one end of a branch, and its error in the
// recursion. Only for branches that move nothing but a vertical load on that wheel, a jack
// under it, or the road under its tyre, with a wheel travel of a millimetre or more: the
// quotient is meaningless below.
struct RateError {
    std::string branch, wheel;
    double to = 0;  // end of the branch, in `unit`
    Unit unit = Unit::newton;
    // rate of the recursion over that of the reference, minus 1: positive is too stiff
    double off = 0;
    double over = 0;        // travel of the reference from a = 0 to the end [mm]
    double travel = 0;      // travel at the end, recursion minus reference [mm]
    double force = 0;       // jack force at the end, recursion minus reference [N]
    double wheel_rate = 0;  // k_w of the reference from a = 0 to the end: force over travel [N/mm]
    // Ride rate with the tyre rate k_t in series, 1 / (1/k_w + 1/k_t), of the reference [N/mm],
    // where the road moves: tyre force over road height; and the error of the recursion. NaN for a
    // wheel without a tyre.
    double ride_rate = std::numeric_limits<double>::quiet_NaN();
    double ride_off = std::numeric_limits<double>::quiet_NaN();
};
std::vector<RateError> rate_errors(const Model& model, const Comparison& comparison);

}  // namespace elastocheck::compare
