// What a comparison comes to: the few numbers that a verdict is made of.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "compare/compare.hpp"
#include "compare/study.hpp"

namespace elastocheck::compare {

// An abscissa that moves by less [mm] is none to read over: a longitudinal force lifts the wheel by some tenths of a
// millimetre, and nobody asks what camber does over these.
inline constexpr double least_travel = 1;

enum class ReadingKind { equal_parameter, equal_abscissa };
const Reading& reading_of(const Pair& pair, ReadingKind kind);

// The largest deviation of a main channel in this unit over all branches; one that is no number is the
// largest. Nothing where there is none to compare.
struct Worst {
    std::string branch, channel;
    Unit unit = Unit::mm;
    double max = 0, end = 0, range = 0;
};
// At equal abscissa: of the branches on which it moves by `least_travel` or more.
std::optional<Worst> worst_deviation(const Comparison& comparison, ReadingKind kind, Unit unit);  // recursion
std::optional<Worst> worst_disagreement(const Comparison& comparison, Unit unit);  // references

// The wheel rate, and how far the recursion's is off, at one end of a branch: force over travel from a = 0 to there.
// Only where the branch moves nothing but a vertical load on that wheel, a jack under it, or the road under its tyre,
// and the wheel rises or falls by a millimetre or more: a quotient of less says nothing of a suspension.
struct RateError {
    std::string branch, wheel;
    double to = 0;  // the end, in `unit`
    Unit unit = Unit::newton;
    double off = 0;         // rate of the recursion over that of the reference, less 1: positive is too stiff
    double over = 0;        // travel of the reference from a = 0 to there [mm]
    double travel = 0;      // travel there, recursion less reference [mm]
    double force = 0;       // jack force there, likewise [N]
    double wheel_rate = 0;  // k_w of the reference from a = 0 to there: force over travel [N/mm]
    // With the wheel's tyre in series, k_t: 1 / (1/k_w + 1/k_t) of the reference [N/mm], where the road moves the tyre's
    // force over the height of the road; and how far the recursion's is off. NaN where the wheel has no tyre.
    double ride_rate = std::numeric_limits<double>::quiet_NaN();
    double ride_off = std::numeric_limits<double>::quiet_NaN();
};
std::vector<RateError> rate_errors(const Model& model, const Comparison& comparison);

// How much of the deviation at the end of a branch is the formulation's: of the position that is off most
// there.
enum class GapRole {
    none,        // the gap is below what is known of it
    nearly_all,  // within a tenth
    part,
    hardly_any,  // less than a tenth
    hidden,      // the gap is larger: step errors hide some of it
    opposite,    // the gap points the other way
};
struct GapPart {
    std::string branch, channel;
    double deviation = 0, gap = 0, band = 0;  // [mm], signed; band of the gap
    GapRole role = GapRole::none;
};
std::optional<GapPart> gap_part(const Comparison& comparison, const Study& study, const std::string& method);

}  // namespace elastocheck::compare
