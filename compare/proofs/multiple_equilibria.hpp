// Multiple equilibria at one value of a branch parameter: multi-start search with deflation, each
// equilibrium proved by interval arithmetic.
//
// A branch is one curve. Other equilibria may exist at its end and beside it: at snap-through a
// suspension has two stable equilibria at one load and an unstable one between them. The
// equilibrium leg starts from the points of the branch, from both sides of every equilibrium along
// its softest motions, from the mirror image of the branch's displacement, and from random poses.
// Deflation removes the known equilibria from the equations, so that Newton's method converges to
// others. Every listed equilibrium is proved; completeness of the list is not claimed.
//
// The constraints of a joint also hold with an axis or a slide reversed by half a turn. Such
// assemblies are not built: these states are counted and left out. So are states with a body turned
// over, of which rigid bodies on springs have hundreds.
#pragma once

#include <string>
#include <vector>

#include "compare/outputs/curve.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {

struct Result;

struct FindOptions {
    // States with a body that is rotated further from the branch are left out [rad].
    double max_rotation = 1.5707963267948966;
    int random_starts = 24;  // number of random poses
    Progress progress = {};
};

struct FoundEquilibrium {
    Equilibrium state;
    reference::certificate::Certificate proof;
    bool stable = false;  // judged by the sign of the smallest stiffness
    // Smallest stiffness of the motions that are free and resisted, scaled by the equilibrium leg.
    double stiffness = 0;
    bool on_branch = false;  // lies on the branch as it is continued from the design position
    // Largest displacement of any body from the branch's own equilibrium; from the last one before
    // the branch's end; or, if no branch starts, from the design position.
    double length = 0;         // [m]
    double angle = 0;          // [rad]
    std::string body = {};     // body with the largest displacement
    std::string meaning = {};  // what the equilibrium means for the suspension, in words
};

struct AllEquilibria {
    std::string branch;
    Unit unit = Unit::newton;
    double a = 0;                          // SI
    Outcome outcome = Outcome::converged;  // outcome of the equilibrium leg on the branch up to a
    std::string detail = {};
    bool has_start = true;  // the branch has a first point, which is a stable equilibrium
    std::vector<FoundEquilibrium> list = {};  // the branch's own first, then by distance
    // Numbers of equilibria that are not in the list: with a joint assembled in reverse, and with a body that is
    // rotated by more than FindOptions::max_rotation.
    int with_reversed_joint = 0, with_overturned_body = 0;
    int starts = 0;       // number of start poses
    bool proved = false;  // every equilibrium is proved, and every two are proved distinct

    int stable() const;
};

// Searches for the equilibria of a branch at its parameter a [SI]. Thread-safe.
AllEquilibria find_equilibria(const Model& model, const Branch& branch, double a,
                              const FindOptions& options = {});

// Tables "equilibria" and "poses" (of every body in each); passes where the branch reaches the load and
// all of the list is proved.
Result result_of(const Model& model, const AllEquilibria& equilibria);

}  // namespace elastocheck::compare
