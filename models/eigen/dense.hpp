// Explicit instantiation of Eigen's dense decompositions of MatrixXd (in dense.cpp).
//
// Included by the precompiled headers only. It defines nothing: a file that includes only Eigen
// instantiates the same code itself.
#pragma once

#include <Eigen/Dense>

namespace Eigen {

extern template class HouseholderQR<MatrixXd>;
extern template class ColPivHouseholderQR<MatrixXd>;
extern template class CompleteOrthogonalDecomposition<MatrixXd>;
extern template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(const VectorXd&,
                                                                            VectorXd&) const;
extern template class JacobiSVD<MatrixXd>;
extern template SelfAdjointEigenSolver<Matrix<double, 6, 6>>&
SelfAdjointEigenSolver<Matrix<double, 6, 6>>::compute(const EigenBase<Matrix<double, 6, 6>>&, int);

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
