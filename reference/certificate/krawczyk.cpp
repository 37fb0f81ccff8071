#include "reference/certificate/krawczyk.hpp"

#include <Eigen/LU>

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

// Upper bound of an exact sum of n nonnegative numbers from the computed one, including the few
// operations around it; underflow loses less than the least normal number per term.
VectorXd raised(const VectorXd& sum, Index n) {
    const double by = 1 + 4 * static_cast<double>(n + 8) * unit;
    return (sum * by).array() + static_cast<double>(n + 1) * std::numeric_limits<double>::min();
}

double gamma(Index p) {
    const double pu = static_cast<double>(p) * unit;
    return 1.01 * pu / (1 - pu);
}

}  // namespace

VectorXd above(const MatrixXd& A, const VectorXd& x) { return raised(A * x, A.cols()); }

VectorXd Contraction::operator()(const VectorXd& r) const {
    return raised(above(rest, r) + above(Y, above(R, r)) + gamma * above(Y, above(M, r)), 4);
}

Contraction contraction(const MatrixXd& inverse, const std::vector<Interval>& J) {
    const Index n = inverse.rows();
    Contraction of;
    of.M = of.R = MatrixXd::Zero(n, n);
    MatrixXd product = MatrixXd::Zero(n, n);  // fl(Y M), over the entries of M, most are zero
    Index most = 0;
    for (Index col = 0; col < n; ++col) {
        Index entries = 0;
        for (Index row = 0; row < n; ++row) {
            const Interval& entry = J[static_cast<std::size_t>(row * n + col)];
            if (is_zero(entry)) continue;
            if (!bounded(entry)) return of;
            of.M(row, col) = mid(entry);
            of.R(row, col) = rad(entry);
            ++entries;
            product.col(col) += inverse.col(row) * of.M(row, col);
        }
        most = std::max(most, entries);
    }
    of.rest = (MatrixXd::Identity(n, n) - product).cwiseAbs();
    of.Y = inverse.cwiseAbs();
    of.M = of.M.cwiseAbs();
    of.gamma = gamma(most + 2);
    of.finite = std::isfinite(of.rest.sum() + of.Y.sum() + of.R.sum());  // none is negative
    return of;
}

VectorXd passing(const VectorXd& first, const Contraction& rest) {
    constexpr double least = 1e-20;
    const Index n = first.size();
    const VectorXd covered = first.cwiseMax(least) * 1.05;
    const MatrixXd A =
        MatrixXd::Identity(n, n) - rest.rest - rest.Y * (rest.R + rest.gamma * rest.M);
    const VectorXd r = Eigen::PartialPivLU<MatrixXd>(A).solve(covered);
    return r.allFinite() && all_less((first + rest(r.cwiseMax(0))) * (1 + 1e-14), r) ? r
                                                                                     : VectorXd();
}

VectorXd step(const MatrixXd& Y, const std::vector<Interval>& F) {
    const Index n = Y.rows();
    VectorXd f(n), radius(n);
    for (Index k = 0; k < n; ++k) {
        const Interval& entry = F[static_cast<std::size_t>(k)];
        if (!bounded(entry)) return VectorXd::Constant(n, std::numeric_limits<double>::infinity());
        f[k] = mid(entry);
        radius[k] = rad(entry);
    }
    const MatrixXd size = Y.cwiseAbs();
    const VectorXd lost = gamma(n + 2) * above(size, f.cwiseAbs()) + above(size, radius);
    return raised((Y * f).cwiseAbs() + lost, 4);
}

}  // namespace elastocheck::reference::certificate
