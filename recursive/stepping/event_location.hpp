// Event location at the knots of force curves: steps that end on a knot.
//
// A step uses one polynomial piece of every curve and continues it beyond its ends if needed
// (law.hpp), so the equations of the step are smooth and its error estimate is valid. Where a
// deflection x(p) reaches the end of its piece within the step, the step is shortened to end there:
//
//   location   x is interpolated by a cubic through four points of the step, first of the
//              predictor, then of the accepted step; its first root is the start of
//   iteration  p ← p + (knot - x) / x', with the node corrected along z', until x equals the knot
//              to a millionth of the tolerance
//
// The next step uses the adjacent piece and the derivative of the path on that side.
#pragma once

#include "recursive/stepping/continuation.hpp"

namespace elastocheck::recursive {

// Cubic Hermite interpolation at the fraction t between two nodes, rotations as vectors π:
// π(0) = 0, π'(0) = ω, π(h) = log(A⁺Aᵀ), π'(h) = J(π)⁻¹ ω⁺.
void interpolate(const Node& from, const Node& to, double t, State<double>& q,
                 Vector<double>& lambda);

inline Piece& piece_of(SteppingState& s, const CurvePlace& at) {
    return s.inputs.rest[at.element].piece[at.axis];
}

// First knot reached between two nodes: its curve, the end of the piece, and the fraction
// of the step.
struct KnotCrossing {
    const CurvePlace* curve = nullptr;  // nullptr: no knot is reached
    int side = 0;                       // -1 at the lower end of the piece, +1 at the upper
    double t = 2;
    double knot = 0;
};

// A step of continuation.hpp from `node` to `next`; z'' of its predictor, and workspace.
struct Stride {
    Node node, next;
    Vector<double> curvature, lambda_curvature;  // z'' at the node
    State<double> q;
    Vector<double> lambda;
};

// The step from the node to next.p on the present pieces, shortened to the first knot reached,
// which `met` returns.
Trial step_to_knot(SteppingState& s, const ContinuationSettings& settings, Stride& stride,
                   KnotCrossing& met);

// Selects for every curve the piece that the path follows from the node on: the piece of its
// deflection or, on a knot, the piece a little ahead.
void take_pieces(SteppingState& s, const ContinuationSettings& settings, const Node& node,
                 double ahead, State<double>& q);

}  // namespace elastocheck::recursive
