// Proof that every stiffness over a box is positive, by a verified Cholesky factorisation.
#pragma once

#include "reference/certificate/statement/bordered.hpp"

namespace elastocheck::reference::certificate {

// Proves xᵀ H x > 0 for every motion x that the joints allow and that is not idle,
// H = -∂(balances)/∂(δr, δπ) anywhere in the box; J by rows is the Jacobian of the problem over the
// box. False: not proved.
bool stable(const Problem& problem, const std::vector<Interval>& z, const std::vector<Interval>& J);

// Whether every symmetric matrix within M ± R is positive definite.
bool positive_definite(const Eigen::MatrixXd& M, const Eigen::MatrixXd& R);

}  // namespace elastocheck::reference::certificate
