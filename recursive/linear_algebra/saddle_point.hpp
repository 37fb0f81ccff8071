// The linear system of eqs. (23)-(25), solved once per step.
//
// ⎡ K    Φ_qᵀ ⎤ ⎧ Δq ⎫   ⎧ f ⎫
// ⎣ Φ_q   0   ⎦ ⎩ λ  ⎭ = ⎩ 0 ⎭      [(6nb + m) × (6nb + m)]      (24)
//
// The raw matrix mixes N/m, N·m and pure numbers. It is equilibrated symmetrically to M̂ = D M D
// with unit rows (Ruiz 2001) before pivots are judged. D holds powers of two: no rounding.
//
// A motion z that nothing resists (idle mode), or a redundant combination y of constraints, makes M
// singular in a direction known from the diagnosis (diagnosis.hpp). Bordering holds that direction,
//
// ⎡ M̂   b ⎤ ⎧ x̂ ⎫   ⎧ f̂ ⎫                       ⎡ M̂   b ⎤ ⎧ n ⎫   ⎧ 0 ⎫
// ⎣ bᵀ  0 ⎦ ⎩ μ ⎭ = ⎩ 0 ⎭    and, for next time, ⎣ bᵀ  0 ⎦ ⎩ ν ⎭ = ⎩ 1 ⎭   b = (W² z, 0) or (0, y)
//
// with the same factors. bᵀ x = 0 selects the step of minimum norm √(|Δr|² + L²|Δπ|²), or the λ of
// minimum norm. n is the null vector at the present configuration and gives z (y) for the next
// step. Only the Δq part of an idle n is kept (and the λ part of a redundant one). The other part
// is the constraint error of the published method, and feeding it back amplifies it.
#pragma once

#include "recursive/linear_algebra/saddle_matrix.hpp"
#include "recursive/linear_algebra/sparse_lu.hpp"

namespace elastocheck::recursive {

// Held directions: idle modes first, then redundant combinations, each with the entries that may be
// non-zero on the branch. Two directions have the same entries or none in common; those with the
// same entries are consecutive.
template <class Real>
struct Held {
    int idle = 0;            // number of idle modes
    std::vector<int> first;  // index of each direction's first entry, and the end [d + 1]
    std::vector<int> with;   // first direction with the same entries [d]
    // of each entry, ascending within a direction; all six rows of a body for an idle mode
    std::vector<int> row;
    std::vector<Real> value;  // z or y, physical units, of unit norm in `weight`

    int size() const { return static_cast<int>(with.size()); }
    int begin(int c) const { return first[static_cast<std::size_t>(c)]; }
    int end(int c) const { return first[static_cast<std::size_t>(c) + 1]; }
    // Position of a body's entries in an idle mode; -1 where the mode does not move the body.
    int at(int c, BodyId b) const {
        const auto from = row.begin() + begin(c), to = row.begin() + end(c);
        const auto found = std::lower_bound(from, to, 6 * b);
        return b == ground || found == to || *found != 6 * b
                   ? -1
                   : static_cast<int>(found - row.begin());
    }
    Eigen::Map<Vector<Real>> values(int c) { return {value.data() + begin(c), end(c) - begin(c)}; }
    Eigen::Map<const Vector<Real>> values(int c) const {
        return {value.data() + begin(c), end(c) - begin(c)};
    }

    template <class Other>
    Held<Other> cast() const {
        return {idle, first, with, row, {value.begin(), value.end()}};
    }
};

template <class Real>
struct SaddlePoint {
    int n = 0, m = 0;  // 6nb, rows of Φ
    // raw [(n+m) × (n+m)]; assembled by the caller. Its values are followed by the border: b of
    // every held direction in scaled coordinates, of unit length
    SaddleMatrix<Real> M;
    Vector<Real> scale;           // D, powers of two
    std::vector<double> largest;  // |entry| of M, the largest of the matrices from which D is fixed
    Vector<Real> weight;          // W: 1 for Δr [m], L for Δπ, 1 for λ
    Held<Real> held;
    Vector<Real> rhs, solution;
    SparseLU<Real> lu;     // of M̂ with its border
    double log_scale = 0;  // log₂ of det M̂ / det M at the present scaling over that at the first

    int borders() const { return held.size(); }
    Real* border() { return M.values.data() + M.part_at(m, 0); }
    const Real* border() const { return M.values.data() + M.part_at(m, 0); }
};

// D of the matrix M by Ruiz equilibration (2001): every row of D M D has its largest entry
// in (½, 2].
Vector<double> equilibration(const SaddleMatrix<double>& M);

// W² at the entries of a direction.
template <class Real>
auto weights(const SaddlePoint<Real>& system, int c) {
    return [&system, from = system.held.begin(c)](Eigen::Index e) {
        const Real w = system.weight[system.held.row[static_cast<std::size_t>(from + e)]];
        return w * w;
    };
}

// Makes the held directions orthonormal in the norm W; those without common entries are orthogonal
// already.
template <class Real>
void orthonormalise(SaddlePoint<Real>& system) {
    Held<Real>& held = system.held;
    for (int c = 0; c < held.size(); ++c) {
        auto z = held.values(c);
        const auto W2 = weights(system, c);
        const auto inner = [&](const auto& a, const auto& b) {
            Real sum = 0;
            for (Eigen::Index e = 0; e < z.size(); ++e) sum += a[e] * W2(e) * b[e];
            return sum;
        };
        for (int b = held.with[static_cast<std::size_t>(c)]; b < c; ++b) {
            const Real overlap = inner(z, held.values(b));
            z -= overlap * held.values(b);
        }
        z /= std::sqrt(inner(z, z));
    }
}

// Computes the border from the held directions.
template <class Real>
void set_border(SaddlePoint<Real>& system) {
    const Held<Real>& held = system.held;
    for (int c = 0; c < held.size(); ++c) {
        const auto W2 = weights(system, c);
        Eigen::Map<Vector<Real>> b(system.border() + held.begin(c), held.end(c) - held.begin(c));
        for (Eigen::Index e = 0; e < b.size(); ++e) {
            const auto at = static_cast<std::size_t>(held.begin(c) + e);
            b[e] = system.scale[held.row[at]] * W2(e) * held.value[at];
        }
        b.normalize();
    }
}

// Fixes the scaling from the matrix now in M, the held directions in the columns of `null_space`
// [(n+m) × d] (`idle` modes first, then redundant combinations), and the elimination order: `like`,
// where that fits. `inner` is the pattern of M, `loop` the loop of joints of every row of Φ.
void analyse(SaddlePoint<double>& system, int idle, const Eigen::SparseMatrix<double>& null_space,
             const Pattern& inner, const std::vector<int>& loop,
             const EliminationOrder& like = nullptr);

// Fixes the scaling again, from the larger of each entry of M now and before: the geometric
// stiffness of a large λ may exceed the stiffness at λ = 0 by any factor, and pivots in a scaling
// for the one say nothing about the other. An entry that cancels, as at a limit point, keeps its
// scale.
void rescale(SaddlePoint<double>& system);

// log₂ |det| of the last matrix factorised, in the first scaling.
inline double log_determinant(const SaddlePoint<double>& system) {
    return log_determinant(system.lu) - system.log_scale;
}

// The same system in another arithmetic, with this elimination order; not factorised.
template <class Real>
SaddlePoint<Real> in_arithmetic(const SaddlePoint<double>& from) {
    SaddlePoint<Real> system;
    system.n = from.n;
    system.m = from.m;
    system.M = from.M.template cast<Real>();
    system.scale = from.scale.cast<Real>();
    system.held = from.held.template cast<Real>();
    system.weight = from.weight.cast<Real>();
    system.rhs = from.rhs.cast<Real>();
    system.solution = from.solution.cast<Real>();
    analyse(system.lu, from.lu);
    return system;
}
template <>
inline SaddlePoint<double> in_arithmetic(const SaddlePoint<double>& from) {
    return from;
}

// Solves for x = (Δq, λ) with the right-hand side (f, lower) and the factors of the last
// `factorise`. Allocates nothing.
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

// Factorises the matrix now in M and updates the held directions. Allocates nothing.
// Returns the ratio of the smallest to the largest pivot of the scaled, bordered matrix,
// which the caller checks.
template <class Real>
Real factorise(SaddlePoint<Real>& system) {
    set_border(system);
    const Real pivot_ratio = factorise(system.lu, system.M.values.data());

    // The solution for the unit vector e_c of the border, at the entries of the direction only.
    Held<Real>& held = system.held;
    for (int c = 0; c < held.size(); ++c) {
        const int from = held.begin(c), count = held.end(c) - from;
        Real* const z = held.value.data() + from;
        solve_unit(system.lu, system.n + system.m + c, held.row.data() + from, count, z);
        for (int e = 0; e < count; ++e)
            z[e] *= system.scale[held.row[static_cast<std::size_t>(from + e)]];
    }
    orthonormalise(system);
    return pivot_ratio;
}

// Instantiated in linear_algebra/in_double.cpp.
extern template double factorise<double>(SaddlePoint<double>&);
extern template void back_substitute<double>(SaddlePoint<double>&, const Vector<double>&,
                                             const Vector<double>&, Vector<double>&);
extern template void set_border<double>(SaddlePoint<double>&);

}  // namespace elastocheck::recursive
