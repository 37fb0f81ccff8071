#include "reference/energy/constraints/jacobian.hpp"

#include <Eigen/QR>
#include <Eigen/SPQRSupport>
#include <limits>

#include "models/eigen/dense.hpp"

namespace elastocheck::reference::energy {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Sparse sparse_transposed(const Jacobian& Phi_q) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(6 * Phi_q.slopes.size());
    for (const auto& slope : Phi_q.slopes)
        for (int k = 0; k < 3; ++k) {
            entries.emplace_back(6 * slope.body + k, slope.row, slope.dr[k]);
            entries.emplace_back(6 * slope.body + 3 + k, slope.row, slope.dpi[k]);
        }
    Sparse J_t(Phi_q.columns, Phi_q.rows);
    J_t.setFromTriplets(entries.begin(), entries.end());
    return J_t;
}

namespace {

constexpr int dense_columns = 90;  // of Φ_q: up to here a dense QR takes less time than SPQR

using Long = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;

// The shortest of the solutions that differ from λ by the null space of Φ_qᵀ P = Q [R₁ R₂; 0 0]:
// the columns of P [-R₁⁻¹ R₂; 1].
VectorXd shortest(const Eigen::SPQR<Long>& qr, const VectorXd& lambda) {
    const Eigen::Index rank = qr.rank(), redundant = lambda.size() - rank;
    if (redundant == 0) return lambda;
    const Long R = qr.matrixR();
    MatrixXd null = MatrixXd::Zero(lambda.size(), redundant);
    const Long R_1 = R.topLeftCorner(rank, rank);
    MatrixXd R_2 = R.topRightCorner(rank, redundant);
    R_1.triangularView<Eigen::Upper>().solveInPlace(R_2);
    null.topRows(rank) = -R_2;
    null.bottomRows(redundant).setIdentity();
    null = (qr.colsPermutation() * null).eval();
    const VectorXd coefficients = Eigen::HouseholderQR<MatrixXd>(null).solve(lambda);
    return lambda - null * coefficients;
}

}  // namespace

Jacobian scaled(Jacobian Phi_q, const VectorXd& D, const VectorXd& S) {
    for (auto& slope : Phi_q.slopes) {
        slope.dr = S.segment<3>(6 * slope.body).cwiseProduct(slope.dr) * D[slope.row];
        slope.dpi = S.segment<3>(6 * slope.body + 3).cwiseProduct(slope.dpi) * D[slope.row];
    }
    return Phi_q;
}

VectorXd transposed_times(const Jacobian& Phi_q, const VectorXd& lambda) {
    VectorXd product = VectorXd::Zero(Phi_q.columns);
    for (const auto& slope : Phi_q.slopes) {
        product.segment<3>(6 * slope.body) += slope.dr * lambda[slope.row];
        product.segment<3>(6 * slope.body + 3) += slope.dpi * lambda[slope.row];
    }
    return product;
}

MatrixXd times_transposed(const MatrixXd& B, const Jacobian& Phi_q) {
    MatrixXd product = MatrixXd::Zero(B.rows(), Phi_q.rows);
    for (const auto& slope : Phi_q.slopes)
        product.col(slope.row) += B.middleCols<3>(6 * slope.body) * slope.dr +
                                  B.middleCols<3>(6 * slope.body + 3) * slope.dpi;
    return product;
}

MatrixXd transposed(const Jacobian& Phi_q) {
    MatrixXd J_t = MatrixXd::Zero(Phi_q.columns, Phi_q.rows);
    for (const auto& slope : Phi_q.slopes) {
        J_t.col(slope.row).segment<3>(6 * slope.body) += slope.dr;
        J_t.col(slope.row).segment<3>(6 * slope.body + 3) += slope.dpi;
    }
    return J_t;
}

Projection project_gradient(const Jacobian& Phi_q, const VectorXd& g) {
    if (Phi_q.slopes.empty()) return {g, VectorXd::Zero(Phi_q.rows)};
    const Long J_t = sparse_transposed(Phi_q).cast<double>();
    if (!g.allFinite() || !J_t.coeffs().allFinite()) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        return {VectorXd::Constant(g.size(), nan), VectorXd::Constant(Phi_q.rows, nan)};
    }
    if (Phi_q.columns <= dense_columns) {
        Eigen::CompleteOrthogonalDecomposition<MatrixXd> dense;
        dense.setThreshold(rank_threshold);
        dense.compute(J_t.toDense());
        const VectorXd minus_g = -g, lambda = dense.solve(minus_g);
        return {g + J_t * lambda, lambda};
    }
    Eigen::SPQR<Long> qr;
    qr.setPivotThreshold(rank_threshold);
    qr.compute(J_t);
    VectorXd rotated = qr.matrixQ().transpose() * g;
    const VectorXd minus_g = -g, lambda = qr.solve(minus_g);
    rotated.head(qr.rank()).setZero();
    return {qr.matrixQ() * rotated, shortest(qr, lambda)};
}

}  // namespace elastocheck::reference::energy
