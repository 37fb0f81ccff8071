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

// A curve of the model, and the piece in use.
struct Followed {
    std::size_t elastic = 0;
    int axis = 0;  // of a bushing's e; 0 for a spring
    const Curve* curve = nullptr;
    Piece piece = 0;

    bool turns() const { return axis >= 3; }  // whether its deformation is an angle
};

// The curves of the model; find_piece() selects the piece of the deformation in e at τ = 0 (a knot
// belongs to the piece behind it).
std::vector<Followed> curves_of(const Model& model);
void find_piece(const Equations<double>& e, Followed& curve);

// Sets the piece of the curve in the equations, or in the inputs.
void follow_on(const Followed& curve, Equations<double>& e);
void follow_on(const Followed& curve, Inputs<double>& inputs);

// Distance of the deformation at τ = 0 from the knot behind the piece (+1), or before it (-1), in
// units of the deformation; none if the piece has no knot on that side.
std::optional<double> to_knot(const Equations<double>& e, const Followed& curve, int direction);

// Changes to the piece behind the next knot (+1) or before the last one (-1). Returns whether the
// slope jumps at that knot.
bool step_over(Followed& curve, int direction);

// Distances within which a deformation counts as on a knot, as lengths [m] (an angle is multiplied
// by L).
struct Near {
    double length = 0;  // L [m]
    // tolerance of the expansion: up to this far beyond a knot a deformation stays
    double touch = 0;
    double arrived = 0;  // tolerance of a start on a knot, after its correction
};

// First point in 0 ≤ τ ≤ reach at which the deformation leaves the piece.
struct Leaving {
    double tau = 0;        // position of the knot, to round-off
    int direction = 0;     // the knot behind the piece (+1), or the one before it (-1)
    bool at_once = false;  // it starts at that knot and moves out of the piece: wrong piece
};
std::optional<Leaving> leaving(const Equations<double>& e, const Followed& curve, double reach,
                               const Near& near);
// The same of a deformation with the coefficients x [p + 1].
std::optional<Leaving> leaving(const Eigen::VectorXd& x, const Followed& curve, double reach,
                               const Near& near);

// Whether the deformation at τ is at the knot in that direction.
bool meets(const Eigen::VectorXd& x, const Followed& curve, int direction, double tau,
           const Near& near);
bool meets(const Equations<double>& e, const Followed& curve, int direction, double tau,
           const Near& near);

}  // namespace elastocheck::recursive::series
