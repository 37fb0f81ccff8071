// LU factors of a matrix whose zeros never move and whose pivots hardly do.
//
// Which entries of eq. (24) can be other than zero is decided by who is connected to whom, so the order of
// elimination is chosen once, and afterwards only what can be other than zero is touched. Chosen is, step by
// step, the pivot that fills in least (Markowitz: smallest (entries in its row - 1)(entries in its column -
// 1)) among those no smaller than a tenth of their column. The choice stands while no multiplier of L exceeds
// a hundred; when one does, the order is chosen anew from the values of the moment.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "recursive/state.hpp"

namespace elastocheck::recursive {

template <class Real>
struct SparseLU {
    int size = 0;
    std::vector<char> pattern;    // what may be other than zero [size × size], row by row
    std::vector<int> row, col;    // the k-th pivot is A(row[k], col[k])
    std::vector<int> source, to;  // where an entry of A lies (column by column), and where in W it goes
    // Entries of the k-th column of L and row of U beside the pivot, as numbers of rows and columns of W:
    // below[first_below[k] ... first_below[k+1]), right[...] likewise.
    std::vector<int> below, first_below, right, first_right;
    std::vector<Real> W;                  // L (unit diagonal) and U in the order of the pivots, row by row
    std::vector<Real> inverse;            // 1 / pivots
    std::vector<Real> y;                  // the solution in the order of the pivots
    std::vector<char> filled;             // while the order is chosen: pattern of L + U ...
    std::vector<long> in_row, in_column;  // ... how many entries a row and a column still have
    std::vector<Real> largest;            // ... and the largest of a column
    int orders = 0;                       // how often the order was chosen
    int parity = 1;                       // of the two permutations `row` and `col` together: +1 or -1
    int orientation = 0;                  // sign of the determinant of the last matrix factorised

    static constexpr double least_pivot = 0.1, largest_multiplier = 100;
};

// Room for everything; `pattern` is taken from the entries of A [size × size] that are not zero.
template <class Real>
void reserve(SparseLU<Real>& lu, const Matrix<Real>& A) {
    const auto n = static_cast<std::size_t>(A.rows());
    lu.size = static_cast<int>(n);
    lu.pattern.assign(n * n, 0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            lu.pattern[i * n + j] = A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) != Real(0);
    lu.filled = lu.pattern;
    lu.W.assign(n * n, 0);
    lu.inverse.assign(n, 0);
    lu.y.assign(n, 0);
    lu.in_row.assign(n, 0);
    lu.in_column.assign(n, 0);
    lu.largest.assign(n, 0);
    for (auto* list : {&lu.row, &lu.col, &lu.first_below, &lu.first_right}) list->reserve(n + 1);
    for (auto* list : {&lu.source, &lu.to, &lu.below, &lu.right}) list->reserve(n * n);
    lu.orders = 0;
}

// +1 or -1, as an even or an odd number of swaps makes the permutation.
inline int parity(std::vector<int> permutation) {
    int sign = 1;
    for (std::size_t k = 0; k < permutation.size(); ++k)
        while (permutation[k] != static_cast<int>(k)) {
            std::swap(permutation[k], permutation[static_cast<std::size_t>(permutation[k])]);
            sign = -sign;
        }
    return sign;
}

// Chooses the order of elimination from the values of A.
template <class Real>
void choose_order(SparseLU<Real>& lu, const Matrix<Real>& A) {
    const auto n = static_cast<std::size_t>(lu.size);
    ++lu.orders;
    lu.row.resize(n);
    lu.col.resize(n);
    lu.filled = lu.pattern;
    for (std::size_t i = 0; i < n; ++i) {
        lu.row[i] = lu.col[i] = static_cast<int>(i);
        for (std::size_t j = 0; j < n; ++j)
            lu.W[i * n + j] = lu.pattern[i * n + j]
                                  ? A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j))
                                  : Real(0);
    }
    // What is still to go is the block right and below of (k, k).
    const auto measure_column = [&](std::size_t c, std::size_t k) {
        lu.in_column[c] = 0;
        lu.largest[c] = 0;
        for (std::size_t r = k; r < n; ++r) {
            if (!lu.filled[r * n + c]) continue;
            ++lu.in_column[c];
            lu.largest[c] = std::max(lu.largest[c], std::abs(lu.W[r * n + c]));
        }
    };
    for (std::size_t k = 0; k < n; ++k) {
        measure_column(k, 0);
        lu.in_row[k] = std::count(&lu.filled[k * n], &lu.filled[k * n] + n, 1);
    }
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t best_r = k, best_c = k;
        long best_fill = std::numeric_limits<long>::max();
        Real best_value = 0;
        const long fewest = *std::min_element(&lu.in_column[k], &lu.in_column[k] + (n - k)) - 1;
        for (std::size_t r = k; r < n; ++r) {
            const long others = lu.in_row[r] - 1;
            if (others * fewest > best_fill) continue;
            const char* const filled = &lu.filled[r * n];
            for (std::size_t c = k; c < n; ++c) {
                if (!filled[c]) continue;
                const long fill = others * (lu.in_column[c] - 1);
                if (fill > best_fill) continue;
                const Real value = std::abs(lu.W[r * n + c]);
                if (!(value > 0 && value >= static_cast<Real>(lu.least_pivot) * lu.largest[c]) ||
                    (fill == best_fill && !(value > best_value)))
                    continue;
                best_fill = fill;
                best_value = value;
                best_r = r;
                best_c = c;
            }
        }
        const auto swap_entries = [&](auto& values) {
            if (best_r != k) std::swap_ranges(&values[k * n], &values[k * n] + n, &values[best_r * n]);
            for (std::size_t r = 0; r < n; ++r) std::swap(values[r * n + k], values[r * n + best_c]);
        };
        swap_entries(lu.W);
        swap_entries(lu.filled);
        std::swap(lu.row[k], lu.row[best_r]);
        std::swap(lu.in_row[k], lu.in_row[best_r]);
        std::swap(lu.col[k], lu.col[best_c]);
        std::swap(lu.in_column[k], lu.in_column[best_c]);
        std::swap(lu.largest[k], lu.largest[best_c]);
        for (std::size_t r = k + 1; r < n; ++r) {
            if (!lu.filled[r * n + k]) continue;
            --lu.in_row[r];
            if (!(best_value > 0)) continue;  // singular, which the pivots will tell
            const Real l = lu.W[r * n + k] / lu.W[k * n + k];
            for (std::size_t c = k + 1; c < n; ++c) {
                if (!lu.filled[k * n + c]) continue;
                if (!lu.filled[r * n + c]) {
                    lu.filled[r * n + c] = 1;
                    ++lu.in_row[r];
                }
                lu.W[r * n + c] -= l * lu.W[k * n + c];
            }
        }
        for (std::size_t c = k + 1; c < n; ++c)
            if (lu.filled[k * n + c]) measure_column(c, k + 1);
    }
    for (auto* list : {&lu.source, &lu.to, &lu.below, &lu.right, &lu.first_below, &lu.first_right})
        list->clear();
    for (std::size_t k = 0; k < n; ++k) {
        lu.first_below.push_back(static_cast<int>(lu.below.size()));
        lu.first_right.push_back(static_cast<int>(lu.right.size()));
        for (std::size_t o = k + 1; o < n; ++o) {
            if (lu.filled[o * n + k]) lu.below.push_back(static_cast<int>(o));
            if (lu.filled[k * n + o]) lu.right.push_back(static_cast<int>(o));
        }
        for (std::size_t c = 0; c < n; ++c) {
            const auto i = static_cast<std::size_t>(lu.row[k]), j = static_cast<std::size_t>(lu.col[c]);
            if (!lu.pattern[i * n + j]) continue;
            lu.source.push_back(static_cast<int>(j * n + i));
            lu.to.push_back(static_cast<int>(k * n + c));
        }
    }
    lu.first_below.push_back(static_cast<int>(lu.below.size()));
    lu.first_right.push_back(static_cast<int>(lu.right.size()));
    lu.parity = parity(lu.row) * parity(lu.col);
}

// Eliminates in the order chosen. Returns the smallest over the largest pivot, 0 where one is exactly zero,
// NaN for a matrix that is not finite; `largest` gets the largest multiplier.
template <class Real>
Real eliminate(SparseLU<Real>& lu, const Matrix<Real>& A, Real& largest) {
    const auto n = static_cast<std::size_t>(lu.size);
    Real* const W = lu.W.data();
    std::fill(lu.W.begin(), lu.W.end(), Real(0));
    Real sum = 0;
    for (std::size_t e = 0; e < lu.source.size(); ++e) {
        const Real value = A.data()[lu.source[e]];
        W[lu.to[e]] = value;
        sum += std::abs(value);
    }
    if (!std::isfinite(sum)) return std::numeric_limits<Real>::quiet_NaN();
    Real least_pivot = std::numeric_limits<Real>::infinity(), largest_pivot = 0;
    largest = 0;
    lu.orientation = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const Real* const U = W + k * n;
        const Real size = std::abs(U[k]);
        if (!(size > 0)) return std::isnan(size) ? size : Real(0);
        least_pivot = std::min(least_pivot, size);
        largest_pivot = std::max(largest_pivot, size);
        lu.inverse[k] = 1 / U[k];
        const int* const right = lu.right.data() + lu.first_right[k];
        const int entries = lu.first_right[k + 1] - lu.first_right[k];
        for (int b = lu.first_below[k]; b < lu.first_below[k + 1]; ++b) {
            Real* const into = W + static_cast<std::size_t>(lu.below[static_cast<std::size_t>(b)]) * n;
            const Real l = into[k] *= lu.inverse[k];
            largest = std::max(largest, std::abs(l));
            for (int e = 0; e < entries; ++e) into[right[e]] -= l * U[right[e]];
        }
    }
    lu.orientation = lu.parity;
    for (std::size_t k = 0; k < n; ++k)
        if (lu.inverse[k] < 0) lu.orientation = -lu.orientation;
    return least_pivot / largest_pivot;
}

// log2 |det| of the last matrix factorised.
template <class Real>
Real log_determinant(const SparseLU<Real>& lu) {
    Real sum = 0;
    for (const Real inverse : lu.inverse) sum -= std::log2(std::abs(inverse));
    return sum;
}

// Factorises A, in the order of last time if that still serves. Returns the smallest over the largest pivot.
// Nothing is allocated.
template <class Real>
Real factorise(SparseLU<Real>& lu, const Matrix<Real>& A) {
    Real largest = 0;
    if (lu.orders > 0) {
        const Real ratio = eliminate(lu, A, largest);
        if (std::isnan(ratio) || (ratio > 0 && largest <= static_cast<Real>(lu.largest_multiplier)))
            return ratio;
    }
    choose_order(lu, A);
    return eliminate(lu, A, largest);
}

// x with A x = b, for the last matrix factorised. Nothing is allocated.
template <class Real>
void solve(SparseLU<Real>& lu, const Real* b, Real* x) {
    const auto n = static_cast<std::size_t>(lu.size);
    Real* const y = lu.y.data();
    const Real* const W = lu.W.data();
    for (std::size_t k = 0; k < n; ++k) y[k] = b[lu.row[k]];
    for (std::size_t k = 0; k < n; ++k) {
        const Real known = y[k];
        if (known == Real(0)) continue;
        for (int e = lu.first_below[k]; e < lu.first_below[k + 1]; ++e) {
            const auto i = static_cast<std::size_t>(lu.below[static_cast<std::size_t>(e)]);
            y[i] -= W[i * n + k] * known;
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        Real left = y[k];
        for (int e = lu.first_right[k]; e < lu.first_right[k + 1]; ++e) {
            const auto j = static_cast<std::size_t>(lu.right[static_cast<std::size_t>(e)]);
            left -= W[k * n + j] * y[j];
        }
        y[k] = left * lu.inverse[k];
    }
    for (std::size_t k = 0; k < n; ++k) x[lu.col[k]] = y[k];
}

}  // namespace elastocheck::recursive
