// Proof that every stiffness over a box is positive, by a verified Cholesky factorisation.
#pragma once

#include "reference/certificate/statement/bordered.hpp"

namespace elastocheck::reference::certificate {

// Proves xᵀ H x > 0 for every motion x that the joints allow and that is not idle,
// H = -∂(balances)/∂(δr, δπ) anywhere in the box; J is the Jacobian of the problem over the box.
// False: not proved.
bool is_stable(const Problem& problem, const std::vector<Interval>& z,
               const SparseRows<Interval>& J);

// Whether every symmetric matrix within M ± R is positive definite; true: proved.
bool is_positive_definite(const SparseMatrix& M, const SparseMatrix& R);

}  // namespace elastocheck::reference::certificate
