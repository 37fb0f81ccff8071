// Sparse LU factorisation with a fixed pattern and a reused pivot order, in three calls:
//
//   analyse     pattern and typical values → elimination order and fill, once per model
//   factorise   values → factors, in that order
//   solve       right-hand side → solution
//
// The pattern of eq. (24) depends on the connections of the model (pattern.hpp). The pivot order is
// chosen once (pivot_search.hpp), and afterwards only structural non-zeros are stored and updated,
// in place: for the k-th pivot, row U_k right of it, and every row i with an entry below it,
//
//   l_ik = a_ik / u_kk,   A_i ← A_i - l_ik U_k
//
// A row is stored in runs of adjacent columns, so that the second line is a sum of short vectors at
// positions known from the pattern. Gaps of a few columns are stored as zeros, and so is one more
// column after every run, which makes the number of columns of a run even where that is needed. The
// order is kept while no multiplier of L exceeds a hundred (or the caller's `largest_multiplier`);
// beyond it a new order is chosen from the current values.
//
// Entry e of the pattern is values[source[e]] · factor[e], so that the caller's matrix needs no
// copy.
#pragma once

#include <cstring>
#include <memory>
#include <numeric>
#include <span>

#include "recursive/linear_algebra/pivot_search.hpp"

namespace elastocheck::recursive {

// Elimination order, and the places of L and U in one array: their rows one after the other. Shared
// by the matrices that are eliminated in it.
struct Elimination {
    struct Run {  // adjacent columns of a row, and the place of the first
        int column, length, at;
    };
    struct Below {  // an entry of L and its place
        int row, at;
    };
    Pattern pattern;
    std::vector<int> row, col;        // the k-th pivot is A(row[k], col[k])
    std::vector<int> row_of, col_of;  // ... and the inverse permutations
    std::vector<int> to;              // place of every entry of the pattern in LU
    std::vector<int> column;          // of every place of LU
    std::vector<int> first, pivot;    // place where each row begins, and of its pivot
    // Per row: the runs of U, ascending. Per column k of L: its entries, ascending, and for each of
    // them and each run of U_k the place in its row from which that run is subtracted.
    std::vector<Run> right;
    std::vector<Below> below;
    std::vector<int> target, first_right, first_below;
    std::size_t nonzeros = 0;  // of L and U with the pivots, without the zeros stored for the runs
    int parity = 1;            // sign of the product of the permutations `row` and `col`: +1 or -1
};

using EliminationOrder = std::shared_ptr<const Elimination>;

template <class Real>
struct SparseLU {
    EliminationOrder order = std::make_shared<const Elimination>();
    std::vector<int> source;           // of every entry of the pattern: its position in the values
    std::vector<Real> factor;          // ... and what these are multiplied by
    std::size_t values = 0;            // number of values
    std::vector<Real> LU;              // factors, the diagonal of U included
    std::vector<Real> inverse;         // 1 / pivots
    std::vector<Real> y;               // the solution in pivot order
    std::vector<Real> known, unknown;  // workspace of solve_unit, zero between calls:
    std::vector<int> reached;          // the non-zeros found so far
    std::vector<char> queued;          // 1: queued
    int orders = 0;                    // number of orders chosen by this object
    int orientation = 0;               // sign of the determinant of the last matrix factorised

    double largest_multiplier = 100;  // limit above which a new order is chosen
    std::size_t size() const { return static_cast<std::size_t>(order->pattern.size); }
};

// Allocates the workspace of elimination and solution.
template <class Real>
void reserve(SparseLU<Real>& lu) {
    const std::size_t n = lu.size();
    for (auto* list : {&lu.inverse, &lu.y, &lu.known, &lu.unknown}) list->assign(n, 0);
    lu.queued.assign(n, 0);
    lu.reached.reserve(2 * n);
    lu.LU.assign(lu.order->column.size(), 0);
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
// put(row, column, which) for all entries, and runs twice. The order within a row is that
// of the calls.
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

// Sets the places of row i and appends to `targets` of the pivots above it. `columns`: those of the
// row's entries, fill included, in any order; `L`: those of L, ascending. `place` [n]: returns the
// place of each column of the row.
inline void lay_out_row(Elimination& order, int i, std::vector<int>& columns,
                        std::span<const int> L, std::vector<int>& place,
                        std::vector<std::vector<int>>& targets) {
    constexpr int gap = 2;  // columns stored as zeros to join two runs
    const auto at = [](int k) { return static_cast<std::size_t>(k); };
    const auto runs_of = [&](int k) {
        return std::span(order.right.begin() + order.first_right[at(k)],
                         order.right.begin() + order.first_right[at(k) + 1]);
    };
    for (const int k : L)  // what a run of U_k covers is subtracted here
        for (const auto& run : runs_of(k))
            for (int c = run.column; c < run.column + run.length; ++c) columns.push_back(c);
    std::ranges::sort(columns);
    int last = -1;  // column
    for (const int column : columns) {
        if (column == last) continue;
        const bool joined = last >= 0 && column - last - 1 <= gap;
        if (last >= 0 && !joined) order.column.push_back(i);  // the zero after a run
        for (int c = joined ? last + 1 : column; c <= column; ++c) {
            const auto here = static_cast<int>(order.column.size());
            order.column.push_back(c);
            place[at(c)] = here;
            if (c == i) order.pivot.push_back(here);
            if (c <= i) continue;
            if (!joined || order.right.size() == at(order.first_right.back()))
                order.right.push_back({c, 0, here});
            ++order.right.back().length;
        }
        last = column;
    }
    order.column.push_back(i);
    order.first.push_back(static_cast<int>(order.column.size()));
    order.first_right.push_back(static_cast<int>(order.right.size()));
    for (const int k : L) {
        targets[at(k)].insert(targets[at(k)].end(), {i, place[at(k)]});
        for (const auto& run : runs_of(k)) targets[at(k)].push_back(place[at(run.column)]);
    }
}

// Stores the rows of L and U for the pivots of a search.
template <class Real>
void lay_out(SparseLU<Real>& lu, const PivotSearch<Real>& found) {
    const std::size_t n = lu.size();
    const auto at = [](int k) { return static_cast<std::size_t>(k); };
    const auto laid_out = std::make_shared<Elimination>();
    Elimination& order = *laid_out;
    const Pattern& pattern = order.pattern = lu.order->pattern;
    order.row = found.row;
    order.col = found.col;
    order.row_of.resize(n);
    order.col_of.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
        order.row_of[at(order.row[k])] = static_cast<int>(k);
        order.col_of[at(order.col[k])] = static_cast<int>(k);
    }
    // L by rows and the entries of A by rows, in the numbers of the pivots
    std::vector<int> L, first_L, column, entry, first_entry;
    sort_into_rows(n, first_L, L, nullptr, [&](auto&& put) {
        for (std::size_t k = 0; k < n; ++k)
            for (int e = found.first_below[k]; e < found.first_below[k + 1]; ++e)
                put(order.row_of[at(found.below[at(e)])], static_cast<int>(k), 0);
    });
    sort_into_rows(n, first_entry, column, &entry, [&](auto&& put) {
        for (std::size_t j = 0; j < n; ++j)
            for (int e = pattern.first[j]; e < pattern.first[j + 1]; ++e)
                put(order.row_of[at(pattern.row[at(e)])], order.col_of[j], e);
    });
    order.to.resize(pattern.entries());
    for (auto* list : {&order.first, &order.first_right, &order.first_below}) list->assign(1, 0);
    std::vector<int> place(n), columns;
    std::vector<std::vector<int>> targets(n);
    for (std::size_t i = 0; i < n; ++i) {
        columns.assign(L.begin() + first_L[i], L.begin() + first_L[i + 1]);
        const std::vector<int> left = columns;
        columns.push_back(static_cast<int>(i));
        for (int e = found.first_right[i]; e < found.first_right[i + 1]; ++e)
            columns.push_back(order.col_of[at(found.right[at(e)])]);
        lay_out_row(order, static_cast<int>(i), columns, left, place, targets);
        for (int e = first_entry[i]; e < first_entry[i + 1]; ++e)
            order.to[at(entry[at(e)])] = place[at(column[at(e)])];
    }
    for (std::size_t k = 0; k < n; ++k) {
        const auto runs = at(order.first_right[k + 1] - order.first_right[k]);
        for (auto e = targets[k].begin(); e != targets[k].end();
             e += 2 + static_cast<std::ptrdiff_t>(runs)) {
            order.below.push_back({e[0], e[1]});
            order.target.insert(order.target.end(), e + 2,
                                e + 2 + static_cast<std::ptrdiff_t>(runs));
        }
        order.first_below.push_back(static_cast<int>(order.below.size()));
    }
    order.nonzeros = found.below.size() + found.right.size() + n;
    order.parity = parity(order.row, lu.queued) * parity(order.col, lu.queued);
    std::fill(lu.queued.begin(), lu.queued.end(), 0);
    lu.LU.assign(order.column.size(), 0);
    lu.order = laid_out;
}

// Chooses the elimination order from `values`.
template <class Real>
void choose_order(SparseLU<Real>& lu, const Real* values) {
    ++lu.orders;
    std::vector<Real> entries;
    for (std::size_t e = 0; e < lu.source.size(); ++e)
        entries.push_back(values[lu.source[e]] * lu.factor[e]);
    PivotSearch<Real> search;
    search_pivots(search, lu.order->pattern, entries.data());
    lay_out(lu, search);
}

// Changes to another order for the same pattern; not factorised.
template <class Real>
void take_order(SparseLU<Real>& lu, const EliminationOrder& order) {
    lu.order = order;
    lu.LU.assign(order->column.size(), 0);
}

// Prepares for matrices of this pattern, with the elimination order `like`, if that is of the same
// pattern, else with one chosen from `values`. The caller has set `source` and `factor`.
template <class Real>
void analyse_scaled(SparseLU<Real>& lu, const Pattern& pattern, const Real* values,
                    const EliminationOrder& like = nullptr) {
    const bool known = like != nullptr && like->pattern == pattern;
    lu.order = like;
    if (!known) {
        const auto order = std::make_shared<Elimination>();
        order->pattern = pattern;
        lu.order = order;
    }
    lu.values = 0;
    for (const int at : lu.source)
        lu.values = std::max(lu.values, static_cast<std::size_t>(at) + 1);
    lu.orders = 0;
    reserve(lu);
    if (!known) choose_order(lu, values);
}
// ... for values in the order of the pattern.
template <class Real>
void analyse(SparseLU<Real>& lu, const Pattern& pattern, const Real* values) {
    lu.source.resize(pattern.entries());
    std::iota(lu.source.begin(), lu.source.end(), 0);
    lu.factor.assign(pattern.entries(), Real(1));
    analyse_scaled(lu, pattern, values);
}
// The same factorisation in another arithmetic, with this order; not factorised.
template <class Real, class Other>
void analyse(SparseLU<Real>& lu, const SparseLU<Other>& other) {
    lu.order = other.order;
    lu.source = other.source;
    lu.factor.assign(other.factor.begin(), other.factor.end());
    lu.values = other.values;
    lu.orders = 0;
    reserve(lu);
}

// A_i ← A_i - l_ik U_k for the `rows` rows i with entries of L from `below` on.
template <int rows, class Real>
inline void subtract(Real* LU, const Elimination::Below* below, const int* target,
                     std::span<const Elimination::Run> right, Real inverse, Real& largest) {
    Real l[rows];
    for (int i = 0; i < rows; ++i) {
        l[i] = LU[below[i].at] *= inverse;
        largest = std::max(largest, std::abs(l[i]));
    }
    const auto runs = static_cast<std::ptrdiff_t>(right.size());
    for (const Elimination::Run& run : right) {
        const std::ptrdiff_t even = (run.length + 1) & ~1;
        const Real* const u = LU + run.at + even;
        Real* a[rows];
        for (int i = 0; i < rows; ++i) a[i] = LU + target[i * runs] + even;
        for (std::ptrdiff_t c = -even; c != 0; c += 2) {  // two at a time, for vector instructions
            const Real u_0 = u[c], u_1 = u[c + 1];
            Real left[rows][2];
            for (int i = 0; i < rows; ++i) {
                left[i][0] = a[i][c] - l[i] * u_0;
                left[i][1] = a[i][c + 1] - l[i] * u_1;
            }
            for (int i = 0; i < rows; ++i) {
                a[i][c] = left[i][0];
                a[i][c + 1] = left[i][1];
            }
        }
        ++target;
    }
}

// Eliminates in the chosen order. Returns the ratio of the smallest to the largest pivot, 0 for a
// zero pivot, NaN for a matrix that is not finite; `largest` returns the largest multiplier.
template <class Real>
Real eliminate(SparseLU<Real>& lu, const Real* values, Real& largest) {
    const std::size_t n = lu.size(), entries = lu.source.size();
    const Elimination& order = *lu.order;
    Real* const LU = lu.LU.data();
    largest = 0;
    lu.orientation = 0;
    using Values = Eigen::Map<const Eigen::Array<Real, Eigen::Dynamic, 1>>;
    if (!std::isfinite(Values(values, static_cast<Eigen::Index>(lu.values)).abs().sum()))
        return std::numeric_limits<Real>::quiet_NaN();
    std::memset(LU, 0, order.column.size() * sizeof(Real));
    {
        const int *const to = order.to.data(), *const source = lu.source.data();
        const Real* const factor = lu.factor.data();
        for (std::size_t e = 0; e < entries; ++e) LU[to[e]] = values[source[e]] * factor[e];
    }
    Real min_pivot = std::numeric_limits<Real>::infinity(), largest_pivot = 0, most = 0;
    int orientation = order.parity;
    const int* target = order.target.data();
    const auto *below = order.below.data(), *const first_below = below;
    const auto *run = order.right.data(), *const first_run = run;
    for (std::size_t k = 0; k < n; ++k) {
        const Real pivot = LU[order.pivot[k]], size = std::abs(pivot);
        if (!(size > 0)) {
            largest = most;
            return size;  // zero or NaN
        }
        min_pivot = std::min(min_pivot, size);
        largest_pivot = std::max(largest_pivot, size);
        const Real inverse = lu.inverse[k] = 1 / pivot;
        if (pivot < 0) orientation = -orientation;
        const auto* const end = first_below + order.first_below[k + 1];
        const auto* const last = first_run + order.first_right[k + 1];
        const std::ptrdiff_t runs = last - run;
        const std::span right(run, last);
        for (; end - below >= 4; below += 4, target += 4 * runs)
            subtract<4>(LU, below, target, right, inverse, most);
        for (; end - below >= 2; below += 2, target += 2 * runs)
            subtract<2>(LU, below, target, right, inverse, most);
        if (below != end) {
            subtract<1>(LU, below++, target, right, inverse, most);
            target += runs;
        }
        run = last;
    }
    largest = most;
    lu.orientation = orientation;
    return min_pivot / largest_pivot;
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

// x_k from y_k and the x right of it.
template <class Real>
Real back_substituted(const SparseLU<Real>& lu, std::size_t k, Real y, const Real* x) {
    const Real* const LU = lu.LU.data();
    const int* const column = lu.order->column.data();
    for (int at = lu.order->pivot[k] + 1; at < lu.order->first[k + 1]; ++at)
        y -= LU[at] * x[column[at]];
    return y * lu.inverse[k];
}

// Solves A x = b with the last factors. Allocates nothing.
template <class Real>
void solve(SparseLU<Real>& lu, const Real* b, Real* x) {
    const std::size_t n = lu.size();
    const Elimination& order = *lu.order;
    Real* const y = lu.y.data();
    const Real* const LU = lu.LU.data();
    const int* const column = order.column.data();
    for (std::size_t i = 0; i < n; ++i) {
        Real sum = b[order.row[i]];
        for (int at = order.first[i]; at < order.pivot[i]; ++at) sum -= LU[at] * y[column[at]];
        y[i] = sum;
    }
    for (std::size_t k = n; k-- > 0;) x[order.col[k]] = y[k] = back_substituted(lu, k, y[k], y);
}

// Solves A x = e_j for the unknowns `wanted` only. Forward substitution visits only the rows
// reached from row j, back substitution only the rows that the wanted unknowns depend on. Values
// below rounding relative to the start are not propagated. The work is small where x has few
// non-zeros (a motion of one body).
template <class Real>
void solve_unit(SparseLU<Real>& lu, int j, const int* wanted, int count, Real* x) {
    const Elimination& order = *lu.order;
    const Real rounding = 4 * std::numeric_limits<Real>::epsilon();
    const auto n = static_cast<int>(lu.size());
    // local pointers: a store to `queued`, of characters, might change any other
    Real *const known = lu.known.data(), *const unknown = lu.unknown.data();
    char* const queued = lu.queued.data();
    const Real* const LU = lu.LU.data();
    const auto* const below = order.below.data();
    const auto* const right = order.right.data();
    const int *const first_below = order.first_below.data(),
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
            known[below[e].row] -= LU[below[e].at] * y;
            queued[below[e].row] = 1;
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
        for (int r = first_right[k]; r < first_right[k + 1] && right[r].column <= last; ++r)
            for (int c = right[r].column; c < std::min(right[r].column + right[r].length, last + 1);
                 ++c)
                queued[c] = 1;
    }
    for (std::size_t r = lu.reached.size(); r-- > forward;) {
        const int own = lu.reached[r];
        unknown[own] = back_substituted(lu, static_cast<std::size_t>(own), known[own], unknown);
    }
    for (int c = 0; c < count; ++c) x[c] = unknown[col_of[wanted[c]]];
    for (const int own : lu.reached) known[own] = unknown[own] = 0;
}

// Instantiated in linear_algebra/in_double.cpp.
extern template void analyse<double>(SparseLU<double>&, const Pattern&, const double*);
extern template double factorise<double>(SparseLU<double>&, const double*);
extern template void solve<double>(SparseLU<double>&, const double*, double*);
extern template void solve_unit<double>(SparseLU<double>&, int, const int*, int, double*);

}  // namespace elastocheck::recursive
