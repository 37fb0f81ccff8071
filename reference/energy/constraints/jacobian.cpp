#include "reference/energy/constraints/jacobian.hpp"

#include <Eigen/SPQRSupport>
#include <limits>

namespace elastocheck::reference::energy {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;

Sparse sparse_transposed(const Jacobian& Phi_q) {
    std::vector<Eigen::Triplet<double, SuiteSparse_long>> entries;
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

VectorXd left_over(const Jacobian& Phi_q, const VectorXd& g) {
    if (Phi_q.slopes.empty()) return g;
    const Sparse J_t = sparse_transposed(Phi_q);
    if (!g.allFinite() || !J_t.coeffs().allFinite())
        return VectorXd::Constant(g.size(), std::numeric_limits<double>::quiet_NaN());
    Eigen::SPQR<Sparse> qr;
    qr.setPivotThreshold(rank_threshold);
    qr.compute(J_t);
    VectorXd rotated = qr.matrixQ().transpose() * g;
    rotated.head(qr.rank()).setZero();
    return qr.matrixQ() * rotated;
}

}  // namespace elastocheck::reference::energy
