// The motion of least stiffness at a state, and what leaves parts of a scene free or locked: where a
// branch ends, the softest motion shortly before is that of the null vector.
//
// Eigenvectors of (24) with the consistent tangent, in the norm |W x|, rows of Φ_q of length one:
//
// ⎡ W⁻¹ K W⁻¹   ρ Φ̂ᵀ ⎤
// ⎣   ρ Φ̂        0   ⎦      ρ = max |W⁻¹ K W⁻¹|
//
// The smallest eigenvalue belongs to a motion that hardly anything resists (limit and bifurcation
// points) or that the joints can hardly drive (dead points of a linkage). Dense, for messages.
#pragma once

#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

// "drop_link: rotation about ..." at an equilibrium of the branch; empty where a model is too large
// or the matrix is not finite. With `moves_output` the softest that moves a wheel or probe.
std::string softest_motion(const Model& model, const Branch& branch, const Equilibrium& state,
                           bool moves_output = false);

// Why a scene may not settle or follow its trim, from the design position: idle motions of its
// outputs and bodies that redundant joints lock.
std::vector<std::string> free_or_locked(const Model& model);

}  // namespace elastocheck::recursive
