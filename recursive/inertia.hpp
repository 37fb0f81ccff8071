// Whether an equilibrium is unstable: whether the energy falls along a motion that the joints allow.
//
// With Z the motions that they allow, ZᵀKZ is positive definite if and only if K + ρ Φ_qᵀ Φ_q is for some ρ (Finsler, Debreu);
// and that has as many negative eigenvalues as its LDLᵀ has negative pivots (Sylvester). One factorisation sees every
// mode, however stiff, and any number of them: the few softest (stiffness.hpp) are not all, and two that are negative leave
// the determinant's sign as it was.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "recursive/march.hpp"

namespace elastocheck::recursive {

// Whether the work of all forces is that of an energy: a load that turns with its body has none, and the symmetric part of
// its K says nothing.
bool has_energy(const Model& model, const Branch& branch);

// Of the matrix of (24) [n + m square], in the norm |W x|, `weight` [n]; of every idle mode an unknown that is large in
// it is held. False where round-off may be what is negative, which grows with ρ, and where K is not symmetric.
bool is_unstable(const Eigen::SparseMatrix<double>& saddle, const Eigen::VectorXd& weight,
                 const std::vector<int>& held);

// Of the equilibrium whose consistent tangent is in the system.
template <class Real>
bool is_unstable(const March<Real>& s) {
    if (s.free <= 0 || sizeof(Real) < sizeof(double) || !has_energy(s.model, s.branch)) return false;
    const Held<Real>& idle = s.system.held;
    std::vector<int> held;
    for (int c = 0; c < idle.idle; ++c) {
        int largest = -1;
        Real size = 0;
        for (int e = idle.begin(c); e < idle.end(c); ++e) {
            const auto at = static_cast<std::size_t>(e);
            const int row = idle.row[at];
            if (const Real here = std::abs(idle.value[at] * s.system.weight[row]);
                here > size && std::ranges::find(held, row) == held.end())
                largest = row, size = here;
        }
        if (largest >= 0) held.push_back(largest);
    }
    return is_unstable(sparse(s.system.M).template cast<double>(),
                       s.system.weight.head(s.n()).template cast<double>(), held);
}

}  // namespace elastocheck::recursive
