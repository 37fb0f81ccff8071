// Where a branch comes to a knot of a curve.
//
// On a piece of every curve the system is smooth, and smooth is what Newton's method and the checks between two
// points are made for: a stop that closes within a step would let Newton's method swing between open and closed,
// and the chord between the points say nothing. So the branch is walked piece by piece. A piece goes on
// past its knots, straight, where an equilibrium of it is none of the system; the step is then shortened to the
// knot, and from there the walk goes on with the next piece.
//
// A deformation is at a knot when it is within `at_knot` of it, over L or over 1 rad.
#pragma once

#include <optional>

#include "reference/equilibrium/newton.hpp"

namespace elastocheck::reference::equilibrium {

inline constexpr double at_knot = 1e-10;

// The pieces that all deformations lie on.
Pieces pieces_at(const System& system, const Loading& loading, const Eigen::VectorXd& x);

// The side on which the deformation is at the end of its piece and leaves it, walking in `direction` (±1) over
// `length` of t: -1 or +1, or 0 where it does not.
int leaves(const OnCurve& at, int piece, double direction, double length);

// The part of the way between two stations h apart, 0 < s ≤ 1, after which the first deformation is past its piece:
// half of `at_knot` past, to be seen to leave. Each is the cubic through both ends with its rates there, which is
// h⁴ from the truth.
std::optional<double> first_exit(const std::vector<OnCurve>& from, const std::vector<OnCurve>& to, double h,
                                 const Pieces& pieces);

}  // namespace elastocheck::reference::equilibrium
