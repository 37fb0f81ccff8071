// Block-sparse storage of the matrix of eq. (24):
//
// ⎡ K    Φ_qᵀ ⎤     K      a 6 × 6 block for every body, and for every ordered connected pair
// ⎣ Φ_q   0   ⎦     Φ_q    two parts of 6 for every row, one per body; Φ_qᵀ uses the same values
//
// Storage grows with the model and not with its square. Assembly writes blocks by row
// and column, as in the full matrix. The positions of the blocks depend on the model
// alone (`saddle_matrix`, pattern.hpp).
#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <vector>

#include "recursive/formula/state.hpp"

namespace elastocheck::recursive {

template <class Real>
struct SaddleMatrix {
    int n = 0, m = 0;  // 6nb, rows of Φ
    // of every body, ascending: neighbour[first[b] ... first[b+1])
    std::vector<int> first, neighbour;
    std::vector<std::array<BodyId, 2>> ends;  // of every row of Φ: the bodies of its two parts
    // Blocks column by column: those of the bodies, then those of their neighbours; then the parts
    // of rows.
    std::vector<Real> values;

    // Start of the block of two bodies in `values`; -1 where nothing connects them.
    int block_at(BodyId a, BodyId b) const {
        if (a == b) return 36 * a;
        const auto from = neighbour.begin() + first[static_cast<std::size_t>(a)],
                   to = neighbour.begin() + first[static_cast<std::size_t>(a) + 1];
        const auto found = std::lower_bound(from, to, b);
        return found == to || *found != b
                   ? -1
                   : 6 * n + 36 * static_cast<int>(found - neighbour.begin());
    }
    int part_at(int row, int end) const { return 36 * blocks() + 12 * row + 6 * end; }
    int blocks() const { return n / 6 + static_cast<int>(neighbour.size()); }

    // A part of K, addressed as in the full matrix; it must lie within the block of one pair.
    template <int rows, int columns>
    auto block(Eigen::Index i, Eigen::Index j) {
        const auto a = static_cast<int>(i), b = static_cast<int>(j);
        return Eigen::Map<Eigen::Matrix<Real, rows, columns>, 0, Eigen::OuterStride<6>>(
            values.data() + block_at(a / 6, b / 6) + 6 * (b % 6) + a % 6);
    }
    // The part of a row of Φ_q for one of its two bodies.
    Eigen::Map<Vector6<Real>> part(int row, int end) {
        return Eigen::Map<Vector6<Real>>(values.data() + part_at(row, end));
    }
    Eigen::Map<const Vector6<Real>> part(int row, int end) const {
        return Eigen::Map<const Vector6<Real>>(values.data() + part_at(row, end));
    }
    // Position of entry (i, j) of the full matrix in `values`; -1 for a structural zero.
    int at(int i, int j) const {
        if (i < n && j < n) {
            const int block = block_at(i / 6, j / 6);
            return block < 0 ? -1 : block + 6 * (j % 6) + i % 6;
        }
        if (i < n) return at(j, i);
        if (j >= n) return -1;
        for (int end = 0; end < 2; ++end)
            if (ends[static_cast<std::size_t>(i - n)][static_cast<std::size_t>(end)] == j / 6)
                return part_at(i - n, end) + j % 6;
        return -1;
    }

    template <class Other>
    SaddleMatrix<Other> cast() const {
        return {n, m, first, neighbour, ends, std::vector<Other>(values.begin(), values.end())};
    }
};

// Calls sink(i, j, position in `values`) for every stored entry of the full matrix, both halves.
template <class Real, class Sink>
void for_each_entry(const SaddleMatrix<Real>& M, Sink&& sink) {
    const auto block = [&](BodyId a, BodyId b, int from) {
        for (int j = 0; j < 6; ++j)
            for (int i = 0; i < 6; ++i) sink(6 * a + i, 6 * b + j, from + 6 * j + i);
    };
    for (BodyId a = 0; a < M.n / 6; ++a) {
        block(a, a, 36 * a);
        for (int k = M.first[static_cast<std::size_t>(a)];
             k < M.first[static_cast<std::size_t>(a) + 1]; ++k)
            block(a, M.neighbour[static_cast<std::size_t>(k)], 6 * M.n + 36 * k);
    }
    for (int row = 0; row < M.m; ++row)
        for (int end = 0; end < 2; ++end) {
            const BodyId b = M.ends[static_cast<std::size_t>(row)][static_cast<std::size_t>(end)];
            if (b == ground) continue;
            for (int c = 0; c < 6; ++c) {
                sink(M.n + row, 6 * b + c, M.part_at(row, end) + c);
                sink(6 * b + c, M.n + row, M.part_at(row, end) + c);
            }
        }
}

// f = Φ_qᵀ λ [6nb], with the Φ_q of the matrix. Allocates nothing.
template <class Real, class Lambda>
void constraint_force(const SaddleMatrix<Real>& M, const Lambda& lambda, Vector<Real>& f) {
    f.setZero(M.n);
    for (int row = 0; row < M.m; ++row)
        for (int end = 0; end < 2; ++end) {
            const BodyId b = M.ends[static_cast<std::size_t>(row)][static_cast<std::size_t>(end)];
            if (b != ground) f.template segment<6>(6 * b) += lambda[row] * M.part(row, end);
        }
}

// Largest absolute value on the diagonal of K.
template <class Real>
Real stiffest(const SaddleMatrix<Real>& M) {
    Real largest = 0;
    for (int i = 0; i < M.n; ++i)
        largest = std::max(largest, std::abs(M.values[static_cast<std::size_t>(M.at(i, i))]));
    return largest;
}

// The full matrix, both halves [(n+m) × (n+m)]; stored zeros are kept.
template <class Real>
Eigen::SparseMatrix<Real> sparse(const SaddleMatrix<Real>& M) {
    std::vector<Eigen::Triplet<Real>> entries;
    for_each_entry(M, [&](int i, int j, int at) {
        entries.emplace_back(i, j, M.values[static_cast<std::size_t>(at)]);
    });
    Eigen::SparseMatrix<Real> all(M.n + M.m, M.n + M.m);
    all.setFromTriplets(entries.begin(), entries.end());
    return all;
}

}  // namespace elastocheck::recursive
