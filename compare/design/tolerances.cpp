#include "compare/design/tolerances.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace elastocheck::compare {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool is_correlation(const MatrixXd& matrix) {
    if (matrix.rows() != matrix.cols() || matrix != matrix.transpose() ||
        (matrix.diagonal().array() != 1).any())
        return false;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
    return solver.eigenvalues().minCoeff() >= -1e-12 * static_cast<double>(matrix.rows());
}

std::vector<Scatter> scatter(const MatrixXd& gradient, const std::vector<Tolerated>& numbers,
                             const MatrixXd& correlation) {
    const auto n = static_cast<Index>(numbers.size());
    const MatrixXd rho = correlation.size() > 0 ? correlation : MatrixXd::Identity(n, n);
    VectorXd sd(n), largest(n);
    for (Index i = 0; i < n; ++i) {
        const Tolerated& number = numbers[static_cast<std::size_t>(i)];
        sd[i] = number.sd, largest[i] = number.largest;
    }
    const MatrixXd covariance = sd.asDiagonal() * rho * sd.asDiagonal();
    std::vector<Scatter> all;
    for (Index j = 0; j < gradient.rows(); ++j) {
        const VectorXd g = gradient.row(j);
        const VectorXd parts = g.cwiseProduct(covariance * g);
        const double variance = std::max(parts.sum(), 0.0);  // rounding
        all.push_back({.sd = std::sqrt(variance),
                       .worst_case = g.cwiseAbs().dot(largest),
                       .share = variance > 0 ? VectorXd(parts / variance) : VectorXd::Zero(n)});
    }
    return all;
}

}  // namespace elastocheck::compare
