// Explicit instantiation of Eigen's sparse LDLᵀ factorisation (in sparse.cpp); see dense.hpp.
// Included by the precompiled headers of the solvers only.
#pragma once

#include <Eigen/SparseCholesky>

namespace Eigen {

using Columns = SparseMatrix<double>;  // as in the code of the solvers
extern template class SimplicialCholeskyBase<SimplicialLDLT<Columns>>;
extern template void SimplicialCholeskyBase<SimplicialLDLT<Columns>>::factorize_preordered<true>(
    const Columns&);
extern template void SimplicialCholeskyBase<SimplicialLDLT<Columns>>::_solve_impl(
    const MatrixBase<VectorXd>&, MatrixBase<VectorXd>&) const;
extern template void SimplicialCholeskyBase<SimplicialLDLT<Columns>>::_solve_impl(
    const MatrixBase<MatrixXd>&, MatrixBase<MatrixXd>&) const;
extern template class SimplicialLDLT<Columns>;

}  // namespace Eigen
