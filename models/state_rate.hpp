// Derivatives by a number of the scene: of a state (sensitivity), and of its linear response.
// Results of every leg.
#pragma once

#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "models/response.hpp"

namespace elastocheck {

// d(state)/dp at a constant parameter a of the branch, p one number. The number is given as a rate:
// a Model of the same shape whose real numbers are the derivatives dm/dp of those of the model
// (model_rates.hpp), on the same side of the same branch, which is its only one.
//
// The balance and the constraints of a leg, R(q, λ; a, m) = 0, determine it:
//
//   J d(q, λ)/dp = -∂R/∂m dm/dp,   J = ∂R/∂(q, λ)
//
// Empty unless converged. Outcomes: inconsistent_constraints where redundant joints close only at
// this value of the number, loaded_idle_mode where the number loads a motion that nothing resists,
// singular at a limit point, not_finite. Idle modes are held, as in a Response. The reactions of
// joints that share a load in an undetermined way have no derivative; what is returned for them
// depends on the leg.
struct StateRate {
    Outcome outcome = Outcome::converged;
    std::string detail;                 // reason of the failure; empty when converged
    std::vector<Increment> increments;  // per Model::bodies: (dr, dπ)/dp, [m] and [rad] per unit
    std::vector<Wrench> reactions;      // per Model::joints: derivative of Equilibrium::reactions
};

// d/dp of the increments of a Response, the derivative of the tangent at the state: with x_t the
// response to a disturbance t, J x_t = -∂R/∂t,
//
//   J dx_t/dp = -d/dp (J x_t + ∂R/∂t) at a constant x_t
//
// where d/dp changes the model by its rate and the state by its StateRate. The disturbances stay: a
// wrench at its point of the body, the offset of a joint. Outcomes as those of a StateRate. A part of
// a motion that is idle has no derivative; what is returned for it depends on the leg.
struct ResponseRate {
    Outcome outcome = Outcome::converged;
    std::string detail;
    std::vector<std::vector<Increment>> increments;  // per disturbance and body, [m, rad] per unit
};
struct ResponseRates {
    Response at;
    std::vector<ResponseRate> by;  // per rate; empty unless `at` has converged
};

}  // namespace elastocheck
