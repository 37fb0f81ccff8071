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
template <class Real>
Real scattered(Eigen::Index k) {
    return std::fmod(Real(0.6180339887498948482L) * static_cast<Real>(k + 1), Real(1)) - Real(0.5);
}

namespace detail {

// Orthonormalises the columns of U in W and drops dependent ones.
template <class Real>
void orthonormalise(const Vector<Real>& weight, Matrix<Real>& U) {
    constexpr Real nothing = Real(1e-9);
    const auto W2 = weight.head(U.rows()).array().square();
    Eigen::Index kept = 0;
    for (Eigen::Index c = 0; c < U.cols(); ++c) {
        Vector<Real> u = U.col(c);
        const Real whole = std::sqrt((u.array().square() * W2).sum());
        for (int pass = 0; pass < 2; ++pass)
            for (Eigen::Index k = 0; k < kept; ++k) {
                const Real part = (U.col(k).array() * W2 * u.array()).sum();
                u -= part * U.col(k);
            }
        const Real left = std::sqrt((u.array().square() * W2).sum());
        if (left > nothing * whole) U.col(kept++) = u / left;
    }
    U.conservativeResize(Eigen::NoChange, kept);
}

// 1/θ for the negative eigenvalue θ of H of largest modulus, else for the largest θ.
LeastStiffness least_of(const Eigen::MatrixXd& H);

}  // namespace detail

// Least stiffness with the factors in the system, which must be those of the consistent tangent. U
// [6nb × 3 at most], orthonormal in W, is kept for the next point; empty at the first.
template <class Real>
LeastStiffness least_stiffness(SteppingState<Real>& s, Matrix<Real>& U) {
    constexpr int vectors = 3, first_turns = 5, turns = 2;
    if (s.free <= 0) return {};
    const int n = s.n();
    const auto W2 = s.system.weight.head(n).array().square();
    const bool first = U.cols() == 0;
    if (first) {
        U.resize(n, std::min(vectors, s.free));
        for (Eigen::Index c = 0; c < U.cols(); ++c)
            for (Eigen::Index k = 0; k < n; ++k)
                U(k, c) = scattered<Real>(k + c * n) / s.system.weight[k];
        detail::orthonormalise(s.system.weight, U);
    }
    Eigen::MatrixXd H;
    s.lower.setZero();
    for (int turn = first ? first_turns : turns; turn > 0; --turn) {
        Matrix<Real> V(n, U.cols());
        for (Eigen::Index c = 0; c < U.cols(); ++c) {
            s.upper = U.col(c).array() * W2;
            back_substitute(s.system, s.upper, s.lower, s.x);  // a check only: not counted
            V.col(c) = s.x.head(n);
        }
        H = (U.transpose() * W2.matrix().asDiagonal() * V).template cast<double>();
        U = V;
        detail::orthonormalise(s.system.weight, U);
    }
    return detail::least_of(H);
}

// Instantiated in stepping/sweep_double.cpp.
extern template LeastStiffness least_stiffness<double>(SteppingState<double>&, Matrix<double>&);

}  // namespace elastocheck::recursive
