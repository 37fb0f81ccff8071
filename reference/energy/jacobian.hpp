// The derivative of constraints as what it is: row by row, six numbers for each body that is held. A matrix is made
// of it only where one is needed.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "models/mechanism.hpp"

namespace elastocheck::reference::energy {

// ∂Φ_row/∂x of one body.
struct Slope {
    int row;
    BodyId body;
    Eigen::Vector3d dr, dpi;  // by Δr, by φ
};

struct Jacobian {
    int rows = 0, columns = 0;  // m, 6nb
    std::vector<Slope> slopes;  // in the order of the rows; of the same body and row they add up
};

// D Φ_q S, what scaled rows are in scaled coordinates.
Jacobian scaled(Jacobian Phi_q, const Eigen::VectorXd& D, const Eigen::VectorXd& S);

Eigen::VectorXd transposed_times(const Jacobian& Phi_q, const Eigen::VectorXd& lambda);  // Φ_qᵀ λ [6nb]
Eigen::MatrixXd times_transposed(const Eigen::MatrixXd& B, const Jacobian& Phi_q);  // B Φ_qᵀ [... × m]
Eigen::MatrixXd transposed(const Jacobian& Phi_q);                                  // Φ_qᵀ [6nb × m]

// g less its part in the row space of Φ_q: what the best multipliers leave of a gradient. By Householder
// transformations of Φ_qᵀ as a sparse matrix, so that it costs what the matrix fills in, which for chains and trees
// of bodies is in proportion to their number. Rows of Φ_q are of order one.
Eigen::VectorXd left_over(const Jacobian& Phi_q, const Eigen::VectorXd& g);

}  // namespace elastocheck::reference::energy
