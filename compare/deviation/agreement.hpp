// Agreement bounds of the two references: scaled by the acting forces and the size of the model,
// never absolute.
//
// A leg solves its equations to a share of the acting force F: the largest of the loads, the
// reactions and the elastic forces. Rounding of the positions sets a floor: with the largest
// stiffness k [N/m] and the largest coordinate X [m], a position is known to ε X and a stored force
// to ε k X, ε = 2⁻⁵². With L the size of the model [m] (diagonal of the box around its attachment
// points in the design position), a share of Agreement for each quantity, and c = 16 roundings that
// add up in one force, the bounds are
//
//   force    share · F + c ε k X     [N]
//   moment   the force bound times L [N·m]
//   length   share · max(L, 1 m)     [mm]
//   angle    as in Agreement         [deg]
#pragma once

#include <span>
#include <string>

#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// Scale of a branch, from the states of one leg on its model.
Scale scale_of(const Model& model, const Branch& branch, std::span<const Equilibrium> states);

// The larger of two scales of one model, entry by entry; NaN counts as larger than any number.
Scale larger(const Scale& a, const Scale& b);

// The bounds above, for the difference of two states and for the residuals of one state.
Bounds bounds_of(const Agreement& agreement, const Scale& scale);

// "positions to 1e-06 mm, angles to 1e-06 deg, reactions to 0.0003 N and 0.00015 N·m, balances to
// ... "
std::string describe(const Bounds& bounds);

}  // namespace elastocheck::compare
