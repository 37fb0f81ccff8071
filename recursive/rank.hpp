// Which rows say what the rows before them say, and what no row says: rank decided on sparse rows of unit length.
//
// Rows are those of Φ_q and of √K B: each touches two bodies at most, and the bodies hang together in chains, trees
// and grids. No product of rows with rows is formed: one body with a thousand links on it would fill that.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace elastocheck::recursive {

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Columns = Eigen::SparseMatrix<double>;

constexpr double rank_threshold = 1e-9;  // of rows of unit length: what is left of one that is none

// Row k repeats where it is a combination of the rows before it. Then row k - Σ y_i row i = 0 over those that do not
// repeat themselves is its dependency, which is unique: column by column yᵀ, of unit length, y_k > 0.
struct Repeated {
    std::vector<int> rows;     // rising
    std::vector<double> left;  // largest entry of what no combination of the rows before makes up of it
    Columns dependencies;      // [rows × repeated]
};
Repeated repeated(const Rows& rows);

// A basis of the Δq with rows · Δq = 0, of unit length [columns × nullity].
Columns null_space(const Rows& rows);

// What of f the rows leave free: f - Aᵀ μ, perpendicular to all of them.
Eigen::VectorXd left_free(const Rows& rows, const Eigen::VectorXd& f);

}  // namespace elastocheck::recursive
