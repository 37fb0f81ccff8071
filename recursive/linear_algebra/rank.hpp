// Linearly dependent rows and null space of a sparse matrix with rows of unit length.
//
// The rows are those of Φ_q and of √K B. Each involves at most two bodies, which form chains, trees
// and grids. No product of the matrix with its transpose is formed: one body with a thousand links
// would make it dense.
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

namespace elastocheck::recursive {

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Columns = Eigen::SparseMatrix<double>;

// A row of unit length with a smaller remainder is dependent.
constexpr double rank_threshold = 1e-9;

// Dependent rows. Row k is dependent if it is a combination of the rows before it. Its dependency
// row k - Σ y_i row i = 0 over the independent rows is unique and is returned as a column y of unit
// length, y_k > 0.
struct DependentRows {
    std::vector<int> rows;          // ascending
    std::vector<double> remainder;  // largest entry of the remainder of each
    Columns dependencies;           // [rows × dependent rows]
};
// `expected`, ascending: rows that are dependent in a neighbouring state; they are here up to
// `max_remainder`.
DependentRows find_dependent_rows(const Rows& rows, std::span<const int> expected = {},
                                  double max_remainder = rank_threshold);

// A basis of the Δq with rows · Δq = 0, of unit length [columns × nullity].
Columns null_space(const Rows& rows);

// Component of f orthogonal to all rows: f - Aᵀ μ.
Eigen::VectorXd orthogonal_component(const Rows& rows, const Eigen::VectorXd& f);

}  // namespace elastocheck::recursive
