// All equilibria that can be found at one value of a branch's parameter: each proved, and what it means for the branch.
//
// A branch is one curve. At its end, and beside it, there may be others: a suspension that snaps over has two stable
// equilibria at one load, and an unstable one between them. They are looked for by the equilibrium leg, from the points of
// the branch, from both sides of every equilibrium along its softest motions, from the mirror image of how far the branch
// has moved, and from poses at random; what is known is taken out of the equations (deflation), so that Newton's method
// comes to others. What is found is there, by proof; that there is no other is not said.
//
// The constraints that a joint is made of also hold with an axis or a slide turned round by half a turn. Nobody puts it
// together that way: such states are counted and left out. So are those with a body turned over, of which rigid bodies on
// springs have hundreds.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/curve.hpp"
#include "models/equilibrium_path.hpp"
#include "models/model.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {

struct FindOptions {
    double turn = 1.5707963267948966;  // [rad] a body turned further than this is no suspension any more
    int at_random = 24;                // poses at random
    int motions = 3;                   // softest ones of every equilibrium
    unsigned long seed = 1;            // of the poses at random
    std::function<void(std::string_view)> progress = {};
};

struct FoundEquilibrium {
    Equilibrium state;
    reference::certificate::Certificate proof;
    bool stable = false;     // by the sign of its least stiffness
    double stiffness = 0;    // the least of what is free and resisted, scaled by the leg
    bool on_branch = false;  // as it is walked from the design position
    // From the branch's own equilibrium, or from the last before its end, or, where none begins, from the drawing: the
    // place that is farthest.
    double length = 0;      // [m]
    double angle = 0;       // [rad]
    std::string body = {};  // that moves so far
    std::string meaning = {};
};

struct AllEquilibria {
    std::string branch;
    Unit unit = Unit::newton;
    double a = 0;                          // SI
    Outcome outcome = Outcome::converged;  // of the branch on its way to a, by the equilibrium leg
    std::string detail = {};
    bool begins = true;                       // the branch: its first point is a stable equilibrium
    std::vector<FoundEquilibrium> list = {};  // that of the branch first, then the nearest
    int other_way_round = 0;  // equilibria with a joint put together the other way round: not in the list
    int turned_over = 0;      // ... with a body turned by more than FindOptions::turn: neither
    int starts = 0;           // poses that were started from
    bool proved = false;      // every one, and every two to be two

    int stable() const;
};

// Thread-safe.
AllEquilibria find_all(const Model& model, const Branch& branch, double a, const FindOptions& options = {});

}  // namespace elastocheck::compare
