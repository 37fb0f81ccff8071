// Sparse accumulator: a dense vector with the list of its non-zero positions.
#pragma once

#include <Eigen/SparseCore>
#include <cmath>
#include <vector>

namespace elastocheck::recursive {

struct Scattered {
    // of a value of order one that would be zero in exact arithmetic
    static constexpr double rounding = 1e-12;

    Eigen::VectorXd value;
    std::vector<int> touched;
    std::vector<char> is_touched;

    explicit Scattered(Eigen::Index size)
        : value(Eigen::VectorXd::Zero(size)), is_touched(static_cast<std::size_t>(size), 0) {}
    // Returns whether the position is new.
    bool add(int at, double amount) {
        value[at] += amount;
        if (is_touched[static_cast<std::size_t>(at)]) return false;
        is_touched[static_cast<std::size_t>(at)] = 1;
        touched.push_back(at);
        return true;
    }
    void clear() {
        for (const int at : touched) {
            value[at] = 0;
            is_touched[static_cast<std::size_t>(at)] = 0;
        }
        touched.clear();
    }
    // Appends the vector as a column of unit length, without entries at rounding level.
    void append_to(std::vector<Eigen::Triplet<double>>& entries, int column) const {
        double square = 0;
        for (const int at : touched) square += value[at] * value[at];
        const double whole = std::sqrt(square);
        for (const int at : touched)
            if (std::abs(value[at]) > rounding * whole)
                entries.emplace_back(at, column, value[at] / whole);
    }
};

}  // namespace elastocheck::recursive
