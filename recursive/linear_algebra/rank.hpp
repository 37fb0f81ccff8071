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

// on the remainder of a row of unit length; below it the row is dependent
constexpr double rank_threshold = 1e-9;

// Dependent rows. Row k is dependent if it is a combination of the rows before it. Its dependency
// row k - Σ y_i row i = 0 over the independent rows is unique and is returned as a column y of unit
// length, y_k > 0.
struct Repeated {
    std::vector<int> rows;     // dependent rows, ascending
    std::vector<double> left;  // largest entry of the remainder of each such row
    Columns dependencies;      // [rows × dependent rows]
};
// `expected`, ascending: rows that are dependent in a neighbouring state, up to this remainder.
Repeated repeated(const Rows& rows, std::span<const int> expected = {},
                  double remainder = rank_threshold);

// A basis of the Δq with rows · Δq = 0, of unit length [columns × nullity].
Columns null_space(const Rows& rows);

// Component of f orthogonal to all rows: f - Aᵀ μ.
Eigen::VectorXd left_free(const Rows& rows, const Eigen::VectorXd& f);

}  // namespace elastocheck::recursive
