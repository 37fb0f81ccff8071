// What an equilibrium says of itself: how far it may be off, and what stiffness is left there.
//
// Newton's method on the conditions of the minimum, with the second derivatives and multipliers of each place (`correction`,
// branch.hpp): ξᵏ⁺¹ = ξᵏ + dξᵏ. Where every dξ is at most θ = ¼ of the one before they lead to one minimum, which is within
//
//   Σ |dξᵏ| + |dξ_last| + 3 R     R = max |correction of (± e, ± e_Φ)|   over a few choices of the signs
//
// of ξ. R is what rounding makes of the last of them: the gradient and the constraints are off by
//
//   e = 4 ε (|H| c + |Jᵀ| |λ|),   e_Φ = 4 ε |J| c     c = (|r|/L + 1, 1), the sizes of the coordinates
//
// in the arithmetic of the leg, ε = 2⁻⁵². Condition times backward error, then; infinite where the corrections do not fall.
// Of idle motions nothing is said.
//
// The stiffness is that of the softest mode that resisted where the branch starts, over what it was there.
#pragma once

#include "reference/energy/branch.hpp"

namespace elastocheck::reference::energy {

// Of an accepted state, into the point that stands for it.
void give_account(const Path& path, const State& state, Equilibrium& point);

}  // namespace elastocheck::reference::energy
