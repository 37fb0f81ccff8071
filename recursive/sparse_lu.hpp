// LU factors of a matrix whose zeros never move and whose pivots hardly do, behind three calls:
//
//   analyse     pattern and a typical matrix → order of elimination and what it fills in, once for a model
//   factorise   values → factors, in that order
//   solve       right-hand side → solution
//
// Which entries of eq. (24) can be other than zero is decided by who is connected to whom (pattern.hpp), so
// the order is chosen once, and afterwards only what can be other than zero is touched. Chosen is, step by
// step, the pivot that fills in least (Markowitz: smallest (entries in its row - 1)(entries in its column -
// 1)) among those no smaller than a tenth of their column. The choice stands while no multiplier of L exceeds
// a hundred (or what the caller bears); when one does, the order is chosen anew from the values of the moment.
//
// Values are those of the pattern's entries, in its order.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "recursive/state.hpp"

namespace elastocheck::recursive {

// Which entries of a square matrix may be other than zero, column by column, rows rising.
struct Pattern {
    int size = 0;
    std::vector<int> first;  // of every column, and where the last one ends [size + 1]
    std::vector<int> row;    // of every entry

    std::size_t entries() const { return row.size(); }
};
inline bool has_entry(const Pattern& pattern, int i, int j) {
    const auto column = pattern.row.begin() + pattern.first[static_cast<std::size_t>(j)];
    return std::binary_search(column, pattern.row.begin() + pattern.first[static_cast<std::size_t>(j) + 1],
                              i);
}

// The order of elimination, and what it fills in. W is the matrix in the order of the pivots, row by row.
struct Elimination {
    Pattern pattern;
    std::vector<int> row, col;  // the k-th pivot is A(row[k], col[k])
    std::vector<int> to;        // where in W an entry goes
    std::vector<int> fill;      // the places of W that elimination alone fills
    // Entries of the k-th column of L and row of U beside the pivot, as numbers of rows and columns of W:
    // below[first_below[k] ... first_below[k+1]), right[...] likewise.
    std::vector<int> below, first_below, right, first_right;
    int parity = 1;  // of the two permutations `row` and `col` together: +1 or -1
};

template <class Real>
struct SparseLU {
    Elimination order;
    std::vector<Real> W;                  // L (unit diagonal) and U
    std::vector<Real> inverse;            // 1 / pivots
    std::vector<Real> y;                  // the solution in the order of the pivots
    std::vector<char> filled;             // while the order is chosen: pattern of L + U ...
    std::vector<long> in_row, in_column;  // ... how many entries a row and a column still have
    std::vector<Real> largest;            // ... and the largest of a column
    int orders = 0;                       // how often the order was chosen here
    int orientation = 0;                  // sign of the determinant of the last matrix factorised

    static constexpr double least_pivot = 0.1;
    double largest_multiplier = 100;  // until the order is chosen anew
    std::size_t size() const { return static_cast<std::size_t>(order.pattern.size); }
};

// Room for everything, so that nothing is allocated when an order has to be chosen anew.
template <class Real>
void reserve(SparseLU<Real>& lu) {
    const std::size_t n = lu.size();
    lu.filled.assign(n * n, 0);
    lu.W.assign(n * n, 0);
    for (auto* list : {&lu.inverse, &lu.y, &lu.largest}) list->assign(n, 0);
    for (auto* list : {&lu.in_row, &lu.in_column}) list->assign(n, 0);
    for (auto* list : {&lu.order.row, &lu.order.col, &lu.order.first_below, &lu.order.first_right})
        list->reserve(n + 1);
    for (auto* list : {&lu.order.below, &lu.order.right, &lu.order.fill}) list->reserve(n * n);
    lu.order.to.reserve(lu.order.pattern.entries());
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

// Chooses the order of elimination from `values`.
template <class Real>
void choose_order(SparseLU<Real>& lu, const Real* values) {
    const std::size_t n = lu.size();
    Elimination& order = lu.order;
    const Pattern& pattern = order.pattern;
    ++lu.orders;
    order.row.resize(n);
    order.col.resize(n);
    std::fill(lu.filled.begin(), lu.filled.end(), 0);
    std::fill(lu.W.begin(), lu.W.end(), Real(0));
    for (std::size_t j = 0; j < n; ++j) {
        order.row[j] = order.col[j] = static_cast<int>(j);
        for (int e = pattern.first[j]; e < pattern.first[j + 1]; ++e) {
            const std::size_t at = static_cast<std::size_t>(pattern.row[static_cast<std::size_t>(e)]) * n + j;
            lu.filled[at] = 1;
            lu.W[at] = values[e];
        }
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
        const auto swap_entries = [&](auto& entries) {
            if (best_r != k) std::swap_ranges(&entries[k * n], &entries[k * n] + n, &entries[best_r * n]);
            for (std::size_t r = 0; r < n; ++r) std::swap(entries[r * n + k], entries[r * n + best_c]);
        };
        swap_entries(lu.W);
        swap_entries(lu.filled);
        std::swap(order.row[k], order.row[best_r]);
        std::swap(lu.in_row[k], lu.in_row[best_r]);
        std::swap(order.col[k], order.col[best_c]);
        std::swap(lu.in_column[k], lu.in_column[best_c]);
        std::swap(lu.largest[k], lu.largest[best_c]);
        // A singular matrix is told by its pivots; the next one of its pattern need not be, and fills in all
        // the same.
        lu.filled[k * n + k] = 1;
        for (std::size_t r = k + 1; r < n; ++r) {
            if (!lu.filled[r * n + k]) continue;
            --lu.in_row[r];
            const Real l = best_value > 0 ? lu.W[r * n + k] / lu.W[k * n + k] : Real(0);
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
    for (auto* list : {&order.below, &order.right, &order.first_below, &order.first_right}) list->clear();
    std::vector<long>&row_of = lu.in_row, &column_of = lu.in_column;  // of W, by row and column of A
    for (std::size_t k = 0; k < n; ++k) {
        order.first_below.push_back(static_cast<int>(order.below.size()));
        order.first_right.push_back(static_cast<int>(order.right.size()));
        for (std::size_t o = k + 1; o < n; ++o) {
            if (lu.filled[o * n + k]) order.below.push_back(static_cast<int>(o));
            if (lu.filled[k * n + o]) order.right.push_back(static_cast<int>(o));
        }
        row_of[static_cast<std::size_t>(order.row[k])] = static_cast<long>(k);
        column_of[static_cast<std::size_t>(order.col[k])] = static_cast<long>(k);
    }
    order.first_below.push_back(static_cast<int>(order.below.size()));
    order.first_right.push_back(static_cast<int>(order.right.size()));
    order.to.resize(pattern.entries());
    for (std::size_t j = 0; j < n; ++j)
        for (auto e = static_cast<std::size_t>(pattern.first[j]);
             e < static_cast<std::size_t>(pattern.first[j + 1]); ++e) {
            const auto at = static_cast<std::size_t>(row_of[static_cast<std::size_t>(pattern.row[e])]) * n +
                            static_cast<std::size_t>(column_of[j]);
            order.to[e] = static_cast<int>(at);
            lu.filled[at] = 0;
        }
    order.fill.clear();
    for (std::size_t at = 0; at < n * n; ++at)
        if (lu.filled[at]) order.fill.push_back(static_cast<int>(at));
    order.parity = parity(order.row) * parity(order.col);
}

// Makes everything ready for matrices of this pattern, in the order of elimination that suits `values`.
template <class Real>
void analyse(SparseLU<Real>& lu, const Pattern& pattern, const Real* values) {
    lu.order = {};
    lu.order.pattern = pattern;
    lu.orders = 0;
    reserve(lu);
    choose_order(lu, values);
}
// The same in an order chosen before, for matrices of the same pattern in any arithmetic.
template <class Real>
void analyse(SparseLU<Real>& lu, const Elimination& order) {
    lu.order = order;
    lu.orders = 0;
    reserve(lu);
}

// Eliminates in the order chosen. Returns the smallest over the largest pivot, 0 where one is exactly zero,
// NaN for a matrix that is not finite; `largest` gets the largest multiplier.
template <class Real>
Real eliminate(SparseLU<Real>& lu, const Real* values, Real& largest) {
    const std::size_t n = lu.size();
    Real* const W = lu.W.data();
    for (const int at : lu.order.fill) W[at] = 0;
    Real sum = 0;
    const int* const to = lu.order.to.data();
    for (std::size_t e = 0; e < lu.order.to.size(); ++e) {
        W[to[e]] = values[e];
        sum += std::abs(values[e]);
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
        const int* const right = lu.order.right.data() + lu.order.first_right[k];
        const int entries = lu.order.first_right[k + 1] - lu.order.first_right[k];
        for (int b = lu.order.first_below[k]; b < lu.order.first_below[k + 1]; ++b) {
            Real* const into = W + static_cast<std::size_t>(lu.order.below[static_cast<std::size_t>(b)]) * n;
            const Real l = into[k] *= lu.inverse[k];
            largest = std::max(largest, std::abs(l));
            for (int e = 0; e < entries; ++e) into[right[e]] -= l * U[right[e]];
        }
    }
    lu.orientation = lu.order.parity;
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

// Factorises the matrix with these values, in the order of last time if that still serves. Returns the
// smallest over the largest pivot. Nothing is allocated.
template <class Real>
Real factorise(SparseLU<Real>& lu, const Real* values) {
    Real largest = 0;
    const Real ratio = eliminate(lu, values, largest);
    if (std::isnan(ratio) || (ratio > 0 && largest <= static_cast<Real>(lu.largest_multiplier))) return ratio;
    choose_order(lu, values);
    return eliminate(lu, values, largest);
}

// x with A x = b, for the last matrix factorised. Nothing is allocated.
template <class Real>
void solve(SparseLU<Real>& lu, const Real* b, Real* x) {
    const std::size_t n = lu.size();
    const Elimination& order = lu.order;
    Real* const y = lu.y.data();
    const Real* const W = lu.W.data();
    for (std::size_t k = 0; k < n; ++k) y[k] = b[order.row[k]];
    for (std::size_t k = 0; k < n; ++k) {
        const Real known = y[k];
        if (known == Real(0)) continue;
        for (int e = order.first_below[k]; e < order.first_below[k + 1]; ++e) {
            const auto i = static_cast<std::size_t>(order.below[static_cast<std::size_t>(e)]);
            y[i] -= W[i * n + k] * known;
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        Real left = y[k];
        for (int e = order.first_right[k]; e < order.first_right[k + 1]; ++e) {
            const auto j = static_cast<std::size_t>(order.right[static_cast<std::size_t>(e)]);
            left -= W[k * n + j] * y[j];
        }
        y[k] = left * lu.inverse[k];
    }
    for (std::size_t k = 0; k < n; ++k) x[order.col[k]] = y[k];
}

}  // namespace elastocheck::recursive
