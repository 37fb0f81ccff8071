// Computer-assisted proof that a computed state is near a true equilibrium of the stored model (Krawczyk's operator over
// intervals of doubles). A leg of its own: it shares models/ with the others and nothing else.
//
// The equations are the model's with its stored doubles taken as exact numbers. What is proved is about these equations:
// not their physics, not the tolerances of what was put in.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::reference::certificate {

// What is claimed before the proof begins: a true equilibrium within this of the state.
struct Tolerance {
    double length = 1e-9;            // of every body's origin [m]
    double angle = 1.7453292520e-8;  // of every body's orientation [rad], 1e-6 deg
    double force = 1e-2;             // of every joint's reaction [N]
    double moment = 1e-2;            // of every joint's reaction [N·m]
    double held = 1e-6;              // what may hold an idle motion, and it still be called idle [N, N·m]
    double gap = 1e-9;               // what redundant constraints may stay open by [m, rad]
};

enum class Answer {
    proved,    // there is one within the tolerance, and no other within `unique`
    excluded,  // there is provably none within the tolerance
    open,      // neither could be shown
};
const char* name(Answer answer);  // "proved", ...

// The largest over all bodies and joints.
struct Extent {
    double length = std::numeric_limits<double>::infinity();  // of a body's origin [m]
    double angle = std::numeric_limits<double>::infinity();   // of a body's orientation [rad]
    double force = std::numeric_limits<double>::infinity();   // of a joint's reaction [N]
    double moment = std::numeric_limits<double>::infinity();  // of a joint's reaction, about its point [N·m]
};

struct Certificate {
    Answer answer = Answer::open;
    std::string
        detail;  // why open; what the theorem says beyond: idle modes held, redundant constraints and their gap
    Extent error;  // an upper bound of the distance from the state to the true equilibrium
    Extent
        unique;  // no other has poses as near as this, whatever its wrenches (∞), of those that have idle motions and the
    // sharing of redundant joints as here; 0 where nothing is known
    double held = 0;  // |μ|: what holds idle modes, at most [N, N·m]; 0 where there are none
    double gap = 0;   // what redundant constraints stay open by, at most [m, rad]; 0 where there are none
    // Every stiffness of what is free and not idle is positive over the whole box; false: not shown.
    bool stable = false;
    Equilibrium centre;  // of the box, as doubles; no poses where there is no box
};

// Of one state, from any leg, at a = state.load of the branch. Throws std::invalid_argument where the state is not of
// the model. Thread-safe.
Certificate certify(const Model& model, const Branch& branch, const Equilibrium& state,
                    const Tolerance& tolerance = {});

// Of the way between states: one connected, locally unique curve of equilibria from the first to the last, which runs
// within a tube around a polynomial through them.
struct Tube {
    Answer answer = Answer::open;
    std::string detail;
    double from = 0, to = 0;  // a, what is covered without a gap
    Extent width;             // of the tube: the curve is within this of the states at their a
    int pieces = 0;
    int corners = 0;  // of these lead over a stop that closes or opens
};
Tube certify_branch(const Model& model, const Branch& branch, std::span<const Equilibrium> states,
                    const Tolerance& tolerance = {});

// Of a limit point near the state: a becomes an unknown.
struct LimitPoint {
    Answer answer = Answer::open;
    std::string detail;
    double from = 0, to = 0;  // the limit value of a lies between
    Extent error;
};
LimitPoint certify_limit_point(const Model& model, const Branch& branch, const Equilibrium& state,
                               const Tolerance& tolerance = {});

}  // namespace elastocheck::reference::certificate
