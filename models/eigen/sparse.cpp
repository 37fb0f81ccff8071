#include "models/eigen/sparse.hpp"

namespace Eigen {

template class SimplicialCholeskyBase<SimplicialLDLT<Columns>>;
template void SimplicialCholeskyBase<SimplicialLDLT<Columns>>::factorize_preordered<true>(
    const Columns&);
template void SimplicialCholeskyBase<SimplicialLDLT<Columns>>::_solve_impl(
    const MatrixBase<VectorXd>&, MatrixBase<VectorXd>&) const;
template void SimplicialCholeskyBase<SimplicialLDLT<Columns>>::_solve_impl(
    const MatrixBase<MatrixXd>&, MatrixBase<MatrixXd>&) const;
template class SimplicialLDLT<Columns>;

}  // namespace Eigen
