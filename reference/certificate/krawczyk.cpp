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

constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

// Upper bound of an exact sum of n nonnegative numbers from the computed one, including the few
// operations around it; underflow loses less than the least normal number per term.
template <class X = VectorXd>
X raised(const X& sum, Index n) {
    const double factor = 1 + 4 * static_cast<double>(n + 8) * unit;
    return (sum * factor).array() + static_cast<double>(n + 1) * std::numeric_limits<double>::min();
}

double gamma(Index p) {
    const double pu = static_cast<double>(p) * unit;
    return 1.01 * pu / (1 - pu);
}

}  // namespace

VectorXd above(const MatrixXd& A, const VectorXd& x) { return raised<VectorXd>(A * x, A.cols()); }
MatrixXd above_each(const MatrixXd& A, const MatrixXd& x) {
    return raised<MatrixXd>(A * x, A.cols());
}
VectorXd above(const SparseMatrix& A, const VectorXd& x) {
    return raised<VectorXd>(A * x, A.cols());
}

Split split(const SparseRows<Interval>& J) {
    Split of;
    const auto n = static_cast<Index>(J.start.size()) - 1;
    std::vector<Eigen::Triplet<double>> M, R;
    std::vector<Index> entries(static_cast<std::size_t>(n));  // of each column
    for (const auto& [row, column, entry] : J.entries) {
        if (is_zero(entry)) continue;
        if (!bounded(entry)) return of;
        M.emplace_back(row, column, mid(entry));
        if (const double radius = rad(entry); radius > 0) R.emplace_back(row, column, radius);
        ++entries[static_cast<std::size_t>(column)];
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

namespace {

// |I - fl(Y M)|, for the rows of Y from `from` on.
MatrixXd rest_of(Index from, const MatrixXd& Y, const SparseMatrix& M) {
    MatrixXd rest = -product(Y, M);
    rest.diagonal(from).array() += 1;
    return rest.cwiseAbs();
}

}  // namespace

Contraction contraction(const MatrixXd& inverse, const SparseRows<Interval>& J) {
    Contraction of;
    Split parts = split(J);
    if (!parts.finite) return of;
    of.rest = rest_of(0, inverse, parts.M);
    of.Y = inverse.cwiseAbs();
    of.M = parts.M.cwiseAbs();
    of.R = std::move(parts.R);
    of.gamma = parts.gamma;
    of.finite = std::isfinite(of.rest.sum() + of.Y.sum() + of.R.sum());  // none is negative
    return of;
}

VectorXd Contraction::operator()(const VectorXd& r) const {
    return raised<VectorXd>(above(rest, r) + above(Y, above(R, r) + gamma * above(M, r)), 4);
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

namespace {

// F as |Y F| uses it, |Y F| ≤ |Y f| + |Y D| ρ + |Y| lost: the middles f and D, the radii ρ of the
// laws, and the other radii and rounding `lost`.
struct Parts {
    VectorXd f, rho, lost;
    SparseMatrix D;
    bool finite = false;
};
Parts parts_of(const Values<Interval>& F) {
    const auto n = static_cast<Index>(F.E.size());
    const Laws& laws = F.laws;
    Parts of{VectorXd(n), laws.rho, VectorXd(n), SparseMatrix(n, laws.rho.size())};
    for (Index k = 0; k < n; ++k) {
        const Interval& entry = F.E[static_cast<std::size_t>(k)];
        if (!bounded(entry)) return of;
        of.f[k] = mid(entry);
        of.lost[k] = rad(entry);
    }
    std::vector<Eigen::Triplet<double>> D, radius;
    for (const auto& [row, column, entry] : laws.D) {
        if (!bounded(entry)) return of;
        D.emplace_back(row, column, mid(entry));
        radius.emplace_back(row, column, rad(entry));
    }
    of.D.setFromTriplets(D.begin(), D.end());
    SparseMatrix R(n, of.rho.size());
    R.setFromTriplets(radius.begin(), radius.end());
    const SparseMatrix size = of.D.cwiseAbs();
    of.lost = raised<VectorXd>(
        of.lost + above(R, of.rho) + gamma(n + 2) * (of.f.cwiseAbs() + above(size, of.rho)), 4);
    of.finite = true;
    return of;
}
VectorXd defect_bound(const MatrixXd& Y, const Parts& F) {
    if (!F.finite) return VectorXd::Constant(Y.rows(), std::numeric_limits<double>::infinity());
    return raised<VectorXd>((Y * F.f).cwiseAbs() + above(product(Y, F.D).cwiseAbs(), F.rho) +
                                above(Y.cwiseAbs(), F.lost),
                            4);
}

}  // namespace

VectorXd defect_bound(const MatrixXd& Y, const Values<Interval>& F) {
    return defect_bound(Y, parts_of(F));
}

OverRows over_rows(const Factors& factors, const Values<Interval>& F, const std::vector<Split>& J,
                   const MatrixXd& r) {
    constexpr Index at_a_time = 32;
    const Index n = factors.size();
    const Parts parts = parts_of(F);
    const SparseMatrix& M = J.front().M;
    const SparseMatrix size = M.cwiseAbs();
    MatrixXd lost(n, r.cols());
    for (Index k = 0; k < r.cols(); ++k) {
        const SparseMatrix& R = J[static_cast<std::size_t>(k)].R;
        lost.col(k) =
            raised<VectorXd>(above(R, r.col(k)) + J.front().gamma * above(size, r.col(k)), 4);
    }
    OverRows bounds{VectorXd(n), MatrixXd(n, r.cols())};
    for (Index from = 0; from < n; from += at_a_time) {
        const MatrixXd Y = factors.rows_of_inverse(from, std::min(at_a_time, n - from));
        bounds.defect.segment(from, Y.rows()) = defect_bound(Y, parts);
        bounds.rest.middleRows(from, Y.rows()) = raised<MatrixXd>(
            above_each(rest_of(from, Y, M), r) + above_each(Y.cwiseAbs(), lost), 4);
    }
    return bounds;
}

Split recentred(const Split& of, const SparseMatrix& M) {
    Split moved = of;
    const SparseMatrix distance = SparseMatrix(of.M - M).cwiseAbs();
    moved.R = SparseMatrix(of.R + distance) * (1 + 1e-14);
    moved.M = M;
    return moved;
}

}  // namespace elastocheck::reference::certificate
