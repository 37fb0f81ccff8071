// Sparse Jacobian of the constraints: row by row, six numbers per connected body.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "elastocheck/mechanism.hpp"

namespace elastocheck::reference::energy {

// Smallest pivot of a scaled matrix, as of (∂DΦ/∂ξ)ᵀ, whose columns are of order one.
inline constexpr double rank_threshold = 1e-9;

// ∂Φ_row/∂x of one body.
struct Slope {
    int row;
    BodyId body;
    Eigen::Vector3d dr, dpi;  // by Δr, by φ
};

struct Jacobian {
    int rows = 0, columns = 0;
    std::vector<Slope> slopes;  // in the order of the rows; of the same body and row they add up
};

// D Φ_q S, the Jacobian of scaled rows in scaled coordinates.
Jacobian scaled(Jacobian Phi_q, const Eigen::VectorXd& D, const Eigen::VectorXd& S);

// Φ_qᵀ λ [6nb]
Eigen::VectorXd transposed_times(const Jacobian& Phi_q, const Eigen::VectorXd& lambda);
// B Φ_qᵀ [... × m]
Eigen::MatrixXd times_transposed(const Eigen::MatrixXd& B, const Jacobian& Phi_q);
Eigen::MatrixXd transposed(const Jacobian& Phi_q);  // Φ_qᵀ [6nb × m]

using Sparse = Eigen::SparseMatrix<double>;
Sparse sparse_transposed(const Jacobian& Phi_q);  // likewise

// Projection of g onto the orthogonal complement of the row space of Φ_q, g + Φ_qᵀ λ, with λ the
// least-squares multipliers, of minimum norm where not unique. By Householder transformations of
// Φ_qᵀ; of a large one as a sparse matrix at the cost of its fill-in, which for chains and trees is
// proportional to the number of bodies. Rows of Φ_q are of order one.
struct Projection {
    Eigen::VectorXd gradient, lambda;  // [6nb], [m]
};
Projection project_gradient(const Jacobian& Phi_q, const Eigen::VectorXd& g);

}  // namespace elastocheck::reference::energy
