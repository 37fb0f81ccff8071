// A sparse matrix of any number type, assembled entry by entry.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

namespace elastocheck::reference::certificate {

template <class S>
struct Slope {  // an entry
    int row = 0, column = 0;
    S value{};
};
// A sparse matrix by rows: entries start[i] ... start[i + 1] are those of row i, in any order.
template <class S>
struct SparseRows {
    std::vector<Slope<S>> entries;
    std::vector<std::size_t> start;
    std::span<const Slope<S>> row(Eigen::Index i) const {
        const auto k = static_cast<std::size_t>(i);
        return std::span(entries).subspan(start[k], start[k + 1] - start[k]);
    }
};
// Sorts entries in any order by their rows, and adds up those of the same place.
template <class S>
SparseRows<S> by_rows(const std::vector<Slope<S>>& entries, int n) {
    const auto at = [](int k) { return static_cast<std::size_t>(k); };
    std::vector<std::size_t> first(at(n) + 1);  // of each row in `order`
    for (const Slope<S>& entry : entries) ++first[at(entry.row) + 1];
    for (std::size_t row = 0; row < at(n); ++row) first[row + 1] += first[row];
    std::vector<std::size_t> order(entries.size()), next = first;
    for (std::size_t k = 0; k < entries.size(); ++k) order[next[at(entries[k].row)]++] = k;

    SparseRows<S> rows;
    rows.start.push_back(0);
    constexpr auto nowhere = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> place(at(n), nowhere);  // of each column in this row
    for (std::size_t row = 0; row < at(n); ++row) {
        for (std::size_t k = first[row]; k < first[row + 1]; ++k) {
            const Slope<S>& entry = entries[order[k]];
            std::size_t& to = place[at(entry.column)];
            if (to == nowhere) {
                to = rows.entries.size();
                rows.entries.push_back(entry);
            } else {
                rows.entries[to].value = rows.entries[to].value + entry.value;
            }
        }
        for (std::size_t k = rows.start.back(); k < rows.entries.size(); ++k)
            place[at(rows.entries[k].column)] = nowhere;
        rows.start.push_back(rows.entries.size());
    }
    return rows;
}

}  // namespace elastocheck::reference::certificate
