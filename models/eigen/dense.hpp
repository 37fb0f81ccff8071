// Explicit instantiation of Eigen's decompositions of MatrixXd and of sparse matrices (in dense.cpp
// and sparse.cpp), each of which costs the compiler seconds wherever it is used.
//
// Included by the precompiled headers; a file that calls its functions includes it itself. Pass
// matrices and vectors, not expressions, to decompositions and their solve(): Eigen instantiates both
// again for every type of expression.
#pragma once

#include <Eigen/Dense>

namespace elastocheck {

// Products with Q of A = Q R, as qr.householderQ() returns it. They are functions here, since the
// members of Eigen's Householder sequence are inline: `extern template` does not apply to them.
using Reflections = Eigen::HouseholderSequence<Eigen::MatrixXd, Eigen::VectorXd>;
Eigen::MatrixXd times_matrix(const Reflections& Q, Eigen::MatrixXd B);             // Q B
Eigen::VectorXd times_vector(const Reflections& Q, Eigen::VectorXd b);             // Q b
Eigen::VectorXd transposed_times_vector(const Reflections& Q, Eigen::VectorXd b);  // Qᵀ b
// Q as a square matrix.
Eigen::MatrixXd matrix_Q(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr);
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);
Eigen::MatrixXd inverse_of(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu);
// Solution of A x = b by least squares with column-pivoted QR, of any A.
Eigen::VectorXd solve_by_qr(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
double rcond_of(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu);  // in the 1-norm, estimated
Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& A);
struct Svd {
    Eigen::VectorXd values;  // singular values, descending
    Eigen::MatrixXd U, V;    // empty unless `parts` requests them
};
Svd svd_of(const Eigen::MatrixXd& A, unsigned parts);  // Eigen::ComputeFullU, ...
// Products of matrices, which cost a second wherever a factor is an expression.
Eigen::MatrixXd matrix_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);      // A B
Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);  // Aᵀ B
Eigen::MatrixXd congruence(const Eigen::MatrixXd& K, const Eigen::MatrixXd& Z);          // Zᵀ K Z

}  // namespace elastocheck

namespace Eigen {

extern template class HouseholderQR<MatrixXd>;
extern template void HouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
extern template class ColPivHouseholderQR<MatrixXd>;
extern template class CompleteOrthogonalDecomposition<MatrixXd>;
extern template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(const VectorXd&,
                                                                            VectorXd&) const;
extern template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl_transposed<false>(
    const VectorXd&, VectorXd&) const;
extern template void PartialPivLU<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
extern template void ColPivHouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
extern template class PartialPivLU<MatrixXd>;
extern template class JacobiSVD<MatrixXd>;
extern template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
extern template SelfAdjointEigenSolver<Matrix<double, 6, 6>>&
SelfAdjointEigenSolver<Matrix<double, 6, 6>>::compute(const EigenBase<Matrix<double, 6, 6>>&, int);
extern template EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute(const EigenBase<MatrixXd>&,
                                                                      bool);

extern template void MatrixBase<Block<MatrixXd>>::applyHouseholderOnTheLeft(
    const Block<const MatrixXd, Dynamic, 1>&, const double&, double*);
extern template void MatrixBase<Block<MatrixXd>>::applyHouseholderOnTheRight(
    const Block<const MatrixXd, Dynamic, 1>&, const double&, double*);

namespace internal {
extern template void apply_block_householder_on_the_left(Block<MatrixXd>&, const Block<MatrixXd>&,
                                                         const VectorBlock<const VectorXd>&, bool);
extern template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, 0, 0, 1>,
                                   4, 4, false, false>;
}  // namespace internal

}  // namespace Eigen
