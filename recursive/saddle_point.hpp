// The linear system of eqs. (23)-(25), solved once per step.
//
// ⎡ K    Φ_qᵀ ⎤ ⎧ Δq ⎫   ⎧ f ⎫
// ⎣ Φ_q   0   ⎦ ⎩ λ  ⎭ = ⎩ 0 ⎭      [(6nb + m) × (6nb + m)]      (24)
//
// The raw matrix mixes N/m, N·m and pure numbers, so it is scaled symmetrically to M̂ = D M D with unit rows
// (Ruiz) before anything is judged on it. D holds powers of two: scaling changes no digit.
//
// A motion z that nothing resists (idle mode), or a combination y of constraints that says nothing new, makes
// M singular in a direction that is known beforehand (diagnosis.hpp). It is held by bordering,
//
// ⎡ M̂   b ⎤ ⎧ x̂ ⎫   ⎧ f̂ ⎫                       ⎡ M̂   b ⎤ ⎧ n ⎫   ⎧ 0 ⎫
// ⎣ bᵀ  0 ⎦ ⎩ μ ⎭ = ⎩ 0 ⎭    and, for next time,  ⎣ bᵀ  0 ⎦ ⎩ ν ⎭ = ⎩ 1 ⎭      b = (W² z, 0) or (0, y)
//
// with the same factors. bᵀ x = 0 is what singles out the step of minimum norm √(|Δr|² + L²|Δπ|²), or the λ
// of minimum norm. n is the null vector of the present configuration and gives z (y) for the next step. Only
// the Δq part of an idle n is kept (and the λ part of a redundant one): the other part is the constraint
// error that the published method leaves, and feeding it back grows it.
#pragma once

#include <Eigen/LU>

#include "recursive/state.hpp"

namespace elastocheck::recursive {

template <class Real>
struct SaddlePoint {
    int n = 0, m = 0;     // 6nb, rows of Φ
    Matrix<Real> M;       // raw, [(n+m) × (n+m)]; assembled by the caller, symmetric
    Vector<Real> scale;   // D, powers of two
    int idle = 0;         // how many columns of `held` are idle modes; the rest are redundant combinations
    Matrix<Real> held;    // z or y, physical units, unit in `weight`, zero in the other part [(n+m) × d]
    Vector<Real> weight;  // W: 1 for Δr [m], L for Δπ, 1 for λ
    Matrix<Real> bordered, rhs, x;
    Eigen::PartialPivLU<Matrix<Real>> lu;

    auto K() { return M.topLeftCorner(n, n); }
    int borders() const { return static_cast<int>(held.cols()); }
};

// D of the matrix M, by a few Ruiz sweeps: every row of D M D has its largest entry in (½, 2].
template <class Real>
Vector<Real> equilibration(const Matrix<Real>& M) {
    Vector<Real> d = Vector<Real>::Ones(M.rows());
    for (int sweep = 0; sweep < 10; ++sweep) {
        const Matrix<Real> scaled = d.asDiagonal() * M * d.asDiagonal();
        for (Eigen::Index k = 0; k < d.size(); ++k) {
            const Real largest = scaled.row(k).cwiseAbs().maxCoeff();
            if (largest > 0) d[k] /= std::sqrt(largest);
        }
    }
    return d.unaryExpr([](Real value) { return std::exp2(std::round(std::log2(value))); });
}

// Makes the columns of `held` unit and mutually perpendicular in the norm W, each in its own part.
template <class Real>
void orthonormalise(SaddlePoint<Real>& system) {
    const auto W2 = system.weight.array().square();
    for (int c = 0; c < system.borders(); ++c) {
        auto z = system.held.col(c);
        if (c < system.idle)
            z.tail(system.m).setZero();
        else
            z.head(system.n).setZero();
        for (int b = 0; b < c; ++b) {
            const Real overlap = (z.array() * W2 * system.held.col(b).array()).sum();
            z -= overlap * system.held.col(b);
        }
        z /= std::sqrt((z.array().square() * W2).sum());
    }
}

// Fixes the scaling from the matrix now in M, and what to hold: `idle` modes first, then redundant
// combinations, in the columns of `null_space` [(n+m) × d].
template <class Real>
void prepare(SaddlePoint<Real>& system, int idle, const Eigen::MatrixXd& null_space) {
    system.scale = equilibration<Real>(system.M);
    system.idle = idle;
    system.held = null_space.cast<Real>();
    orthonormalise(system);
    const Eigen::Index size = system.n + system.m + null_space.cols();
    system.bordered.setZero(size, size);
    system.rhs.setZero(size, 1 + null_space.cols());
    system.x.setZero(size, 1 + null_space.cols());
    system.lu = Eigen::PartialPivLU<Matrix<Real>>(size);
}

// x = (Δq, λ) for the right-hand side (f, lower), with the factors of the last `factorise`. Nothing is
// allocated.
template <class Real>
void back_substitute(SaddlePoint<Real>& system, const Vector<Real>& f, const Vector<Real>& lower,
                     Vector<Real>& x) {
    const int N = system.n + system.m;
    auto rhs = system.rhs.col(0);
    rhs.head(system.n) = f;
    rhs.segment(system.n, system.m) = lower;
    rhs.head(N).array() *= system.scale.array();
    rhs.tail(system.borders()).setZero();
    system.x.col(0) = system.lu.solve(rhs);
    x = system.scale.asDiagonal() * system.x.col(0).head(N);
}

// Factorises the matrix now in M and renews what is held. Nothing is allocated. Returns the smallest over the
// largest pivot of the scaled, bordered matrix; the caller judges it.
template <class Real>
Real factorise(SaddlePoint<Real>& system) {
    const int N = system.n + system.m, d = system.borders();
    const auto& D = system.scale;
    system.bordered.topLeftCorner(N, N).noalias() = D.asDiagonal() * system.M * D.asDiagonal();
    for (int c = 0; c < d; ++c) {  // b in scaled coordinates, to unit length
        auto b = system.bordered.col(N + c).head(N);
        b = D.array() * system.weight.array().square() * system.held.col(c).array();
        b.normalize();
    }
    system.bordered.bottomLeftCorner(d, N) = system.bordered.topRightCorner(N, d).transpose();
    system.bordered.bottomRightCorner(d, d).setZero();
    system.lu.compute(system.bordered);

    for (int c = 0; c < d; ++c) {
        system.rhs.col(1 + c).setZero();
        system.rhs(N + c, 1 + c) = 1;
        system.x.col(1 + c) = system.lu.solve(system.rhs.col(1 + c));
        system.held.col(c) = D.asDiagonal() * system.x.col(1 + c).head(N);
    }
    if (d > 0) orthonormalise(system);
    const auto pivots = system.lu.matrixLU().diagonal().cwiseAbs();
    return pivots.minCoeff() / pivots.maxCoeff();
}

}  // namespace elastocheck::recursive
