// Pieces of the force curves in the series method, and where a deformation leaves its piece.
//
// An expansion uses one polynomial of every curve, continued beyond its ends. It is valid until the
// first deformation passes a knot of its piece. The next expansion begins there, on the
// neighbouring piece. The derivation is in derivation.md.
#pragma once

#include <optional>
#include <vector>

#include "recursive/formula/inputs.hpp"
#include "recursive/series/equations.hpp"

namespace elastocheck::recursive::series {

// A curve of the model, and its piece in use.
struct CurvePiece {
    std::size_t elastic = 0;
    int axis = 0;  // of a bushing's e; 0 for a spring
    const Curve* curve = nullptr;
    Piece piece = 0;

    bool is_angle() const { return axis >= 3; }  // whether its deformation is an angle
};

// The curves of the model; find_piece() selects the piece of the deformation in e at τ = 0 (a knot
// belongs to the piece behind it).
std::vector<CurvePiece> curves_of(const Model& model);
void find_piece(const Equations<double>& e, CurvePiece& curve);

// Coefficients of the curve's deformation in the last expansion, up to an order [order + 1].
Eigen::VectorXd deformation_series(const Equations<double>& e, const CurvePiece& curve, int order);

// Sets the piece of the curve in the equations, or in the inputs.
void set_piece(const CurvePiece& curve, Equations<double>& e);
void set_piece(const CurvePiece& curve, Inputs<double>& inputs);

// Distance of the deformation at τ = 0 from the knot behind the piece (+1), or before it (-1), in
// units of the deformation; none if the piece has no knot on that side.
std::optional<double> distance_to_knot(const Equations<double>& e, const CurvePiece& curve,
                                       int direction);

// Changes to the piece behind the present one (+1) or before it (-1). Returns whether the slope
// jumps at the knot in between.
bool cross_knot(CurvePiece& curve, int direction);

// Distances within which a deformation counts as on a knot, as lengths [m] (an angle is multiplied
// by L).
struct KnotTolerance {
    double length = 0;     // L [m]
    double overshoot = 0;  // a deformation this far beyond a knot stays on its piece
    double start = 0;      // of an expansion that starts on a knot, after its correction
};

// First point in 0 ≤ τ ≤ reach at which the deformation leaves the piece.
struct PieceExit {
    double tau = 0;            // position of the knot, to round-off
    int direction = 0;         // the knot behind the piece (+1), or the one before it (-1)
    bool wrong_piece = false;  // whether it starts at that knot and moves out of the piece
};
// `x`: coefficients of the deformation [p + 1], as of deformation_series().
std::optional<PieceExit> exit_from_piece(const Eigen::VectorXd& x, const CurvePiece& curve,
                                         double reach, const KnotTolerance& tolerance);

// Whether the deformation at τ is at the knot in that direction.
bool is_at_knot(const Eigen::VectorXd& x, const CurvePiece& curve, int direction, double tau,
                const KnotTolerance& tolerance);

}  // namespace elastocheck::recursive::series
