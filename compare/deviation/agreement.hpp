// Agreement bounds of the two references: scaled by the acting forces and the size of the model,
// never absolute.
//
// A leg solves its equations to a share of the acting force F: the largest of the loads, the
// reactions and the elastic forces. Rounding of the positions sets a floor: with the largest
// stiffness k and the largest coordinate X, a position is known to ε X and a stored force to ε k X.
// The bounds are
//
//   force    share · F + c ε k X
//   moment   the force bound times L, the size of the model
//   length   share of L, or of one metre where L is less
#pragma once

#include <span>
#include <string>

#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// Scale of a branch, from the states of one leg on its model.
Scale scale_of(const Model& model, const Branch& branch, std::span<const Equilibrium> states);

// The larger of two scales of one model, entry by entry.
Scale larger(const Scale& a, const Scale& b);

Bounds bounds_of(const Agreement& agreement, const Scale& scale);

// "positions to 1e-06 mm, angles to 1e-06 deg, reactions to 0.0003 N and 0.00015 N·m, balances to
// ... "
std::string describe(const Bounds& bounds);

}  // namespace elastocheck::compare
