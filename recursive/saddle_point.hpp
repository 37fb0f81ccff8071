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

#include "recursive/saddle_matrix.hpp"
#include "recursive/sparse_lu.hpp"

namespace elastocheck::recursive {

template <class Real>
struct SaddlePoint {
    int n = 0, m = 0;      // 6nb, rows of Φ
    SaddleMatrix<Real> M;  // raw [(n+m) × (n+m)]; assembled by the caller
    Vector<Real> scale;    // D, powers of two
    int idle = 0;          // how many columns of `held` are idle modes; the rest are redundant combinations
    Matrix<Real> held;     // z or y, physical units, unit in `weight`, zero in the other part [(n+m) × d]
    Vector<Real> weight;   // W: 1 for Δr [m], L for Δπ, 1 for λ
    Matrix<Real> moves;    // 1 where an entry of `held` may be other than zero
    // M̂ with its border, entry by entry of the pattern; where an entry of M lies among its values, -1 - ... for
    // one of the border; what it is multiplied by.
    std::vector<Real> values, scaling;
    std::vector<int> source;
    Matrix<Real> border;  // b in scaled coordinates, of unit length [(n+m) × d]
    Vector<Real> rhs, solution;
    SparseLU<Real> lu;

    int borders() const { return static_cast<int>(held.cols()); }
};

// D of the matrix M, by a few Ruiz sweeps: every row of D M D has its largest entry in (½, 2].
template <class Real>
Vector<Real> equilibration(const SaddleMatrix<Real>& M) {
    Vector<Real> d = Vector<Real>::Ones(M.n + M.m), largest(M.n + M.m);
    for (int sweep = 0; sweep < 10; ++sweep) {
        largest.setZero();
        for_each_entry(M, [&](int i, int j, int at) {
            largest[i] = std::max(largest[i], std::abs(M.values[static_cast<std::size_t>(at)]) * d[j]);
        });
        for (Eigen::Index k = 0; k < d.size(); ++k)
            if (largest[k] > 0) d[k] /= std::sqrt(largest[k] * d[k]);
    }
    return d.unaryExpr([](Real value) { return std::exp2(std::round(std::log2(value))); });
}

// Makes the columns of `held` unit and mutually perpendicular in the norm W, each in its own part.
template <class Real>
void orthonormalise(SaddlePoint<Real>& system) {
    const auto W2 = system.weight.array().square();
    for (int c = 0; c < system.borders(); ++c) {
        auto z = system.held.col(c);
        z.array() *= system.moves.col(c).array();
        for (int b = 0; b < c; ++b) {
            const Real overlap = (z.array() * W2 * system.held.col(b).array()).sum();
            z -= overlap * system.held.col(b);
        }
        z /= std::sqrt((z.array().square() * W2).sum());
    }
}

// The border of every held direction around the pattern of M.
inline Pattern bordered(const Pattern& inner, const Eigen::MatrixXd& moves) {
    const auto N = inner.size, d = static_cast<int>(moves.cols());
    Pattern all{N + d, {}, {}};
    for (int j = 0; j < N + d; ++j) {
        all.first.push_back(static_cast<int>(all.row.size()));
        if (j < N) {
            const auto column = static_cast<std::size_t>(j);
            all.row.insert(all.row.end(), inner.row.begin() + inner.first[column],
                           inner.row.begin() + inner.first[column + 1]);
            for (int c = 0; c < d; ++c)
                if (moves(j, c) != 0) all.row.push_back(N + c);
        } else {
            for (int i = 0; i < N; ++i)
                if (moves(i, j - N) != 0) all.row.push_back(i);
        }
    }
    all.first.push_back(static_cast<int>(all.row.size()));
    return all;
}

// Gathers M̂ and its border from M and what is held.
template <class Real>
void scale_entries(SaddlePoint<Real>& system) {
    const int N = system.n + system.m;
    for (int c = 0; c < system.borders(); ++c) {
        auto b = system.border.col(c);
        b = system.scale.array() * system.weight.array().square() * system.held.col(c).array();
        b.normalize();
    }
    const Pattern& pattern = system.lu.order.pattern;
    const Real* const M = system.M.values.data();
    const int inner = pattern.first[static_cast<std::size_t>(N)];
    for (int e = 0; e < inner; ++e) {
        const auto at = static_cast<std::size_t>(e);
        const int source = system.source[at];
        system.values[at] = source >= 0 ? M[source] * system.scaling[at] : system.border.data()[-1 - source];
    }
    for (auto at = static_cast<std::size_t>(inner); at < pattern.entries(); ++at)
        system.values[at] = system.border.data()[-1 - system.source[at]];
}

// Fixes the scaling from the matrix now in M, what to hold, `idle` modes first, then redundant combinations,
// in the columns of `null_space` [(n+m) × d], and the order of elimination; `inner` is what of M can be other
// than zero. A held mode moves the same bodies wherever the branch leads.
template <class Real>
void analyse(SaddlePoint<Real>& system, int idle, const Eigen::MatrixXd& null_space, const Pattern& inner) {
    const Eigen::Index N = system.n + system.m, d = null_space.cols();
    system.scale = equilibration<Real>(system.M);
    system.idle = idle;
    system.held = null_space.cast<Real>();
    system.moves.setZero(N, d);
    for (Eigen::Index c = 0; c < d; ++c) {
        if (c >= idle) {
            system.moves.col(c).tail(system.m).setOnes();
            continue;
        }
        const auto part = [&](Eigen::Index row) {  // of the body that the row belongs to
            return system.held.col(c)
                .segment(row - row % 6, 6)
                .cwiseProduct(system.weight.segment(row - row % 6, 6));
        };
        const Real whole = system.held.col(c).head(system.n).norm();
        for (Eigen::Index row = 0; row < system.n; ++row)
            system.moves(row, c) = part(row).norm() > Real(1e-5) * whole ? 1 : 0;
    }
    orthonormalise(system);

    const Pattern pattern = bordered(inner, system.moves.template cast<double>());
    system.source.clear();
    system.scaling.clear();
    for (int j = 0; j < pattern.size; ++j)
        for (int e = pattern.first[static_cast<std::size_t>(j)];
             e < pattern.first[static_cast<std::size_t>(j) + 1]; ++e) {
            const int i = pattern.row[static_cast<std::size_t>(e)];
            const bool inside = i < N && j < N;
            const auto flat = [&](int row, int column) { return static_cast<int>(column * N) + row; };
            system.source.push_back(
                inside ? system.M.at(i, j)
                       : -1 - (i < N ? flat(i, j - static_cast<int>(N)) : flat(j, i - static_cast<int>(N))));
            system.scaling.push_back(inside ? system.scale[i] * system.scale[j] : Real(1));
        }
    system.values.assign(pattern.entries(), 0);
    system.border.setZero(N, d);
    system.rhs.setZero(N + d);
    system.solution.setZero(N + d);
    system.lu.order.pattern = pattern;
    scale_entries(system);
    analyse(system.lu, pattern, system.values.data());
}

// The same system in another arithmetic, in the order of elimination of this one; not factorised yet.
template <class Real>
SaddlePoint<Real> in_arithmetic(const SaddlePoint<double>& from) {
    SaddlePoint<Real> system;
    system.n = from.n;
    system.m = from.m;
    system.M = from.M.template cast<Real>();
    system.scale = from.scale.cast<Real>();
    system.idle = from.idle;
    system.held = from.held.cast<Real>();
    system.weight = from.weight.cast<Real>();
    system.moves = from.moves.cast<Real>();
    system.values.assign(from.values.begin(), from.values.end());
    system.scaling.assign(from.scaling.begin(), from.scaling.end());
    system.source = from.source;
    system.border = from.border.cast<Real>();
    system.rhs = from.rhs.cast<Real>();
    system.solution = from.solution.cast<Real>();
    analyse(system.lu, from.lu.order);
    return system;
}
template <>
inline SaddlePoint<double> in_arithmetic(const SaddlePoint<double>& from) {
    return from;
}

// x = (Δq, λ) for the right-hand side (f, lower),
// with the factors of the last `factorise`. Nothing is allocated.
template <class Real>
void back_substitute(SaddlePoint<Real>& system, const Vector<Real>& f, const Vector<Real>& lower,
                     Vector<Real>& x) {
    const int n = system.n, m = system.m;
    system.rhs.head(n).array() = f.array() * system.scale.head(n).array();
    system.rhs.segment(n, m).array() = lower.array() * system.scale.tail(m).array();
    system.rhs.tail(system.borders()).setZero();
    solve(system.lu, system.rhs.data(), system.solution.data());
    x.array() = system.scale.array() * system.solution.head(n + m).array();
}

// Factorises the matrix now in M and renews what is held. Nothing is allocated. Returns the smallest over the
// largest pivot of the scaled, bordered matrix; the caller judges it.
template <class Real>
Real factorise(SaddlePoint<Real>& system) {
    const int N = system.n + system.m, d = system.borders();
    scale_entries(system);
    const Real pivot_ratio = factorise(system.lu, system.values.data());

    for (int c = 0; c < d; ++c) {
        system.rhs.setZero();
        system.rhs[N + c] = 1;
        solve(system.lu, system.rhs.data(), system.solution.data());
        system.held.col(c).array() = system.scale.array() * system.solution.head(N).array();
    }
    if (d > 0) orthonormalise(system);
    return pivot_ratio;
}

}  // namespace elastocheck::recursive
