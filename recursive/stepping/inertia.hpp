// Instability of an equilibrium by the inertia of its reduced Hessian (negative eigenvalues).
//
// With Z a basis of the motions that the joints allow, ZᵀKZ is positive definite if and only if
// K + ρ Φ_qᵀ Φ_q is for some ρ (Finsler, Debreu). That matrix has as many negative eigenvalues as
// its LDLᵀ has negative pivots (Sylvester). One factorisation covers every mode of any stiffness.
// The few softest modes (stiffness.hpp) are not all, and two negative modes leave the sign of the
// determinant unchanged.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

// Whether the forces derive from an energy. A load that turns with its body has none, and then the
// symmetric part of its K does not decide stability.
bool has_energy(const Model& model, const Branch& branch);

// For the matrix of (24) [n + m square], in the norm |W x|, `weight` [n]. `held` lists one unknown
// for each idle mode, large in that mode, which is fixed. Returns false where the negative pivot
// may be round-off, which grows with ρ, and where K is not symmetric.
bool is_unstable(const Eigen::SparseMatrix<double>& saddle, const Eigen::VectorXd& weight,
                 const std::vector<int>& held);

// The same for the equilibrium whose consistent tangent is in the system.
template <class Real>
bool is_unstable(const SteppingState<Real>& s) {
    if (s.free <= 0 || sizeof(Real) < sizeof(double) || !has_energy(s.model, s.branch))
        return false;
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
