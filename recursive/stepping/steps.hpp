// One increment of the parameter, eqs. (25)-(29), with K or with the consistent tangent.
#pragma once

#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

// One step from (qⁿ, aⁿ) to (qⁿ⁺¹, aⁿ⁺¹), or from tⁿ to tⁿ⁺¹ while settling.
//
// ⎡ K(qⁿ)    Φ_q(qⁿ)ᵀ ⎤ ⎧ Δq ⎫ⁿ   ⎧ f_ext - f_elast - ∂f_elast/∂a Δa ⎫
// ⎣ Φ_q(qⁿ)     0     ⎦ ⎩ λ  ⎭  = ⎩    -∂Φ/∂a Δa   or   -Φ(qⁿ; aⁿ⁺¹)    ⎭      (28), (29)
//
// λ is the total multiplier, so that Φ_qᵀ λⁿ⁻¹ on both sides cancels.
Outcome step(SteppingState& s, const Linear& method, Parameters next);

// The same step with the consistent tangent ∂G/∂q in place of K, and the true forces.
//
// A matrix is valid on its own side of a kink only. Across a kink the step uses the matrix of qⁿ
// alone: with that of the other side (midpoint, or second solve) each step would return to before
// the kink.
Outcome step(SteppingState& s, const Consistent& method, Parameters next);

// Checks the held modes at the end of the last step, as each next step does for the one before it:
// whether they are still idle and not loaded.
inline Outcome check_held_modes(SteppingState& s) {
    if (s.idle.pushing.empty()) return Outcome::converged;
    if (const Outcome outcome = factorise_at(s, s.q, s.lambda); outcome != Outcome::converged)
        return outcome;
    return check_idle_load(s, s.q, s.setup.consistent ? s.step.equilibrium_distance : 0);
}

// Error of the last step, by a correction with its own factors; for other steps the next
// step shows it.
inline Outcome check_last_step(SteppingState& s) {
    if (s.kinks.uncompared > 0) return Outcome::converged;  // the step is not comparable
    residual_at(s, s.q, s.lambda);
    back_substitute(s);
    return disagree(s, size_of_solution(s), s.step.last.squaredNorm(), 0) ? Outcome::diverged
                                                                          : Outcome::converged;
}

}  // namespace elastocheck::recursive
