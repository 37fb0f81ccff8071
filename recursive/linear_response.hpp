// Linear response (compliance) of a state to small disturbances.
// It uses the matrix that a method factorises at every step.
#pragma once

#include <span>

#include "elastocheck/recursive.hpp"
#include "models/response.hpp"
#include "recursive/diagnosis/analysis.hpp"

namespace elastocheck::recursive {

// Elimination orders of both matrices at one state; null for those of the analysis. Neighbouring
// states have similar matrices, and the search for an order costs more than a factorisation: with
// the orders of one state the next one needs no search.
struct ResponseOrders {
    EliminationOrder with_K, with_tangent;
};

// What the responses of a model at many states share; the orders are those of the last state.
struct ResponseAnalysis {
    Analysis analysis;
    ResponseOrders orders = {};
};

// Response (dr, dπ) of every body to a unit of each disturbance, at the poses and load
// factor of `state`:
//
// ⎡ K    Φ_qᵀ ⎤ ⎧ dq ⎫   ⎧ (f, s × f + m) ⎫        ⎧    0    ⎫
// ⎣ Φ_q   0   ⎦ ⎩ dλ ⎭ = ⎩       0        ⎭   or   ⎩ -∂Φ/∂c  ⎭ ,   c the offset that moves    (24)
//
// with K of (19) for the methods that use it and ignore stored forces: published, closed, balanced.
// Else the consistent tangent ∂G/∂q(q, λ) replaces K (tangent.hpp), with λ from one solve with K
// (response_system.hpp). One factorisation (two with the tangent), one back-substitution per
// disturbance.
//
// Outcomes: singular and not_finite refer to the matrix. loaded_idle_mode: the disturbance loads an
// idle mode. inconsistent_constraints: redundant joints do not allow the offset to move. Throws
// std::invalid_argument where the disturbed object is not in the model, the joint has no offset, or
// the state is of another model; else as solve().
Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances, const Method& method,
                         ResponseAnalysis& analysis);
Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances, const Method& method = {});

}  // namespace elastocheck::recursive
