// Event location: the parameter at which a deformation reaches a knot of its curve.
//
// The system is smooth as long as every deformation stays on one piece of its curve. Newton's
// method and the checks between two points need that: if a stop closed within a step, Newton's
// method would alternate between open and closed, and the chord between the points would be
// meaningless. So the branch is continued piece by piece. A piece is extrapolated linearly past its
// knots, where its equilibria are not those of the system; the step is then shortened to the knot,
// and the continuation goes on with the next piece.
//
// A deformation is at a knot when it is within `at_knot` of it, relative to L or 1 rad.
#pragma once

#include <optional>

#include "reference/equilibrium/continuation/newton.hpp"

namespace elastocheck::reference::equilibrium {

inline constexpr double at_knot = 1e-10;

// Pieces that contain the deformations at x.
Pieces pieces_at(const System& system, const Loading& loading, const Eigen::VectorXd& x);

// End of its piece at which the deformation leaves it, for continuation in `direction` (±1) over
// `length` of t: -1 or +1, or 0 where it stays.
int exit_side(const CurveDeformation& component, int piece, double direction, double length);

// Share 0 < s ≤ 1 of the step h between two stations after which the first deformation is past its
// piece, by half of `at_knot` so that the exit is detected. Each deformation is interpolated by the
// cubic Hermite polynomial, with error O(h⁴).
std::optional<double> first_exit(const std::vector<CurveDeformation>& from,
                                 const std::vector<CurveDeformation>& to, double h,
                                 const Pieces& pieces);

}  // namespace elastocheck::reference::equilibrium
