#include "models/eigen/sparse.hpp"

namespace Eigen {

template class SimplicialCholeskyBase<SimplicialLDLT<Columns>>;
template void SimplicialCholeskyBase<SimplicialLDLT<Columns>>::factorize_preordered<true>(
    const Columns&);
template class SimplicialLDLT<Columns>;

}  // namespace Eigen
