#include <Eigen/CholmodSupport>
#include <SuiteSparseQR.hpp>
#include <new>
#include <queue>

#include "recursive/linear_algebra/rank.hpp"
#include "recursive/linear_algebra/scattered.hpp"

namespace elastocheck::recursive {

// SuiteSparseQR factorises in a fill-reducing column order and sets aside each column that depends
// on those before it (Heath's method): A E = Q ⎡R₁ R₂⎤. A column r of R₂ is R₁ c, so that
// Eᵀ x = (-c, 1) is a null vector; where R is sparse so is c.
Columns null_space(const Rows& rows) {
    const int n = static_cast<int>(rows.cols());
    using Long = SuiteSparse_long;
    Eigen::SparseMatrix<double, Eigen::ColMajor, Long> A = rows;
    cholmod_common common;
    cholmod_l_start(&common);
    common.print = 0;
    cholmod_sparse view = Eigen::viewAsCholmod(A), *R = nullptr;
    Long* E = nullptr;
    const Long rank =
        SuiteSparseQR<double>(SPQR_ORDERING_DEFAULT, rank_threshold, 0, &view, &R, &E, &common);
    std::vector<Eigen::Triplet<double>> entries;
    if (rank >= 0) {
        const auto* const first = static_cast<const Long*>(R->p);
        const auto* const row = static_cast<const Long*>(R->i);
        const auto* const value = static_cast<const double*>(R->x);
        Scattered x(n);
        for (int c = static_cast<int>(rank); c < n; ++c) {
            std::priority_queue<int> unsolved;  // unknowns of the triangle, last to first
            const auto add = [&](Long k, double value_k) {
                if (x.add(static_cast<int>(k), value_k)) unsolved.push(static_cast<int>(k));
            };
            for (Long e = first[c]; e < first[c + 1]; ++e) add(row[e], -value[e]);
            while (!unsolved.empty()) {
                const int k = unsolved.top();
                unsolved.pop();
                // last entry of a column of the triangle, since rows ascend
                const Long diagonal = first[k + 1] - 1;
                x.value[k] /= value[diagonal];
                for (Long e = first[k]; e < diagonal; ++e) add(row[e], -value[e] * x.value[k]);
            }
            x.add(c, 1);
            const std::size_t begin = entries.size();
            x.append_to(entries, c - static_cast<int>(rank));
            for (std::size_t e = begin; E && e < entries.size(); ++e)
                entries[e] = {static_cast<int>(E[entries[e].row()]), entries[e].col(),
                              entries[e].value()};
            x.clear();
        }
    }
    cholmod_l_free_sparse(&R, &common);
    cholmod_l_free(static_cast<std::size_t>(n), sizeof(Long), E, &common);
    cholmod_l_finish(&common);
    if (rank < 0) throw std::bad_alloc();
    Columns basis(n, n - static_cast<Eigen::Index>(rank));
    basis.setFromTriplets(entries.begin(), entries.end());
    return basis;
}

}  // namespace elastocheck::recursive
