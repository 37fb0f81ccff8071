// A-posteriori error bound and remaining stiffness of a minimum.
//
// Newton's method on the conditions of the minimum, with the second derivatives and multipliers of
// each iterate (`correction`, branch.hpp): ξᵏ⁺¹ = ξᵏ + dξᵏ. Where every dξ is at most θ = ¼ of the
// one before, the iterates converge to one minimum, whose distance from ξ is at most
//
//   Σ |dξᵏ| + |dξ_last| + 3 R,   R = max |correction of (± e, ± e_Φ)| over a few choices of signs
//
// R is the effect of rounding on the last correction: the gradient and the constraints have the
// errors
//
//   e = 4 ε (|H| c + |Jᵀ| |λ|),   e_Φ = 4 ε |J| c,
//   c = (|r|/L + 1, 1), the sizes of the coordinates
//
// in double precision, ε = 2⁻⁵². The bound is condition times backward error; infinite where the
// corrections do not decrease. It does not cover idle motions.
//
// The remaining stiffness is that of the softest mode that resists at the start of the branch, over
// its value there.
#pragma once

#include "reference/energy/minimise/branch.hpp"

namespace elastocheck::reference::energy {

// Writes bound and stiffness of an accepted state to its point.
void add_error_bound(const Path& path, const State& state, Equilibrium& point);

}  // namespace elastocheck::reference::energy
