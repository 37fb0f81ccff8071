// Equilibria of models that differ from a solved one in a single number of the scene: each leg's
// contribution to derivatives by finite differences (compare/sensitivity/sensitivity.hpp).
//
// m(t) is the model with the number p + t, x the equilibrium of m(0), G the leg's residual and
// J = ∂G/∂x at (m(0), x). With the points t_k and weights w_k of a difference formula,
//
//   dx/dp = -J⁻¹ Σ w_k (G(m(t_k), x) - G(m(0), x)).
//
// There is no derivative where this system has no finite solution. The equilibria x_k of the
// neighbours m(t_k) follow by the chord method (Newton's method with a constant J),
//
//   x_k ← x_k - J⁻¹ (G(m(t_k), x_k) - G(m(0), x)),   x_k = x at first,
//
// which gains one to three digits a step. Subtracting G(m(0), x) cancels all terms that p does not
// change.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"

namespace elastocheck {

struct Neighbour {
    const Model* model = nullptr;  // m(t): one side of one branch; the structure of m(0)
    double t = 0, weight = 0;      // t_k, w_k
};
using Neighbours = std::vector<Neighbour>;  // the difference formula for one number

// One state per neighbour, with its reactions; no states unless converged. Outcomes: inconsistent_constraints
// where redundant joints close only at this value of the number, loaded_idle_mode where the number loads a
// motion that nothing resists, singular at a limit point, not_finite. Idle modes are held.
struct NeighbourStates {
    Outcome outcome = Outcome::converged;
    std::string detail;
    std::vector<Equilibrium> states;
    // the chord method converged for every neighbour; judged by the equilibrium leg only
    bool settled = true;
};

// Convergence of the chord method. A step has converged where its changes of motion and of reactions
// are below chord_met times those of the first step (the reactions also below chord_reactions times
// their size). One more step follows, since the reactions lag the motion by one step.
inline constexpr int chord_steps = 10;  // at most
inline constexpr double chord_met = 1e-9;
inline constexpr double chord_reactions = 1e-11;
inline constexpr double chord_rounding = 1e-14;  // a motion that is round-off, of the model's size

// Σ |w_k|, by which the difference formula amplifies the rounding of G.
inline double amplification(const Neighbours& stencil) {
    double sum = 0;
    for (const Neighbour& k : stencil) sum += std::abs(k.weight);
    return sum;
}

}  // namespace elastocheck
