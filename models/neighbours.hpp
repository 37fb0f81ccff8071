// States of neighbouring models: how every leg takes part in derivatives by
// differences (compare/sensitivity/sensitivity.hpp).
//
// A model m(t) changes with a number p + t of its scene; m(0) has the state x. With the leg's own
// residual G at the fixed x, a stencil t_k with weights w_k, and the leg's own J at (m(0), x),
//
//   dx/dp = -J⁻¹ Σ w_k (G(m(t_k), x) - G(m(0), x))
//
// decides whether there is a derivative. The states of the neighbours are those of the chord method,
//
//   x_k ← x_k - J⁻¹ (G(m(t_k), x_k) - G(m(0), x))   from x_k = x,
//
// which gains one to three digits a step. Terms that the number does not change cancel to the last digit.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"

namespace elastocheck {

// `model`: on one side of one branch, which is its only one; with the structure of m(0).
struct Neighbour {
    const Model* model = nullptr;
    double t = 0, weight = 0;
};
using Neighbours = std::vector<Neighbour>;  // the stencil of one number

// One state per neighbour, with its reactions. Empty unless converged. Outcomes:
// inconsistent_constraints where redundant joints close only at this value of the number,
// loaded_idle_mode where the number loads a motion that nothing resists, singular at a limit point,
// not_finite. Idle modes are held.
struct NeighbourStates {
    Outcome outcome = Outcome::converged;
    std::string detail;
    std::vector<Equilibrium> states;
    bool settled = true;  // every chord method has met (of the equilibrium leg)
};

// Its largest number of steps, and the change of motion and reactions in the last but one as a share of
// that in the first. Reactions follow the motion by one step, and may need more where the first one meets
// the motion: a joint driven to half a turn.
inline constexpr int chord_steps = 10;
inline constexpr double chord_met = 1e-9;
inline constexpr double chord_reactions = 1e-11;  // of a change, in shares of the reactions
inline constexpr double chord_rounding = 1e-14;   // of a motion, in shares of the model's size

// Σ |w|: the rounding of G is amplified by it.
inline double amplification(const Neighbours& stencil) {
    double sum = 0;
    for (const Neighbour& k : stencil) sum += std::abs(k.weight);
    return sum;
}

}  // namespace elastocheck
