// Up to where a method is stable that turns stored forces with one step's delay.
//
// With K of (19) on the left, whatever turns with the bodies stands on the right, as it was one step before. Of the forces
// of (28) that follow (method.hpp) let K_G be the tangent that K has not: of the reactions Σ λ_k ∂²Φ_k, of the loads, and
// of the elements' forces as far as their levers or axes follow. Two steps of (28) less each other:
//
// ⎡ K    Φ_qᵀ ⎤ ⎧ Δqⁿ ⎫   ⎧ Δf - K_G Δqⁿ⁻¹ ⎫
// ⎣ Φ_q   0   ⎦ ⎩ δλ  ⎭ = ⎩       0        ⎭      Δqⁿ = T Δf - T K_G Δqⁿ⁻¹,   T = Z (ZᵀKZ)⁻¹ Zᵀ
//
// Where an eigenvalue of T K_G exceeds one, each step reverses the one before and outgrows it: what is turned is stiffer
// than what turns it. K_G grows with the forces, so this is a limit on the load, whatever the number of steps. (An eigenvalue
// below minus one is no fault of the method: there K + K_G itself is negative, and the branch has ended.)
#pragma once

#include <optional>

#include "recursive/solve.hpp"

namespace elastocheck::recursive {

// The largest eigenvalue of T K_G at an equilibrium of the branch; 0 where nothing follows late or nothing is free.
double delayed_stiffness(const Model& model, const Branch& branch, const Method& method,
                         const Analysis& analysis, const Equilibrium& state);

// The first value of the parameter at which it reaches one, along the true branch as far as that goes; none where it
// stays below, or the method has no such delay.
std::optional<double> stability_limit(const Model& model, const Branch& branch, const Method& method,
                                      const Analysis& analysis);

}  // namespace elastocheck::recursive
