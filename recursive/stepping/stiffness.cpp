#include "recursive/stepping/stiffness.hpp"

#include <Eigen/Eigenvalues>

namespace elastocheck::recursive::detail {

LeastStiffness least_of(const Eigen::MatrixXd& H) {
    // If K is symmetric, H is nearly so: each θ of H = S + N is within |N| of one of S (Bauer and
    // Fike 1960).
    constexpr double rounding = 1e-6, may_matter = 1e-3;
    if (H.size() == 0 || !H.allFinite()) return {std::numeric_limits<double>::quiet_NaN(), true};
    const Eigen::MatrixXd S = (H + H.transpose()) / 2;
    const double size = H.norm(), skew = (H - S).norm();
    if (!(skew <= may_matter * size)) return {1 / H.eigenvalues().cwiseAbs().maxCoeff(), false};
    const Eigen::VectorXd theta =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues();
    const bool negative = theta[0] < -std::max(rounding * size, 2 * skew);
    return {1 / (negative ? theta[0] : theta[theta.size() - 1]), true};
}

}  // namespace elastocheck::recursive::detail
