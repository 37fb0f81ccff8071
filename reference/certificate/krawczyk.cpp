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

VectorXd product_bound(const MatrixXd& A, const VectorXd& x) {
    return raised<VectorXd>(A * x, A.cols());
}
MatrixXd product_bounds(const MatrixXd& A, const MatrixXd& x) {
    return raised<MatrixXd>(A * x, A.cols());
}
VectorXd product_bound(const SparseMatrix& A, const VectorXd& x) {
    return raised<VectorXd>(A * x, A.cols());
}

Split split(const SparseRows<Interval>& J) {
    Split parts;
    const auto n = static_cast<Index>(J.start.size()) - 1;
    std::vector<Eigen::Triplet<double>> M, R;
    std::vector<Index> entries(static_cast<std::size_t>(n));  // of each column
    for (const auto& [row, column, entry] : J.entries) {
        if (is_zero(entry)) continue;
        if (!is_bounded(entry)) return parts;
        M.emplace_back(row, column, mid(entry));
        if (const double radius = rad(entry); radius > 0) R.emplace_back(row, column, radius);
        ++entries[static_cast<std::size_t>(column)];
    }
    parts.M.resize(n, n), parts.R.resize(n, n);
    parts.M.setFromTriplets(M.begin(), M.end());
    parts.R.setFromTriplets(R.begin(), R.end());
    parts.gamma = gamma((n > 0 ? *std::ranges::max_element(entries) : 0) + 2);
    parts.finite = true;
    return parts;
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
    Contraction result;
    Split parts = split(J);
    if (!parts.finite) return result;
    result.rest = rest_of(0, inverse, parts.M);
    result.Y = inverse.cwiseAbs();
    result.M = parts.M.cwiseAbs();
    result.R = std::move(parts.R);
    result.gamma = parts.gamma;
    result.finite =
        std::isfinite(result.rest.sum() + result.Y.sum() + result.R.sum());  // none is negative
    return result;
}

VectorXd Contraction::operator()(const VectorXd& r) const {
    return raised<VectorXd>(product_bound(rest, r) +
                                product_bound(Y, product_bound(R, r) + gamma * product_bound(M, r)),
                            4);
}

VectorXd passing_radii(const VectorXd& first, const Contraction& rest) {
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

// F as |Y F| uses it, |Y F| ≤ |Y f| + |Y D| ρ + |Y| uncertainty: the middles f and D, the radii ρ of the
// laws, and the other radii with rounding as `uncertainty`.
struct Parts {
    VectorXd f, rho, uncertainty;
    SparseMatrix D;
    bool finite = false;
};
Parts parts_of(const Values<Interval>& F) {
    const auto n = static_cast<Index>(F.E.size());
    const Laws& laws = F.laws;
    Parts parts{VectorXd(n), laws.rho, VectorXd(n), SparseMatrix(n, laws.rho.size())};
    for (Index k = 0; k < n; ++k) {
        const Interval& entry = F.E[static_cast<std::size_t>(k)];
        if (!is_bounded(entry)) return parts;
        parts.f[k] = mid(entry);
        parts.uncertainty[k] = rad(entry);
    }
    std::vector<Eigen::Triplet<double>> D, radius;
    for (const auto& [row, column, entry] : laws.D) {
        if (!is_bounded(entry)) return parts;
        D.emplace_back(row, column, mid(entry));
        radius.emplace_back(row, column, rad(entry));
    }
    parts.D.setFromTriplets(D.begin(), D.end());
    SparseMatrix R(n, parts.rho.size());
    R.setFromTriplets(radius.begin(), radius.end());
    const SparseMatrix size = parts.D.cwiseAbs();
    parts.uncertainty =
        raised<VectorXd>(parts.uncertainty + product_bound(R, parts.rho) +
                             gamma(n + 2) * (parts.f.cwiseAbs() + product_bound(size, parts.rho)),
                         4);
    parts.finite = true;
    return parts;
}
VectorXd defect_bound(const MatrixXd& Y, const Parts& F) {
    if (!F.finite) return VectorXd::Constant(Y.rows(), std::numeric_limits<double>::infinity());
    return raised<VectorXd>((Y * F.f).cwiseAbs() +
                                product_bound(product(Y, F.D).cwiseAbs(), F.rho) +
                                product_bound(Y.cwiseAbs(), F.uncertainty),
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
    MatrixXd uncertainty(n, r.cols());
    for (Index k = 0; k < r.cols(); ++k) {
        const SparseMatrix& R = J[static_cast<std::size_t>(k)].R;
        uncertainty.col(k) = raised<VectorXd>(
            product_bound(R, r.col(k)) + J.front().gamma * product_bound(size, r.col(k)), 4);
    }
    OverRows bounds{VectorXd(n), MatrixXd(n, r.cols())};
    for (Index from = 0; from < n; from += at_a_time) {
        const MatrixXd Y = factors.rows_of_inverse(from, std::min(at_a_time, n - from));
        bounds.defect.segment(from, Y.rows()) = defect_bound(Y, parts);
        bounds.rest.middleRows(from, Y.rows()) = raised<MatrixXd>(
            product_bounds(rest_of(from, Y, M), r) + product_bounds(Y.cwiseAbs(), uncertainty), 4);
    }
    return bounds;
}

Split recentred(const Split& original, const SparseMatrix& M) {
    Split moved = original;
    const SparseMatrix distance = SparseMatrix(original.M - M).cwiseAbs();
    moved.R = SparseMatrix(original.R + distance) * (1 + 1e-14);
    moved.M = M;
    return moved;
}

}  // namespace elastocheck::reference::certificate
