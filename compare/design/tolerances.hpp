// Linear tolerance analysis: scatter of figures from that of the numbers of a scene.
//
// With the gradient g of a figure and the covariance Σ_ij = ρ_ij σ_i σ_j of the numbers:
//
//   standard deviation  σ_f = √(gᵀ Σ g)         worst case  w_f = Σ |g_i| w_i
//   share of number i   g_i (Σ g)_i / σ_f²      (they add up to one; negative where a correlation
//                                               makes the number reduce the scatter)
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace elastocheck::compare {

struct ToleratedNumbers {
    std::vector<std::string> numbers;
    // standard deviations, and largest deviations of the worst case, in the units of the numbers
    Eigen::VectorXd sd, largest;
    Eigen::MatrixXd correlation;  // is_correlation()
};

struct Scatter {  // of a figure, in its unit
    double sd = 0, worst_case = 0;
    Eigen::VectorXd share;  // per number; zero where sd is
};

// Whether a matrix is symmetric with ones on its diagonal and has no negative eigenvalue.
inline bool is_correlation(const Eigen::MatrixXd& matrix) {
    if (matrix.rows() != matrix.cols() || matrix != matrix.transpose() ||
        (matrix.diagonal().array() != 1).any())
        return false;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
    return solver.eigenvalues().minCoeff() >= -1e-12 * static_cast<double>(matrix.rows());
}

inline Scatter scatter(const Eigen::VectorXd& gradient, const ToleratedNumbers& tolerances) {
    const Eigen::VectorXd g = gradient.cwiseProduct(tolerances.sd),
                          parts = g.cwiseProduct(tolerances.correlation * g);
    const double variance = std::max(parts.sum(), 0.0);  // rounding
    return {std::sqrt(variance), gradient.cwiseAbs().dot(tolerances.largest),
            variance > 0 ? Eigen::VectorXd(parts / variance) : Eigen::VectorXd::Zero(g.size())};
}

}  // namespace elastocheck::compare
