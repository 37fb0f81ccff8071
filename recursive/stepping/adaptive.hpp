// Step-size control by an error estimate, and dense output between the steps.
//
//   a step    continuation.hpp
//   between   the cubic through (z, z') and (z⁺, z⁺'). Its error is largest at the midpoint, where
//             the size of one Newton correction estimates it.
//
// A step is accepted when continuation.hpp accepts it and the midpoint error is within the
// tolerance. The next step size follows from the midpoint error, which is of order 4.
//
// An equilibrium that becomes unstable and stable again between two nodes leaves the sign of the
// determinant unchanged. It shows as a dip of the determinant: where the determinant at the
// midpoint has another sign, or is less than half of that at either end, the step is halved
// until the dip disappears or the point is located. Two modes that become unstable at once also
// leave the sign unchanged; they show in the least stiffness at every node (stiffness.hpp). A
// branch that begins unstable is not followed (stability.hpp). After `max_steps` steps the
// outcome is iteration_limit.
//
// No step crosses a knot of a force curve: the step ends on the knot (event_location.hpp) and the
// next one begins with the derivative on the other side. Where the determinant changes its sign
// with the piece, the path turns back at the knot.
#pragma once

#include "elastocheck/recursive.hpp"
#include "recursive/stepping/recording.hpp"

namespace elastocheck::recursive {

// Maximum number of steps, accepted or rejected: near a singular point each may be a ten-millionth
// of the branch.
inline constexpr int max_steps = 20'000;

// Follows the branch and records `points` equal increments of the parameter (options.record, or
// steps), as sweep() does. In double precision.
EquilibriumPath sweep_adaptive(const Model& model, const Branch& branch, const Options& options,
                               const Analysis& analysis, const PointVisitor& visit, Stop& stop);

}  // namespace elastocheck::recursive
