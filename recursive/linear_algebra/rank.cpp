#include "recursive/linear_algebra/rank.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "recursive/linear_algebra/scattered.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::VectorXd;

constexpr double pivot_threshold = 0.1;  // of the largest entry of a row: acceptable pivots

struct Entry {
    int index;  // column, or row whose multiplier it is
    double value;
};

// A row u_k after elimination of the rows before it.
struct Reduced {
    std::vector<Entry> entries;      // outside its pivot column
    std::vector<Entry> multipliers;  // l_kj of the rows j
    int pivot = -1;                  // column; -1 for a dependent row
    double pivot_value = 0;
};

}  // namespace

// Gaussian elimination in the order of the rows, with a pivot column for each row. Among the
// columns whose entry is at least `pivot_threshold` times the largest, the one with the fewest
// entries in later rows is chosen, which keeps the reduced rows sparse (in a chain this is a column
// of a finished body; otherwise every row would fill with all joints before it). The remainder of
// row k is
//
//   u_k = row k - Σ_j l_kj u_j     over the independent rows j < k,
//
// and is zero for a dependent row. No combination of rows is nearer to row k than its distance from
// their span, so a row that is dependent here is so by any measure. Back substitution with the same
// l, starting from row k alone, gives its dependency in terms of the rows themselves.
DependentRows find_dependent_rows(const Rows& rows, std::span<const int> expected,
                                  double max_remainder) {
    const auto m = static_cast<std::size_t>(rows.rows()), n = static_cast<std::size_t>(rows.cols());
    // of each column: its number of entries in later rows, and the row whose pivot it is
    std::vector<int> later_entries(n, 0), pivot_row(n, -1);
    for (int k = 0; k < rows.outerSize(); ++k)
        for (Rows::InnerIterator e(rows, k); e; ++e)
            ++later_entries[static_cast<std::size_t>(e.col())];

    DependentRows result;
    std::vector<Eigen::Triplet<double>> dependencies;
    std::vector<Reduced> reduced(m);
    Scattered x(rows.cols()), y(rows.rows());
    for (int k = 0; k < static_cast<int>(m); ++k) {
        // Elimination of the rows whose pivot column has an entry, first to last.
        std::priority_queue<int, std::vector<int>, std::greater<>> earlier;
        const auto add = [&](int column, double value) {
            if (x.add(column, value))
                if (const int row = pivot_row[static_cast<std::size_t>(column)]; row >= 0)
                    earlier.push(row);
        };
        for (Rows::InnerIterator e(rows, k); e; ++e) {
            add(static_cast<int>(e.col()), e.value());
            --later_entries[static_cast<std::size_t>(e.col())];
        }
        Reduced& u = reduced[static_cast<std::size_t>(k)];
        while (!earlier.empty()) {
            const int j = earlier.top();
            earlier.pop();
            const Reduced& other = reduced[static_cast<std::size_t>(j)];
            const double l = x.value[other.pivot] / other.pivot_value;
            x.value[other.pivot] = 0;
            if (!(std::abs(l) > Scattered::rounding)) continue;
            u.multipliers.push_back({j, l});
            for (const Entry& e : other.entries) add(e.index, -l * e.value);
        }
        // Choice of the pivot.
        double largest = 0;
        for (const int c : x.touched) largest = std::max(largest, std::abs(x.value[c]));
        if (largest > (std::ranges::binary_search(expected, k) ? max_remainder : rank_threshold)) {
            for (const int c : x.touched) {
                const double size = std::abs(x.value[c]);
                if (!(size >= pivot_threshold * largest)) continue;
                const auto column = static_cast<std::size_t>(c);
                const int fewest =
                    u.pivot < 0 ? 0 : later_entries[static_cast<std::size_t>(u.pivot)];
                if (u.pivot >= 0 &&
                    (later_entries[column] > fewest ||
                     (later_entries[column] == fewest && size <= std::abs(u.pivot_value))))
                    continue;
                u.pivot = c;
                u.pivot_value = x.value[c];
            }
            for (const int c : x.touched)
                if (c != u.pivot && std::abs(x.value[c]) > Scattered::rounding)
                    u.entries.push_back({c, x.value[c]});
            pivot_row[static_cast<std::size_t>(u.pivot)] = k;
        } else {
            // Dependency: rows are expressed by those before them, last to first.
            std::priority_queue<int> later;
            const auto spread = [&](int row, double value) {
                if (y.add(row, value)) later.push(row);
            };
            for (const Entry& e : u.multipliers) spread(e.index, -e.value);
            while (!later.empty()) {
                const int j = later.top();
                later.pop();
                for (const Entry& e : reduced[static_cast<std::size_t>(j)].multipliers)
                    spread(e.index, -e.value * y.value[j]);
            }
            y.add(k, 1);
            y.append_to(dependencies, static_cast<int>(result.rows.size()));
            y.clear();
            result.rows.push_back(k);
            result.remainder.push_back(largest);
        }
        x.clear();
    }
    result.dependencies.resize(rows.rows(), static_cast<Eigen::Index>(result.rows.size()));
    result.dependencies.setFromTriplets(dependencies.begin(), dependencies.end());
    return result;
}

// ⎡ I   Aᵀ ⎤ ⎧ g ⎫   ⎧ f ⎫
// ⎣ A   0  ⎦ ⎩ μ ⎭ = ⎩ 0 ⎭
//
// Iterative refinement with a nearby regular matrix that has -ε² in place of 0. Eliminating μ there
// leaves I + Aᵀ A / ε², which couples only bodies that share a row. In a direction with singular
// value σ each round leaves the fraction ε² / (ε² + σ²) of the error, plus its own rounding times
// 1 / ε².
VectorXd orthogonal_component(const Rows& rows, const VectorXd& f) {
    constexpr double epsilon_squared = 1e-12, tolerance = 1e-14;
    constexpr int max_rounds = 50;
    const Columns A = rows, At = A.transpose();
    Columns N = At * A / epsilon_squared;
    for (int k = 0; k < N.cols(); ++k) N.coeffRef(k, k) += 1;
    const Eigen::SimplicialLDLT<Columns> factors(N);
    VectorXd g = VectorXd::Zero(f.size()), mu = VectorXd::Zero(rows.rows());
    for (int round = 0; round < max_rounds; ++round) {
        const VectorXd force = f - g - At * mu, motion = -(A * g);
        if (force.norm() + motion.norm() <= tolerance * f.norm()) break;
        const VectorXd dg = factors.solve(force + At * motion / epsilon_squared);
        g += dg;
        mu += (A * dg - motion) / epsilon_squared;
    }
    return g;
}

}  // namespace elastocheck::recursive
