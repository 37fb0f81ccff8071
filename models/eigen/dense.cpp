#include "models/eigen/dense.hpp"

namespace elastocheck {

Eigen::MatrixXd times_matrix(const Reflections& Q, Eigen::MatrixXd B) {
    B.applyOnTheLeft(Q);
    return B;
}
Eigen::VectorXd times_vector(const Reflections& Q, Eigen::VectorXd b) {
    b.applyOnTheLeft(Q);
    return b;
}
Eigen::VectorXd transposed_times_vector(const Reflections& Q, Eigen::VectorXd b) {
    b.applyOnTheLeft(Q.transpose());
    return b;
}

Eigen::MatrixXd matrix_Q(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr) {
    return qr.householderQ();
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A) {
    return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(A).pseudoInverse();
}

Eigen::MatrixXd inverse_of(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) { return lu.inverse(); }
double rcond_of(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) { return lu.rcond(); }
Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& A) { return A.eigenvalues(); }
Svd svd_of(const Eigen::MatrixXd& A, unsigned parts) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, parts);
    Svd result{svd.singularValues(), {}, {}};
    if (svd.computeU()) result.U = svd.matrixU();
    if (svd.computeV()) result.V = svd.matrixV();
    return result;
}
Eigen::VectorXd solve_by_qr(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
    return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(A).solve(b);
}
Eigen::MatrixXd matrix_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) { return A * B; }
Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
    return A.transpose() * B;
}
Eigen::MatrixXd congruence(const Eigen::MatrixXd& K, const Eigen::MatrixXd& Z) {
    return matrix_product(transposed_product(Z, K), Z);
}

}  // namespace elastocheck

namespace Eigen {

template class HouseholderQR<MatrixXd>;
template void HouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
template class ColPivHouseholderQR<MatrixXd>;
template class CompleteOrthogonalDecomposition<MatrixXd>;
template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(const VectorXd&,
                                                                     VectorXd&) const;
template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl_transposed<false>(
    const VectorXd&, VectorXd&) const;
template void PartialPivLU<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
template void ColPivHouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
template class PartialPivLU<MatrixXd>;
template class JacobiSVD<MatrixXd>;
template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
template SelfAdjointEigenSolver<Matrix<double, 6, 6>>&
SelfAdjointEigenSolver<Matrix<double, 6, 6>>::compute(const EigenBase<Matrix<double, 6, 6>>&, int);
template EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute(const EigenBase<MatrixXd>&, bool);

template void MatrixBase<Block<MatrixXd>>::applyHouseholderOnTheLeft(
    const Block<const MatrixXd, Dynamic, 1>&, const double&, double*);
template void MatrixBase<Block<MatrixXd>>::applyHouseholderOnTheRight(
    const Block<const MatrixXd, Dynamic, 1>&, const double&, double*);

namespace internal {
template void apply_block_householder_on_the_left(Block<MatrixXd>&, const Block<MatrixXd>&,
                                                  const VectorBlock<const VectorXd>&, bool);
template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, 0, 0, 1>, 4, 4,
                            false, false>;
}  // namespace internal

}  // namespace Eigen
