// A-posteriori error bound and remaining stiffness at a point of a path.
// They are computed from the true equations in extended precision, independent of the method that
// produced the point.
//
// ---- Error bound
//
// A point gives q alone. The multipliers are solved first, λ ← λ + dλ at the same q, because the
// sums of the published method carry λ of another configuration. Then Newton's method with fresh
// factors, in extended precision, from z₀ = (q, λ):
//
// ⎡ ∂G/∂q   Φ_qᵀ ⎤ ⎧ dq ⎫ᵏ     ⎧ G ⎫
// ⎣ Φ_q      0   ⎦ ⎩ dλ ⎭   = -⎩ Φ ⎭     zᵏ⁺¹ = zᵏ + dzᵏ
//
// Each correction is the condition number times the backward error at its iterate. Where each
// correction is at most half of the one before, the iteration converges to an equilibrium z*. By
// the theorem of Newton and Kantorovich z* is the only equilibrium near, and its distance is at
// most the sum of the corrections. It need not be the equilibrium that q approximates: an
// equilibrium of another branch may be nearer. Therefore z₀ is not the point but the branch itself,
// followed by accepted steps (continuation.hpp) from the settled start at a = 0 from point to
// point, and the distance of the point from z₀ is added. Where a path is followed past limit
// points, z₀ is the point.
//
// The error after the last correction is less than that correction, plus the effect of rounding in
// G and Φ as evaluated in extended precision, e_i = ε Σ_j |M_ij| c_j with c = (size of r, 1, |λ|):
//
//   R = max |M⁻¹ (±e)|   over a few choices of the signs
//
//   |q - q*| ≤ Σ |dqᵏ| + |dq_last| + 3 R         per body: of the origin, of the orientation
//
// Where the iteration does not converge the bound is infinite. The bound does not cover idle modes:
// dq is zero along them. With idle modes present z₀ is the point, if z* agrees with the branch
// except along the idle modes.
//
// The same factors give the remaining stiffness (stiffness.hpp), as a ratio to that at the first
// point.
#pragma once

#include <functional>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"

namespace elastocheck::recursive {

// Returns a function that sets the error bound and remaining stiffness of the points of one path,
// called in their order from a = 0. `turns_back`: the path is followed past limit points, where the
// determinant changes its sign.
std::function<void(Equilibrium&)> error_estimator(const Model& model, const Branch& branch,
                                                  const Analysis& analysis,
                                                  bool turns_back = false);

}  // namespace elastocheck::recursive
