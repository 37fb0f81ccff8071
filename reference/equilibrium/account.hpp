// What an equilibrium says of itself: how far it may be off, and what stiffness is left there.
//
// The residual E is evaluated in extended precision, ε = 2⁻⁶⁴, at x; with the factors that are there, of J at x in double
// precision, iterative refinement leads to the equilibrium near:
//
//   ⎡ J  U ⎤ ⎧ dx ⎫ᵏ     ⎧ E(xᵏ) ⎫
//   ⎣ Vᵀ 0 ⎦ ⎩ μ  ⎭   = -⎩   0   ⎭      xᵏ⁺¹ = xᵏ + dxᵏ
//
// Where every dx is at most θ = ¼ of the one before (what J changes on the way and what its factors are off by, together)
// they add up to no more than |dx⁰| / (1 - θ), and there is one equilibrium within that of x (a contraction). Where they
// no longer fall they are rounding: what E is off by is ε |J| c, c = (|r|/L + 1, 1, |R|) the sizes of the unknowns, and
//
//   R_0 = max |J⁻¹ (± ε |J| c)|   over a few choices of the signs
//
//   bound = Σ |dxᵏ| + |dx_last| + 3 R_0     per body: of the origin, of the orientation
//
// Condition times backward error, then, and infinite where they do not fall. Of idle modes nothing is said: dx has no part
// along V.
//
// The stiffness is the least eigenvalue of M (stability.hpp), which the walk follows anyway, over what it was at a = 0.
#pragma once

#include "reference/equilibrium/walk.hpp"

namespace elastocheck::reference::equilibrium {

// Where the walk stands, as `point`.
void give_account(const Walk& walk, Equilibrium& point);

}  // namespace elastocheck::reference::equilibrium
