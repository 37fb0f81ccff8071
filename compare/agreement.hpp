// When two references count as one truth: bounds that follow from what acts on a branch and how large the
// model is, never absolute ones.
//
// A leg solves its equations to a share of the forces that act, F: the largest of the loads, the reactions
// and what the elastic elements store. It cannot do better than the last digit of a position is worth: with
// the largest stiffness k and the largest coordinate X, a position is known to ε X and a stored force to ε k
// X. A force is bounded by
//
//   share · F + c ε k X,          a moment by that times L, the size of the model,
//
// a length by its share of L, but no less than of a metre.
#pragma once

#include <span>
#include <string>

#include "models/equilibrium_path.hpp"
#include "models/model.hpp"

namespace elastocheck::compare {

struct Agreement {
    double length = 1e-9;            // of L: the references' positions apart
    double angle = 1e-6;             // [deg]
    double wrench = 1e-7;            // of F: reactions apart
    double residual_force = 2e-9;    // of F: what each reference's states leave in the other's balances
    double residual_length = 1e-11;  // of L: ... in the other's constraints
};

struct Scale {
    double force = 0;      // F [N]
    double length = 0;     // L [m], never zero
    double round_off = 0;  // ε k X [N]
};

// Of a branch: model and states as a leg has them there.
Scale scale_of(const Model& model, const Branch& branch, std::span<const Equilibrium> states);

// Of all states, from that of some and that of the others of one model.
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

// "positions to 1e-06 mm, angles to 1e-06 deg, reactions to 0.0003 N and 0.00015 N·m, balances to ... "
std::string describe(const Bounds& bounds);

}  // namespace elastocheck::compare
