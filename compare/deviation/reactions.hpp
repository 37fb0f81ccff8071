// Error bound of joint reactions, derived from the tolerance of positions, and its check.
#pragma once

#include <span>
#include <string>

#include "compare/deviation/agreement.hpp"
#include "elastocheck/equilibrium_path.hpp"

namespace elastocheck::compare {

struct ReactionBound {
    double force = 0;   // [N]
    double moment = 0;  // [N·m]
};

// Error bound of the reactions of a solver with the position tolerance `length` [m]. With F the
// largest acting force, L the size, ε k X the rounding of the stiffest element (agreement.hpp):
//
//   force    max(1e-6, 1000 length / L) F + 1000 ε k X          moment    L times that
ReactionBound bound_of_reactions(double length, const Scale& acts);

// Message on the reaction that exceeds the bound most; empty where none does. A value that is not
// finite exceeds any bound. `joints` and `found` have one entry per joint; so has `known`, or it is
// empty where no reaction is known: then nothing exceeds.
std::string reaction_off(std::span<const std::string> joints, std::span<const Wrench> found,
                         std::span<const Wrench> known, const ReactionBound& bound,
                         const Scale& acts);

}  // namespace elastocheck::compare
