#include "reference/certificate/krawczyk.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

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
VectorXd above(const SparseMatrix& A, const VectorXd& x) { return raised(A * x, A.cols()); }

VectorXd Contraction::operator()(const VectorXd& r) const {
    return raised(above(rest, r) + above(Y, above(R, r)) + gamma * above(Y, above(M, r)), 4);
}

Split split(const std::vector<Interval>& J, Index n) {
    Split of;
    std::vector<Eigen::Triplet<double>> M, R;
    std::vector<Index> entries(static_cast<std::size_t>(n));  // of each column
    for (Index k = 0; k < n * n; ++k) {
        const Interval& entry = J[static_cast<std::size_t>(k)];
        if (is_zero(entry)) continue;
        if (!bounded(entry)) return of;
        M.emplace_back(k / n, k % n, mid(entry));
        if (const double radius = rad(entry); radius > 0) R.emplace_back(k / n, k % n, radius);
        ++entries[static_cast<std::size_t>(k % n)];
    }
    of.M.resize(n, n), of.R.resize(n, n);
    of.M.setFromTriplets(M.begin(), M.end());
    of.R.setFromTriplets(R.begin(), R.end());
    of.gamma = gamma((n > 0 ? *std::ranges::max_element(entries) : 0) + 2);
    of.finite = true;
    return of;
}

MatrixXd product(const MatrixXd& Y, const SparseMatrix& M) {
    MatrixXd sum = MatrixXd::Zero(Y.rows(), M.cols());
    for (Index column = 0; column < M.cols(); ++column)
        for (SparseMatrix::InnerIterator at(M, column); at; ++at)
            sum.col(column) += Y.col(at.row()) * at.value();
    return sum;
}

Contraction contraction(const MatrixXd& inverse, const std::vector<Interval>& J) {
    const Index n = inverse.rows();
    Contraction of;
    Split parts = split(J, n);
    if (!parts.finite) return of;
    of.rest = (MatrixXd::Identity(n, n) - product(inverse, parts.M)).cwiseAbs();
    of.Y = inverse.cwiseAbs();
    of.M = parts.M.cwiseAbs();
    of.R = std::move(parts.R);
    of.gamma = parts.gamma;
    of.finite = std::isfinite(of.rest.sum() + of.Y.sum() + of.R.sum());  // none is negative
    return of;
}

VectorXd passing(const VectorXd& first, const Contraction& rest) {
    constexpr double least = 1e-20;
    const Index n = first.size();
    const VectorXd covered = first.cwiseMax(least) * 1.05;
    const MatrixXd A =
        MatrixXd::Identity(n, n) - rest.rest - product(rest.Y, rest.R + rest.gamma * rest.M);
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
