// Sparse LU factorisation with a fixed pattern and a reused pivot order, in three calls:
//
//   analyse     pattern and typical values → elimination order and fill, once per model
//   factorise   values → factors, in that order
//   solve       right-hand side → solution
//
// The pattern of eq. (24) depends on the connections of the model (pattern.hpp). The pivot order is
// chosen once (pivot_search.hpp), and afterwards only structural non-zeros are stored and updated.
// Row i of L and U in pivot order follows from row i of A and the rows of U above it,
//
//   w ← A_i,   l_ik = w_k / u_kk,   w ← w - l_ik U_k   for every k < i in the pattern,   U_i ← w
//
// in one full-length row w. The order is kept while no multiplier of L exceeds a hundred (or the
// caller's `largest_multiplier`); beyond it a new order is chosen from the current values.
//
// Values are those of the pattern's entries, in the order of the pattern.
#pragma once

#include <cstring>

#include "recursive/linear_algebra/pivot_search.hpp"

namespace elastocheck::recursive {

// Elimination order and fill, by rows of L and U.
struct Elimination {
    Pattern pattern;
    std::vector<int> row, col;        // the k-th pivot is A(row[k], col[k])
    std::vector<int> row_of, col_of;  // ... and the inverse permutations
    // Per row i, as column numbers: the entries of A with their positions in the pattern; the
    // entries that are fill only; the entries of L, and of U beside the pivot, both ascending.
    std::vector<int> to, entry, first_entry, fill, first_fill, left, first_left, right, first_right;
    // Per column k of L: the rows, and the positions of these entries in L.
    std::vector<int> below, place, first_below;
    int parity = 1;  // sign of the product of the permutations `row` and `col`: +1 or -1
};

template <class Real>
struct SparseLU {
    Elimination order;
    std::vector<Real> L, U;            // without the diagonals, in the order of `left` and `right`
    std::vector<Real> inverse;         // 1 / pivots
    std::vector<Real> w;               // the row being eliminated
    std::vector<Real> y;               // the solution in pivot order
    std::vector<Real> known, unknown;  // workspace of solve_unit, zero between calls:
    std::vector<int> reached;          // the non-zeros found so far
    std::vector<char> queued;          // 1: queued
    PivotSearch<Real> search;
    int orders = 0;       // number of orders chosen by this object
    int orientation = 0;  // sign of the determinant of the last matrix factorised

    double largest_multiplier = 100;  // limit above which a new order is chosen
    std::size_t size() const { return static_cast<std::size_t>(order.pattern.size); }
};

// Allocates the workspace of elimination and solution.
template <class Real>
void reserve(SparseLU<Real>& lu) {
    const std::size_t n = lu.size();
    for (auto* list : {&lu.inverse, &lu.w, &lu.y, &lu.known, &lu.unknown}) list->assign(n, 0);
    lu.queued.assign(n, 0);
    lu.reached.reserve(2 * n);
}
// ... and the factors.
template <class Real>
void reserve_factors(SparseLU<Real>& lu) {
    lu.L.resize(lu.order.left.size());
    lu.U.resize(lu.order.right.size());
}

// Sign of a permutation: +1 if even, -1 if odd.
inline int parity(std::vector<int>& permutation, std::vector<char>& seen) {
    int sign = 1;
    std::fill(seen.begin(), seen.end(), 0);
    for (std::size_t k = 0; k < permutation.size(); ++k)
        for (auto at = static_cast<std::size_t>(permutation[k]); !seen[k] && at != k;
             at = static_cast<std::size_t>(permutation[at])) {
            seen[at] = 1;
            sign = -sign;
        }
    return sign;
}

// Sorts column numbers into rows (or row numbers into columns) by counting: each(put) calls
// put(row, column, which) for all entries, and runs twice. The order within a row is that of the
// calls.
template <class Each>
void sort_into_rows(std::size_t n, std::vector<int>& first, std::vector<int>& column,
                    std::vector<int>* which, Each&& each) {
    first.assign(n + 1, 0);
    each([&](int row, int, int) { ++first[static_cast<std::size_t>(row) + 1]; });
    for (std::size_t k = 0; k < n; ++k) first[k + 1] += first[k];
    column.resize(static_cast<std::size_t>(first[n]));
    if (which != nullptr) which->resize(column.size());
    each([&](int row, int c, int number) {
        const auto at = static_cast<std::size_t>(first[static_cast<std::size_t>(row)]++);
        column[at] = c;
        if (which != nullptr) (*which)[at] = number;
    });
    for (std::size_t k = n; k > 0; --k) first[k] = first[k - 1];
    first[0] = 0;
}

// Stores the rows of L and U for the pivots found by `search`.
template <class Real>
void lay_out(SparseLU<Real>& lu) {
    const std::size_t n = lu.size();
    Elimination& order = lu.order;
    const PivotSearch<Real>& found = lu.search;
    order.row = found.row;
    order.col = found.col;
    order.row_of.resize(n);
    order.col_of.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
        order.row_of[static_cast<std::size_t>(order.row[k])] = static_cast<int>(k);
        order.col_of[static_cast<std::size_t>(order.col[k])] = static_cast<int>(k);
    }
    const auto in = [](const std::vector<int>& first, std::size_t k, auto&& visit) {
        for (int e = first[k]; e < first[k + 1]; ++e) visit(static_cast<std::size_t>(e));
    };
    // Two counting sorts of `below` and `right`, from numbers of A, put the columns of each row in
    // order.
    const auto of_row = [&](std::size_t e) {
        return order.row_of[static_cast<std::size_t>(found.below[e])];
    };
    const auto of_col = [&](std::size_t e) {
        return order.col_of[static_cast<std::size_t>(found.right[e])];
    };
    sort_into_rows(n, order.first_left, order.left, nullptr, [&](auto&& put) {
        for (std::size_t k = 0; k < n; ++k)
            in(found.first_below, k,
               [&](std::size_t e) { put(of_row(e), static_cast<int>(k), 0); });
    });
    sort_into_rows(n, order.first_below, order.below, &order.place, [&](auto&& put) {
        for (std::size_t i = 0; i < n; ++i)
            in(order.first_left, i, [&](std::size_t e) {
                put(order.left[e], static_cast<int>(i), static_cast<int>(e));
            });
    });
    // columns of U, temporarily
    sort_into_rows(n, order.first_fill, order.fill, nullptr, [&](auto&& put) {
        for (std::size_t k = 0; k < n; ++k)
            in(found.first_right, k,
               [&](std::size_t e) { put(of_col(e), static_cast<int>(k), 0); });
    });
    sort_into_rows(n, order.first_right, order.right, nullptr, [&](auto&& put) {
        for (std::size_t j = 0; j < n; ++j)
            in(order.first_fill, j,
               [&](std::size_t e) { put(order.fill[e], static_cast<int>(j), 0); });
    });
    const Pattern& pattern = order.pattern;
    sort_into_rows(n, order.first_entry, order.to, &order.entry, [&](auto&& put) {
        for (std::size_t j = 0; j < n; ++j)
            in(pattern.first, j, [&](std::size_t e) {
                put(order.row_of[static_cast<std::size_t>(pattern.row[e])], order.col_of[j],
                    static_cast<int>(e));
            });
    });
    order.fill.clear();
    order.first_fill.assign(1, 0);
    std::vector<char>& there = lu.queued;
    for (std::size_t i = 0; i < n; ++i) {
        const auto mark = [&](char value) {
            in(order.first_entry, i,
               [&](std::size_t e) { there[static_cast<std::size_t>(order.to[e])] = value; });
        };
        const auto fills = [&](int column) {
            if (!there[static_cast<std::size_t>(column)]) order.fill.push_back(column);
        };
        mark(1);
        in(order.first_left, i, [&](std::size_t e) { fills(order.left[e]); });
        fills(static_cast<int>(i));
        in(order.first_right, i, [&](std::size_t e) { fills(order.right[e]); });
        mark(0);
        order.first_fill.push_back(static_cast<int>(order.fill.size()));
    }
    order.parity = parity(order.row, there) * parity(order.col, there);
    std::fill(there.begin(), there.end(), 0);
    reserve_factors(lu);
}

// Chooses the elimination order from `values`.
template <class Real>
void choose_order(SparseLU<Real>& lu, const Real* values) {
    ++lu.orders;
    search_pivots(lu.search, lu.order.pattern, values);
    lay_out(lu);
}

// Prepares for matrices of this pattern, with the elimination order chosen from `values`.
template <class Real>
void analyse(SparseLU<Real>& lu, const Pattern& pattern, const Real* values) {
    lu.order = {};
    lu.order.pattern = pattern;
    lu.orders = 0;
    reserve(lu);
    choose_order(lu, values);
}
// The same with a given order, for matrices of the same pattern in any arithmetic.
template <class Real>
void analyse(SparseLU<Real>& lu, const Elimination& order) {
    lu.order = order;
    lu.orders = 0;
    reserve(lu);
    reserve_factors(lu);
}

// Eliminates in the chosen order. Returns the ratio of the smallest to the largest pivot, 0 for a
// zero pivot, NaN for a matrix that is not finite; `largest` returns the largest multiplier.
template <class Real>
Real eliminate(SparseLU<Real>& lu, const Real* values, Real& largest) {
    const std::size_t n = lu.size();
    const Elimination& order = lu.order;
    Real *const w = lu.w.data(), *const L = lu.L.data(), *const U = lu.U.data(),
                *const inverse = lu.inverse.data();
    const int *const to = order.to.data(), *const entry = order.entry.data(),
                     *const fill = order.fill.data(), *const left = order.left.data(),
                     *const right = order.right.data(),
                     *const first_right = order.first_right.data();
    Real sum = 0, least_pivot = std::numeric_limits<Real>::infinity(), largest_pivot = 0;
    int orientation = order.parity;
    largest = 0;
    lu.orientation = 0;
    for (std::size_t i = 0; i < n; ++i) {
        for (int e = order.first_fill[i]; e < order.first_fill[i + 1]; ++e) w[fill[e]] = 0;
        for (int e = order.first_entry[i]; e < order.first_entry[i + 1]; ++e) {
            const Real value = values[entry[e]];
            w[to[e]] = value;
            sum += std::abs(value);
        }
        for (int e = order.first_left[i]; e < order.first_left[i + 1]; ++e) {
            const int k = left[e];
            const Real l = L[e] = w[k] * inverse[k];
            largest = std::max(largest, std::abs(l));
            for (int r = first_right[k]; r < first_right[k + 1]; ++r) w[right[r]] -= l * U[r];
        }
        for (int r = first_right[i]; r < first_right[i + 1]; ++r) U[r] = w[right[r]];
        const Real size = std::abs(w[i]);
        if (!(size > 0)) {  // the remaining rows may still hold a NaN
            for (std::size_t e = 0; e < order.pattern.entries(); ++e) sum += std::abs(values[e]);
            return std::isnan(size) || !std::isfinite(sum) ? std::numeric_limits<Real>::quiet_NaN()
                                                           : Real(0);
        }
        least_pivot = std::min(least_pivot, size);
        largest_pivot = std::max(largest_pivot, size);
        inverse[i] = 1 / w[i];
        if (w[i] < 0) orientation = -orientation;
    }
    if (!std::isfinite(sum)) return std::numeric_limits<Real>::quiet_NaN();
    lu.orientation = orientation;
    return least_pivot / largest_pivot;
}

// log2 |det| of the last matrix factorised.
template <class Real>
Real log_determinant(const SparseLU<Real>& lu) {
    Real sum = 0;
    for (const Real inverse : lu.inverse) sum -= std::log2(std::abs(inverse));
    return sum;
}

// Factorises the matrix with these values, in the last order if its multipliers stay small. Returns
// the ratio of the smallest to the largest pivot. Allocates only when a new order is chosen.
template <class Real>
Real factorise(SparseLU<Real>& lu, const Real* values) {
    Real largest = 0;
    const Real ratio = eliminate(lu, values, largest);
    if (std::isnan(ratio) || (ratio > 0 && largest <= static_cast<Real>(lu.largest_multiplier)))
        return ratio;
    choose_order(lu, values);
    return eliminate(lu, values, largest);
}

// Solves A x = b with the last factors. Allocates nothing.
template <class Real>
void solve(SparseLU<Real>& lu, const Real* b, Real* x) {
    const std::size_t n = lu.size();
    const Elimination& order = lu.order;
    Real* const y = lu.y.data();
    const Real *const L = lu.L.data(), *const U = lu.U.data();
    const int *const left = order.left.data(), *const right = order.right.data();
    for (std::size_t i = 0; i < n; ++i) {
        Real sum = b[order.row[i]];
        for (int e = order.first_left[i]; e < order.first_left[i + 1]; ++e)
            sum -= L[e] * y[left[e]];
        y[i] = sum;
    }
    for (std::size_t k = n; k-- > 0;) {
        Real sum = y[k];
        for (int e = order.first_right[k]; e < order.first_right[k + 1]; ++e)
            sum -= U[e] * y[right[e]];
        x[order.col[k]] = y[k] = sum * lu.inverse[k];
    }
}

// Solves A x = e_j for the unknowns `wanted` only. Forward substitution visits only the rows
// reached from row j, back substitution only the rows that the wanted unknowns depend on. Values
// below rounding relative to the start are not propagated. The work is small where x has few
// non-zeros (a motion of one body).
template <class Real>
void solve_unit(SparseLU<Real>& lu, int j, const int* wanted, int count, Real* x) {
    const Elimination& order = lu.order;
    const Real rounding = 4 * std::numeric_limits<Real>::epsilon();
    const auto n = static_cast<int>(lu.size());
    // local pointers: a store to `queued`, of characters, might change any other
    Real *const known = lu.known.data(), *const unknown = lu.unknown.data();
    char* const queued = lu.queued.data();
    const Real *const L = lu.L.data(), *const U = lu.U.data();
    const int *const below = order.below.data(), *const place = order.place.data(),
                     *const right = order.right.data(),
                     *const first_below = order.first_below.data(),
                     *const first_right = order.first_right.data(),
                     *const col_of = order.col_of.data();
    const auto next = [&](int k) {  // next queued index from k on, which mostly is near
        for (const int near = std::min(k + 8, n); k < near; ++k)
            if (queued[k]) return k;
        const void* const found = std::memchr(queued + k, 1, static_cast<std::size_t>(n - k));
        return found == nullptr ? n : static_cast<int>(static_cast<const char*>(found) - queued);
    };
    const auto reach = [&](int k) {
        queued[k] = 0;
        lu.reached.push_back(k);
    };
    const int start = order.row_of[static_cast<std::size_t>(j)];
    int last = -1;
    lu.reached.clear();
    known[start] = 1;
    queued[start] = 1;
    for (int k = start; k < n; k = next(k + 1)) {
        reach(k);
        const Real y = known[k];
        if (!(std::abs(y) > rounding) && !std::isnan(y)) {
            known[k] = 0;
            continue;
        }
        last = k;
        for (int e = first_below[k]; e < first_below[k + 1]; ++e) {
            known[below[e]] -= L[place[e]] * y;
            queued[below[e]] = 1;
        }
    }
    const std::size_t forward = lu.reached.size();
    int k = n;
    for (int c = 0; c < count; ++c)
        if (const int own = col_of[wanted[c]]; own <= last) {
            queued[own] = 1;
            k = std::min(k, own);
        }
    for (; k < n; k = next(k + 1)) {
        reach(k);
        for (int e = first_right[k]; e < first_right[k + 1]; ++e)
            if (right[e] <= last) queued[right[e]] = 1;
    }
    for (std::size_t r = lu.reached.size(); r-- > forward;) {
        const int own = lu.reached[r];
        Real sum = known[own];
        for (int e = first_right[own]; e < first_right[own + 1]; ++e)
            sum -= U[e] * unknown[right[e]];
        unknown[own] = sum * lu.inverse[static_cast<std::size_t>(own)];
    }
    for (int c = 0; c < count; ++c) x[c] = unknown[col_of[wanted[c]]];
    for (const int own : lu.reached) known[own] = unknown[own] = 0;
}

// Instantiated in stepping/sweep_double.cpp.
extern template void analyse<double>(SparseLU<double>&, const Pattern&, const double*);
extern template double factorise<double>(SparseLU<double>&, const double*);
extern template void solve<double>(SparseLU<double>&, const double*, double*);
extern template void solve_unit<double>(SparseLU<double>&, int, const int*, int, double*);

}  // namespace elastocheck::recursive
