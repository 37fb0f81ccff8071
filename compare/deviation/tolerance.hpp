// Tolerances of outputs: the limits of their deviations.
#pragma once

#include <string_view>
#include <vector>

#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// Parses "0.01mm,0.001deg,1%": a length, an angle and a share, or some of these, in any order; with
// `with_forces` also a force (N) and a moment (Nm). A share that is not given is default_share;
// `motion` accepts lengths and angles only, and leaves the share infinite. Throws
// std::invalid_argument with the allowed forms.
enum class ToleranceParts { motion, with_shares, with_forces };
Tolerance parse_tolerance(std::string_view text, ToleranceParts allowed = ToleranceParts::motion);

// Whether the output is a position or an angle of the configuration: its limit is a length
// or an angle.
bool is_motion(const Channel& channel);

// Extent of every output along a branch, in its unit: the reference of Tolerance::share. With F the
// largest acting force, L the size, ε k X the rounding of the stiffest element (agreement.hpp):
//
//   largest minus smallest value of `truth`; at least a tenth of the largest |value|, for outputs
//   that hardly change; for a rate at least the largest |value|
//   for a component of a wrench, the extent of the component with the largest one
//   at least F / 1000 + 1600 ε k X for a force, L times that for a moment, 0.001 otherwise
std::vector<double> extents_of(const std::vector<Channel>& channels, const Curve& truth,
                               const Scale& scale);

// Limit of the deviation of the output, in its unit.
double limit_of(const Channel& channel, double extent, const Tolerance& tolerance);

}  // namespace elastocheck::compare
