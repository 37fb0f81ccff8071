// How a state answers small disturbances: one more use of the matrix that a method factorises at every step.
#pragma once

#include <span>

#include "models/response.hpp"
#include "recursive/solve.hpp"

namespace elastocheck::recursive {

// (dr, dπ) of every body for a unit of each disturbance, at the poses and the load factor of `state`:
//
// ⎡ K    Φ_qᵀ ⎤ ⎧ dq ⎫   ⎧ (f, s × f + m) ⎫        ⎧    0    ⎫
// ⎣ Φ_q   0   ⎦ ⎩ dλ ⎭ = ⎩       0        ⎭   or   ⎩ -∂Φ/∂c  ⎭ ,   c the offset that is moved      (24)
//
// with K of (19) where the method has it, which knows nothing of the forces already stored: published, closed,
// balanced. Else with the consistent tangent ∂G/∂q(q, λ) in its place (tangent.hpp), λ from one solve with K first:
//
// ⎡ K    Φ_qᵀ ⎤ ⎧ Δq ⎫   ⎧ f_ext - f_elast ⎫
// ⎣ Φ_q   0   ⎦ ⎩ λ  ⎭ = ⎩        0        ⎭      whose Δq is zero where q is an equilibrium      (24)
//
// One factorisation (two with the tangent), one back-substitution a disturbance; in double precision.
//
// singular, not_finite: the matrix. loaded_idle_mode: what holds an idle mode would have to answer the disturbance.
// inconsistent_constraints: redundant joints do not let the offset move. std::invalid_argument: what is disturbed is not of
// the model, the joint has no offset, the state is of another model; or as solve() throws it.
Response respond(const Model& model, const Branch& branch, const Equilibrium& state,
                 std::span<const Disturbance> disturbances, const Method& method, const Analysis& analysis);
Response respond(const Model& model, const Branch& branch, const Equilibrium& state,
                 std::span<const Disturbance> disturbances, const Method& method = {});

}  // namespace elastocheck::recursive
