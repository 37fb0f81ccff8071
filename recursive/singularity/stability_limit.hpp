// Stability limit of the methods that rotate stored forces with a delay of one step.
//
// With K of (19) on the left, the forces that rotate with the bodies are on the right-hand side, as
// they were one step before. Let K_G be the part of the tangent of these forces of (28)
// (recursive_method.hpp) that K lacks: of the reactions Σ λ_k ∂²Φ_k, of the loads, and of the
// element forces as far as their levers or axes follow the bodies. The difference of two steps of
// (28) is
//
// ⎡ K    Φ_qᵀ ⎤ ⎧ Δqⁿ ⎫   ⎧ Δf - K_G Δqⁿ⁻¹ ⎫
// ⎣ Φ_q   0   ⎦ ⎩ δλ  ⎭ = ⎩       0        ⎭      Δqⁿ = T Δf - T K_G Δqⁿ⁻¹,   T = Z (ZᵀKZ)⁻¹ Zᵀ
//
// Where an eigenvalue of T K_G exceeds one, each step reverses the step before and grows: the
// geometric stiffness exceeds the elastic stiffness. K_G grows with the forces, so this limits the
// load whatever the number of steps. (An eigenvalue below minus one is no instability of the
// method: there K + K_G itself is negative, and the branch has ended.)
#pragma once

#include <optional>

#include "elastocheck/recursive.hpp"

namespace elastocheck::recursive {

// Largest eigenvalue of T K_G at an equilibrium of the branch; 0 where no force is delayed or no
// motion is free.
double delayed_stiffness(const Model& model, const Branch& branch, const Method& method,
                         const Analysis& analysis, const Equilibrium& state);

// First parameter value at which that eigenvalue reaches one, along the true branch as far as it
// goes; none where it stays below one or the method has no delay.
std::optional<double> stability_limit(const Model& model, const Branch& branch,
                                      const Method& method, const Analysis& analysis);

}  // namespace elastocheck::recursive
