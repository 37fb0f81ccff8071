// Computer-assisted proof that a computed state is near a true equilibrium of the stored model,
// by Krawczyk's interval operator (Krawczyk 1969). A leg of its own: it shares only models/
// with the others.
//
// The equations are those of the model, with its stored doubles taken as exact numbers. The proof
// is about these equations; it covers neither their physics nor the tolerances of the input.
#pragma once

#include <limits>
#include <span>
#include <string>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::reference::certificate {

// Up to max_unknowns_of_curves (7 per body, 1 per row of a joint) dense matrices are kept, and the
// time of a proof grows with the cube of the unknowns. Beyond it a point is proved row by row, with
// the square.
inline constexpr int max_unknowns_of_curves = 500, max_unknowns_of_points = 40000;

// Accuracy that is to be proved, fixed before the proof: a true equilibrium within these distances
// of the state.
struct Tolerance {
    double length = 1e-9;            // of every body's origin [m]
    double angle = 1.7453292520e-8;  // of every body's orientation [rad], 1e-6 deg
    double force = 1e-2;             // of every joint's reaction [N]
    double moment = 1e-2;            // of every joint's reaction [N·m]
    double held = 1e-6;              // largest wrench that may hold an idle motion [N, N·m]
    double gap = 1e-9;               // largest remaining gap of redundant constraints [m, rad]
    int max_unknowns = max_unknowns_of_curves;  // a point of a larger system is not tried
};

// State of a proof, for a point z_s, in the letters of krawczyk.hpp: F the bordered equations, Y an
// approximate inverse of their Jacobian, [y] = ỹ ± r a box, δ the tolerance.
enum class ProofState {
    // |Y F(ỹ)| + |I - Y F'([y])| r < r, so one equilibrium is in [y]; and |z - z_s| ≤ δ for all z
    // of [y], with |μ| at most `held` and `gap`
    proved,
    // |y E(z_s)| > |y E'([z])| δ + |y| |ε| for some row y, so no equilibrium has |z - z_s| ≤ δ
    excluded,
    // neither inequality could be shown
    open,
};
const char* name(ProofState state);  // "proved", ...

// The largest over all bodies and joints.
struct Extent {
    double length = std::numeric_limits<double>::infinity();  // of a body's origin [m]
    double angle = std::numeric_limits<double>::infinity();   // of a body's orientation [rad]
    double force = std::numeric_limits<double>::infinity();   // of a joint's reaction [N]
    // of a joint's reaction, about its point [N·m]
    double moment = std::numeric_limits<double>::infinity();
};

struct Certificate {
    ProofState state = ProofState::open;
    // reason for `open`; additional statements of the theorem: held idle modes, redundant
    // constraints and their gap
    std::string detail;
    Extent error;  // an upper bound of the distance from the state to the true equilibrium
    // no other equilibrium has poses this near, with any wrenches (∞), among those with the same
    // idle motions and load sharing of redundant joints; 0 if unknown
    Extent unique;
    double held = 0;  // upper bound of |μ| that holds idle modes [N, N·m]; 0 without any
    double gap = 0;   // upper bound of the gap of redundant constraints [m, rad]; 0 without any
    // Every stiffness of free motions that are not idle is positive over the whole box;
    // false: not proved.
    bool stable = false;
    Equilibrium centre;  // of the box, as doubles; without poses if there is no box
};

// Certifies one state from any leg at a = state.load of the branch. Throws std::invalid_argument
// for a state that does not fit the model. Thread-safe.
Certificate certify(const Model& model, const Branch& branch, const Equilibrium& state,
                    const Tolerance& tolerance = {});

// Certifies the path between states: one connected, locally unique curve of equilibria from the
// first state to the last, within a tube around an interpolating polynomial. `proved` if the
// inequality of a point holds over every piece with a as a coefficient, and neighbouring pieces
// share their zero; else `open`. Up to max_unknowns_of_curves.
struct Tube {
    ProofState state = ProofState::open;
    std::string detail;
    // false: the system is too large, or the arithmetic does not round as assumed
    bool tried = true;
    double from = 0, to = 0;  // range of a covered without a gap
    Extent width;  // of the tube: largest distance of the curve from the states at their a
    int pieces = 0;
    int knots = 0;  // number of pieces across a knot of a curve
};
Tube certify_branch(const Model& model, const Branch& branch, std::span<const Equilibrium> states,
                    const Tolerance& tolerance = {});

// Certifies a limit point near the state, with a as an unknown. `proved` if the box contracts for
// every σ in [-δ, δ] along the tangent and da/dσ has opposite signs at its ends; else `open`. Up to
// max_unknowns_of_curves.
struct LimitPoint {
    ProofState state = ProofState::open;
    std::string detail;
    double from = 0, to = 0;  // bounds of the limit value of a
    Extent error;
};
LimitPoint certify_limit_point(const Model& model, const Branch& branch, const Equilibrium& state,
                               const Tolerance& tolerance = {});

}  // namespace elastocheck::reference::certificate
