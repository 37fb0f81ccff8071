// A-posteriori error bound and remaining stiffness of an equilibrium.
//
// The residual E is evaluated in extended precision, ε = 2⁻⁶⁴, at x. Iterative refinement with the
// existing factors of J at x, in double precision, leads to the nearby equilibrium:
//
//   ⎡ J  U ⎤ ⎧ dx ⎫ᵏ     ⎧ E(xᵏ) ⎫
//   ⎣ Vᵀ 0 ⎦ ⎩ μ  ⎭   = -⎩   0   ⎭      xᵏ⁺¹ = xᵏ + dxᵏ
//
// Where every dx is at most θ = ¼ of the one before (the change of J on the way and the error of
// its factors, together), the sum of all dx is at most |dx⁰| / (1 - θ), and there is one
// equilibrium within that distance of x (contraction). Where the dx no longer decrease they are
// rounding: the error of E is ε |J| c, with c = (|r|/L + 1, 1, |R|) the sizes of the unknowns, and
//
//   R_0 = max |J⁻¹ (± ε |J| c)|   over a few choices of the signs
//
//   bound = Σ |dxᵏ| + |dx_last| + 3 R_0     per body: of the origin, of the orientation
//
// The bound is condition times backward error, and infinite where the dx do not decrease. It does
// not cover idle modes: dx has no part along V.
//
// The remaining stiffness is the least eigenvalue of M (stability.hpp), which the continuation
// follows anyway, over its value at a = 0.
#pragma once

#include "reference/equilibrium/continuation/continuation.hpp"

namespace elastocheck::reference::equilibrium {

// Writes bound and stiffness of the current station of the continuation to `point`.
void add_error_bound(const Continuation& continuation, Equilibrium& point);

}  // namespace elastocheck::reference::equilibrium
