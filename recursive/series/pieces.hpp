// The pieces of the curves: which polynomial each curve is followed on, and where its deformation leaves it.
//
// An expansion goes along one polynomial of every curve, as if that went on for ever; it is valid until the first
// deformation meets a knot of its piece and goes on behind it. There the next expansion begins, on the
// neighbouring piece. derivation.md has the rest.
#pragma once

#include <optional>
#include <vector>

#include "recursive/inputs.hpp"
#include "recursive/series/equations.hpp"

namespace elastocheck::recursive::series {

// A curve of the model, and the piece that it is followed on.
struct Followed {
    std::size_t elastic = 0;
    int axis = 0;  // of a bushing's e; 0 for a spring
    const Curve* curve = nullptr;
    Piece piece = 0;

    bool turns() const { return axis >= 3; }  // whether its deformation is an angle
};

// The curves of the model, on the pieces where the deformations of e are at τ = 0 (a knot belongs to the piece
// behind it).
std::vector<Followed> curves_of(const Model& model);
void find_piece(const Equations& e, Followed& curve);

// Has the equations, or all else, follow the curve on its piece.
void follow_on(const Followed& curve, Equations& e);
void follow_on(const Followed& curve, Inputs<double>& inputs);

// Steps to the piece behind the next knot (+1) or before the last (-1). True where the slope jumps at the knot
// between.
bool step_over(Followed& curve, int direction);

// How near to a knot is on it, as a length [m] (an angle counts times L).
struct Near {
    double length = 0;   // L [m]
    double touch = 0;    // a deformation that goes no farther behind a knot stays on its piece
    double arrived = 0;  // what began at a knot may have come to lie so far behind it, corrected
};

// Where in 0 ≤ τ ≤ reach the deformation first leaves the piece.
struct Leaving {
    double tau = 0;        // where it meets the knot, to round-off
    int direction = 0;     // the knot behind the piece (+1), or the one before it (-1)
    bool at_once = false;  // it begins at that knot, and goes the other way: this is not its piece
};
std::optional<Leaving> leaving(const Equations& e, const Followed& curve, double reach, const Near& near);

// Whether at τ the deformation is at the knot in that direction.
bool meets(const Equations& e, const Followed& curve, int direction, double tau, const Near& near);

}  // namespace elastocheck::recursive::series
