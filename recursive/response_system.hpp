// The linear system (24) of a state and its solutions: common part of the response to disturbances
// and of the states of neighbouring models.
#pragma once

#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

struct ResponseOrders;  // linear_response.hpp

// Assembles and factorises the matrix of (24) at s.q and the present inputs: with K of (19), or
// with the consistent tangent in its place, for which λ is computed first with K:
//
// ⎡ K    Φ_qᵀ ⎤ ⎧ Δq ⎫   ⎧ f_ext - f_elast ⎫
// ⎣ Φ_q   0   ⎦ ⎩ λ  ⎭ = ⎩        0        ⎭      where Δq = 0 if q is an equilibrium      (24)
//
// Starts with the elimination orders in `orders`, and stores there those that were used.
Outcome factorise_response(SteppingState& s, bool consistent, ResponseOrders& orders);

// Which held directions of the border must carry no load.
enum class CheckedDirections {
    none,
    idle_motions,  // else loaded_idle_mode
    all            // idle motions and redundant rows; for a loaded row inconsistent_constraints
};

// Solves for the right-hand side in s.work.upper, s.work.lower: s.work.x = (dq, dλ), without idle
// motion (minimum norm). Outcomes: not_finite; loaded_idle_mode or inconsistent_constraints where a
// checked direction carries load. `rounding`: of the forces, as size_of_force(), where that is more
// than their last digits.
Outcome solve_response(SteppingState& s, CheckedDirections checked, double rounding = 0);

}  // namespace elastocheck::recursive
