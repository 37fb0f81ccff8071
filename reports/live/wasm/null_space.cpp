// recursive::null_space() by Eigen's sparse QR, in place of SuiteSparse's, which has no WebAssembly.
#include <Eigen/OrderingMethods>
#include <Eigen/SparseQR>

#include "recursive/linear_algebra/rank.hpp"
#include "recursive/linear_algebra/scattered.hpp"

namespace elastocheck::recursive {

// A E = Q ⎡R₁ R₂⎤, columns that depend on others last. A column r of R₂ is R₁ c, so that Eᵀ x = (-c, 1) is a null vector.
Columns null_space(const Rows& rows) {
    const Eigen::Index n = rows.cols();
    Columns A = rows;
    A.makeCompressed();
    if (A.rows() == 0) {
        Columns all(n, n);
        all.setIdentity();
        return all;
    }
    Eigen::SparseQR<Columns, Eigen::COLAMDOrdering<int>> factors;
    factors.setPivotThreshold(rank_threshold);
    factors.compute(A);
    const Eigen::Index rank = factors.rank();
    const Eigen::MatrixXd R = Eigen::MatrixXd(factors.matrixR()).topRows(rank);
    const Eigen::MatrixXd c =
        R.leftCols(rank).triangularView<Eigen::Upper>().solve(R.rightCols(n - rank));
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index k = 0; k < n - rank; ++k) {
        Scattered x(n);
        for (Eigen::Index i = 0; i < rank; ++i)
            if (c(i, k) != 0) x.add(factors.colsPermutation().indices()[i], -c(i, k));
        x.add(factors.colsPermutation().indices()[rank + k], 1);
        x.append_to(entries, static_cast<int>(k));
    }
    Columns basis(n, n - rank);
    basis.setFromTriplets(entries.begin(), entries.end());
    return basis;
}

}  // namespace elastocheck::recursive
