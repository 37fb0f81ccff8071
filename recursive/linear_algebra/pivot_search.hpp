// Pivot order of a sparse LU by the Markowitz criterion (1957) with threshold pivoting.
// The pivot has the smallest (entries in its row - 1)(entries in its column - 1) among entries of
// at least a tenth of the largest in their column.
//
// For a small matrix every remaining entry is a candidate for every pivot. For a large one only a
// few of the shortest columns are searched (Zlatev 1980), so that the search costs about as much as
// the elimination. On trees of bodies the fill of the restricted search is within 4 % of that of
// the full search; from sixty unknowns on it costs half as much.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "recursive/formula/state.hpp"

namespace elastocheck::recursive {

// Sparsity pattern of a square matrix, compressed by columns, rows ascending.
struct Pattern {
    int size = 0;
    std::vector<int> first;  // index of each column's first entry, and the end [size + 1]
    std::vector<int> row;    // of each entry

    std::size_t entries() const { return row.size(); }
    bool operator==(const Pattern&) const = default;
};
// Number of the entry (i, j); -1 where the pattern has none.
inline int entry_at(const Pattern& pattern, int i, int j) {
    const auto from = pattern.row.begin() + pattern.first[static_cast<std::size_t>(j)],
               to = pattern.row.begin() + pattern.first[static_cast<std::size_t>(j) + 1],
               found = std::lower_bound(from, to, i);
    return found == to || *found != i ? -1 : static_cast<int>(found - pattern.row.begin());
}
inline bool has_entry(const Pattern& pattern, int i, int j) { return entry_at(pattern, i, j) >= 0; }

template <class Real>
struct PivotSearch {
    // Result, in row and column numbers of A: the k-th pivot, and the other entries of its column
    // and row (fill included).
    std::vector<int> row, col, below, first_below, right, first_right;

    // Workspace of the full search
    std::vector<Real> W;                  // the matrix
    std::vector<char> filled;             // whether an entry is a non-zero, fill included
    std::vector<long> in_row, in_column;  // remaining entries per row and column
    std::vector<Real> largest;            // largest remaining entry of each column

    static constexpr Real min_pivot = Real(0.1);  // as a fraction of its column's largest entry
    static constexpr int exhaustive = 60;         // up to this size the full search is used,
    static constexpr int columns = 4;             // beyond it this many columns per pivot
};

namespace detail {

// Full search: every remaining entry for every pivot.
template <class Real>
void search_all(PivotSearch<Real>& search, const Pattern& pattern, const Real* values) {
    const auto n = static_cast<std::size_t>(pattern.size);
    search.row.resize(n);
    search.col.resize(n);
    search.W.resize(n * n);
    search.filled.resize(n * n);
    for (auto* list : {&search.in_row, &search.in_column}) list->resize(n);
    search.largest.resize(n);
    std::fill(search.filled.begin(), search.filled.end(), 0);
    std::fill(search.W.begin(), search.W.end(), Real(0));
    for (std::size_t j = 0; j < n; ++j) {
        search.row[j] = search.col[j] = static_cast<int>(j);
        for (int e = pattern.first[j]; e < pattern.first[j + 1]; ++e) {
            const std::size_t place =
                static_cast<std::size_t>(pattern.row[static_cast<std::size_t>(e)]) * n + j;
            search.filled[place] = 1;
            search.W[place] = values[e];
        }
    }
    // The remaining matrix is the block right of and below (k, k).
    const auto measure_column = [&](std::size_t c, std::size_t k) {
        search.in_column[c] = 0;
        search.largest[c] = 0;
        for (std::size_t r = k; r < n; ++r) {
            if (!search.filled[r * n + c]) continue;
            ++search.in_column[c];
            search.largest[c] = std::max(search.largest[c], std::abs(search.W[r * n + c]));
        }
    };
    for (std::size_t k = 0; k < n; ++k) {
        measure_column(k, 0);
        search.in_row[k] = std::count(&search.filled[k * n], &search.filled[k * n] + n, 1);
    }
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t best_r = k, best_c = k;
        long best_fill = std::numeric_limits<long>::max();
        Real best_value = 0;
        const long fewest =
            *std::min_element(&search.in_column[k], &search.in_column[k] + (n - k)) - 1;
        for (std::size_t r = k; r < n; ++r) {
            const long others = search.in_row[r] - 1;
            if (others * fewest > best_fill) continue;
            const char* const filled = &search.filled[r * n];
            for (std::size_t c = k; c < n; ++c) {
                if (!filled[c]) continue;
                const long fill = others * (search.in_column[c] - 1);
                if (fill > best_fill) continue;
                const Real value = std::abs(search.W[r * n + c]);
                if (!(value > 0 && value >= search.min_pivot * search.largest[c]) ||
                    (fill == best_fill && !(value > best_value)))
                    continue;
                best_fill = fill;
                best_value = value;
                best_r = r;
                best_c = c;
            }
        }
        const auto swap_entries = [&](auto& entries) {
            if (best_r != k)
                std::swap_ranges(&entries[k * n], &entries[k * n] + n, &entries[best_r * n]);
            for (std::size_t r = 0; r < n; ++r)
                std::swap(entries[r * n + k], entries[r * n + best_c]);
        };
        swap_entries(search.W);
        swap_entries(search.filled);
        std::swap(search.row[k], search.row[best_r]);
        std::swap(search.in_row[k], search.in_row[best_r]);
        std::swap(search.col[k], search.col[best_c]);
        std::swap(search.in_column[k], search.in_column[best_c]);
        std::swap(search.largest[k], search.largest[best_c]);
        // The zero pivot reports a singular matrix. A later matrix of this pattern may be regular,
        // so its fill is included.
        search.filled[k * n + k] = 1;
        for (std::size_t r = k + 1; r < n; ++r) {
            if (!search.filled[r * n + k]) continue;
            --search.in_row[r];
            const Real l = best_value > 0 ? search.W[r * n + k] / search.W[k * n + k] : Real(0);
            for (std::size_t c = k + 1; c < n; ++c) {
                if (!search.filled[k * n + c]) continue;
                if (!search.filled[r * n + c]) {
                    search.filled[r * n + c] = 1;
                    ++search.in_row[r];
                }
                search.W[r * n + c] -= l * search.W[k * n + c];
            }
        }
        for (std::size_t c = k + 1; c < n; ++c)
            if (search.filled[k * n + c]) measure_column(c, k + 1);
    }
    for (std::size_t k = 0; k < n; ++k) {
        search.first_below.push_back(static_cast<int>(search.below.size()));
        search.first_right.push_back(static_cast<int>(search.right.size()));
        for (std::size_t o = k + 1; o < n; ++o) {
            if (search.filled[o * n + k]) search.below.push_back(search.row[o]);
            if (search.filled[k * n + o]) search.right.push_back(search.col[o]);
        }
    }
}

// Columns in linked lists by their number of entries; the last one changed is first.
struct ByCount {
    std::vector<int> head, next, previous, count;

    explicit ByCount(std::size_t n) : head(n + 1, -1), next(n, -1), previous(n, -1), count(n, -1) {}
    static std::size_t at(int k) { return static_cast<std::size_t>(k); }
    void take_out(int k) {
        if (count[at(k)] < 0) return;
        (previous[at(k)] < 0 ? head[at(count[at(k)])] : next[at(previous[at(k)])]) = next[at(k)];
        if (next[at(k)] >= 0) previous[at(next[at(k)])] = previous[at(k)];
        count[at(k)] = -1;
    }
    void put(int k, std::size_t entries) {  // an empty one stays in: its matrix is singular
        take_out(k);
        count[at(k)] = static_cast<int>(entries);
        previous[at(k)] = -1;
        next[at(k)] = head[entries];
        if (next[at(k)] >= 0) previous[at(next[at(k)])] = k;
        head[entries] = k;
    }
};

// The remaining matrix: columns with their values, rows without.
template <class Real>
struct Remaining {
    struct Entry {
        int row;
        Real value;
    };
    std::vector<std::vector<Entry>> column;
    std::vector<std::vector<int>> row;

    std::vector<Entry>& in_column(int c) { return column[static_cast<std::size_t>(c)]; }
    std::vector<int>& in_row(int r) { return row[static_cast<std::size_t>(r)]; }
};

template <class Real>
struct Pivot {
    int row = -1, col = -1;
    Real value = 0;
};

// The best pivot of the first few columns, shortest first; row -1 where all remaining
// entries are zero.
template <class Real>
Pivot<Real> best_of_few(Remaining<Real>& remaining, const ByCount& columns) {
    Pivot<Real> best;
    auto best_fill = std::numeric_limits<std::size_t>::max();
    int searched = 0;
    for (std::size_t entries = 1; entries < columns.head.size(); ++entries)
        for (int c = columns.head[entries]; c >= 0; c = columns.next[ByCount::at(c)]) {
            Real largest = 0;
            for (const auto& e : remaining.in_column(c))
                largest = std::max(largest, std::abs(e.value));
            if (!(largest > 0)) continue;
            for (const auto& e : remaining.in_column(c)) {
                const Real value = std::abs(e.value);
                if (!(value >= PivotSearch<Real>::min_pivot * largest)) continue;
                const std::size_t fill = (remaining.in_row(e.row).size() - 1) * (entries - 1);
                if (fill > best_fill || (fill == best_fill && !(value > std::abs(best.value))))
                    continue;
                best_fill = fill;
                best = {e.row, c, e.value};
            }
            if (best_fill == 0 || ++searched == PivotSearch<Real>::columns) return best;
        }
    return best;
}

// Restricted search: a few columns for every pivot.
template <class Real>
void search_few(PivotSearch<Real>& search, const Pattern& pattern, const Real* values) {
    const auto n = static_cast<std::size_t>(pattern.size);
    const auto at = [](int k) { return static_cast<std::size_t>(k); };
    search.row.clear();
    search.col.clear();
    Remaining<Real> remaining{std::vector<std::vector<typename Remaining<Real>::Entry>>(n),
                              std::vector<std::vector<int>>(n)};
    for (std::size_t j = 0; j < n; ++j)
        for (int e = pattern.first[j]; e < pattern.first[j + 1]; ++e) {
            remaining.column[j].push_back({pattern.row[at(e)], values[e]});
            remaining.in_row(pattern.row[at(e)]).push_back(static_cast<int>(j));
        }
    ByCount columns(n);
    for (std::size_t j = n; j-- > 0;) columns.put(static_cast<int>(j), remaining.column[j].size());
    std::vector<char> row_is_left(n, 1);
    std::size_t first_left = 0;
    std::vector<Real> multiplier(n, 0);
    // marks: rows of the pivot's column; those of them that the current column has
    std::vector<char> below(n, 0), met(n, 0);

    for (std::size_t k = 0; k < n; ++k) {
        Pivot<Real> pivot = best_of_few(remaining, columns);
        if (pivot.row < 0) {
            // The zero pivot reports a singular matrix. A later matrix of this pattern may be
            // regular, so its fill is included.
            while (!row_is_left[first_left]) ++first_left;
            pivot.row = static_cast<int>(first_left);
            for (std::size_t c = 0; pivot.col < 0; ++c)
                if (columns.count[c] >= 0) pivot.col = static_cast<int>(c);
        }
        search.row.push_back(pivot.row);
        search.col.push_back(pivot.col);
        search.first_below.push_back(static_cast<int>(search.below.size()));
        search.first_right.push_back(static_cast<int>(search.right.size()));
        row_is_left[at(pivot.row)] = 0;
        columns.take_out(pivot.col);

        const auto column = std::move(remaining.in_column(pivot.col));
        for (const auto& e : column) {
            if (e.row == pivot.row) continue;
            std::erase(remaining.in_row(e.row), pivot.col);
            search.below.push_back(e.row);
            below[at(e.row)] = 1;
            multiplier[at(e.row)] = pivot.value != Real(0) ? e.value / pivot.value : Real(0);
        }
        const std::size_t rows_below = search.below.size() - at(search.first_below.back());
        const auto row = std::move(remaining.in_row(pivot.row));
        for (const int c : row) {
            if (c == pivot.col) continue;
            search.right.push_back(c);
            auto& entries = remaining.in_column(c);
            const auto own =
                std::ranges::find_if(entries, [&](const auto& e) { return e.row == pivot.row; });
            const Real u = own->value;
            *own = entries.back();
            entries.pop_back();
            std::size_t already = 0;
            for (auto& e : entries) {
                if (!below[at(e.row)]) continue;
                e.value -= multiplier[at(e.row)] * u;
                met[at(e.row)] = 1;
                ++already;
            }
            for (const auto& e : column) {
                if (e.row == pivot.row) continue;
                if (already < rows_below && !met[at(e.row)]) {
                    entries.push_back({e.row, -multiplier[at(e.row)] * u});
                    remaining.in_row(e.row).push_back(c);
                }
                met[at(e.row)] = 0;
            }
            columns.put(c, entries.size());
        }
        for (const auto& e : column) below[at(e.row)] = 0;
    }
}

}  // namespace detail

// Chooses the pivots for matrices of this pattern, from typical values.
template <class Real>
void search_pivots(PivotSearch<Real>& search, const Pattern& pattern, const Real* values) {
    for (auto* list : {&search.below, &search.right, &search.first_below, &search.first_right})
        list->clear();
    if (pattern.size <= search.exhaustive)
        detail::search_all(search, pattern, values);
    else
        detail::search_few(search, pattern, values);
    search.first_below.push_back(static_cast<int>(search.below.size()));
    search.first_right.push_back(static_cast<int>(search.right.size()));
}

}  // namespace elastocheck::recursive
