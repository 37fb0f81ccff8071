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

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::compare {

struct Agreement {
    double length = 1e-9;  // of L: distance between the positions of the references
    double angle = 1e-6;   // [deg]
    double wrench = 1e-7;  // of F: difference of the reactions
    // of F: residual of one reference's states in the other's balance equations
    double residual_force = 2e-9;
    double residual_length = 1e-11;  // of L: likewise, residual of the constraints
};

struct Scale {
    double force = 0;      // F [N]
    double length = 0;     // L [m], never zero
    double round_off = 0;  // ε k X [N]
};

// Scale of a branch, from the states of one leg on its model.
Scale scale_of(const Model& model, const Branch& branch, std::span<const Equilibrium> states);

// The larger of two scales of one model, entry by entry.
Scale larger(const Scale& a, const Scale& b);

struct Bounds {
    double length = 0;                               // [mm]
    double angle = 0;                                // [deg]
    double force = 0, moment = 0;                    // [N], [N·m]
    double residual_force = 0, residual_moment = 0;  // [N], [N·m]
    double residual_length = 0;                      // [mm]
    Scale scale;
};
Bounds bounds_of(const Agreement& agreement, const Scale& scale);

// "positions to 1e-06 mm, angles to 1e-06 deg, reactions to 0.0003 N and 0.00015 N·m, balances to
// ... "
std::string describe(const Bounds& bounds);

}  // namespace elastocheck::compare
