// Least reduced stiffness: with Z a basis of the motions that the joints allow and something
// resists, the smallest eigenvalue μ of ZᵀKZ, K = ∂G/∂q, in the norm |W x|² = |Δr|² + L² |Δπ|². It
// is found by subspace iteration with the factors of (24), which give the inverse:
//
// ⎡ K    Φ_qᵀ ⎤ ⎧ v ⎫   ⎧ W² u ⎫
// ⎣ Φ_q   0   ⎦ ⎩ · ⎭ = ⎩  0   ⎭      v = T u,  T = Z (ZᵀKZ)⁻¹ Zᵀ W²
//
// The iteration is repeated on three vectors U at once, starting from those of the point before.
// The eigenvalues θ of Uᵀ W² T U converge to the largest of T, and 1/θ to the least stiffnesses.
// Where the path turns back or bifurcates one θ goes to infinity; beyond that point θ is negative.
// Two eigenvalues that change sign at once are both seen, which the determinant does not show.
#pragma once

#include <cmath>

#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

// Quasi-random start values in (-½, ½), independent of the model: fractions of multiples of the
// golden ratio.
inline double scattered(Eigen::Index k) {
    return std::fmod(0.6180339887498948482 * static_cast<double>(k + 1), 1.0) - 0.5;
}

namespace detail {

// Orthonormalises the columns of U in W and drops dependent ones.
void orthonormalise(const Vector<double>& weight, Matrix<double>& U);

// 1/θ for the negative eigenvalue θ of H of largest modulus, else for the largest θ.
LeastStiffness min_of(const Eigen::MatrixXd& H);

}  // namespace detail

// Least stiffness with the factors in the system, which must be those of the consistent tangent. U
// [6nb × 3 at most], orthonormal in W, is kept for the next point; empty at the first.
LeastStiffness min_stiffness(SteppingState& s, Matrix<double>& U);

}  // namespace elastocheck::recursive
