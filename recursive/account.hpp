// What a point of a path says of itself: how far it may be from the equilibrium that it stands for, and what stiffness
// is left there. Asked of the true equations in extended precision, whatever method found the point and however.
//
// ---- How far it may be off
//
// A point is q alone, a given; a multiplier of its own is solved first, λ ← λ + dλ at the same q (the published sums
// carry one of another place). Then Newton's method with fresh factors, in extended precision, from z₀ = (q, λ):
//
// ⎡ ∂G/∂q   Φ_qᵀ ⎤ ⎧ dq ⎫ᵏ     ⎧ G ⎫
// ⎣ Φ_q      0   ⎦ ⎩ dλ ⎭   = -⎩ Φ ⎭     zᵏ⁺¹ = zᵏ + dzᵏ
//
// Each correction is condition times backward error of its place. Where each is at most half of the one before, they
// lead to an equilibrium z*, which by Newton and Kantorovich's theorem is the only one near, and no farther than that way.
// It need not be the one that q stands for: an equilibrium of another branch may be nearer. So z₀ is not the point: it is
// where the branch leads, by believed steps (walk.hpp) from what settles at a = 0 and on from point to point, and the distance
// of the point from there is added. Where a path is followed past limit points z₀ is the point.
//
// What is left behind the last correction is less than it, and what rounding makes of
// G and Φ as they are evaluated in extended precision, e_i = ε Σ_j |M_ij| c_j with c = (size of r, 1, |λ|), is
//
//   R = max |M⁻¹ (±e)|   over a few choices of the signs
//
//   |q - q*| ≤ Σ |dqᵏ| + |dq_last| + 3 R         per body: of the origin, of the orientation
//
// Where they lead nowhere there is no bound: infinite. Of what is idle nothing is said: dq holds still what nothing
// resists, and where anything is idle z₀ is the point after all, if z* is where the branch leads but for that.
//
// What stiffness is left there is told by the same factors (stiffness.hpp), over what it was at the first point.
#pragma once

#include <functional>

#include "models/equilibrium_path.hpp"
#include "recursive/analysis.hpp"
#include "recursive/solve.hpp"

namespace elastocheck::recursive {

// Gives the points of one path their account, in their order from a = 0. `turns_back`: the path is followed past limit
// points, where the determinant has another sign.
std::function<void(Equilibrium&)> accountant(const Model& model, const Branch& branch,
                                             const Analysis& analysis, bool turns_back = false);

}  // namespace elastocheck::recursive
