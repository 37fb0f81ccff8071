#include "reference/equilibrium/linear_algebra/factors.hpp"

#include <klu.h>

#include <Eigen/SPQRSupport>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace elastocheck::reference::equilibrium {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Threshold pivoting: a pivot may be this much smaller than the largest of its column to reduce
// fill-in. Newton's method recovers the lost digits.
constexpr double pivot_preference = 0.1;

klu_common settings() {
    klu_common common;
    klu_defaults(&common);
    common.tol = pivot_preference;
    return common;
}

// KLU takes read-only arguments as non-const.
int* starts(const Sparse& A) { return const_cast<int*>(A.outerIndexPtr()); }
int* rows(const Sparse& A) { return const_cast<int*>(A.innerIndexPtr()); }
double* values(const Sparse& A) { return const_cast<double*>(A.valuePtr()); }

int parity(const int* permutation, Index n) {
    std::vector<bool> seen(static_cast<std::size_t>(n));
    int sign = 1;
    for (Index k = 0; k < n; ++k)
        for (Index at = k; !seen[static_cast<std::size_t>(at)]; at = permutation[at]) {
            seen[static_cast<std::size_t>(at)] = true;
            if (permutation[at] != k) sign = -sign;
        }
    return sign;
}

}  // namespace

struct Order {
    std::vector<int> start, row;  // of the pattern it belongs to
    klu_symbolic* symbolic = nullptr;
    explicit Order(const Sparse& A)
        : start(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1),
          row(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros()) {
        klu_common common = settings();
        symbolic = klu_analyze(static_cast<int>(A.cols()), starts(A), rows(A), &common);
    }
    Order(const Order&) = delete;
    Order& operator=(const Order&) = delete;
    ~Order() {
        klu_common common = settings();
        klu_free_symbolic(&symbolic, &common);
    }
    bool is_for(const Sparse& A) const {
        return std::equal(start.begin(), start.end(), A.outerIndexPtr(),
                          A.outerIndexPtr() + A.cols() + 1) &&
               std::equal(row.begin(), row.end(), A.innerIndexPtr(),
                          A.innerIndexPtr() + A.nonZeros());
    }
};

struct Pivots {
    klu_numeric* numeric = nullptr;
    Pivots(const Sparse& A, const Order& order) {
        klu_common common = settings();
        if (order.symbolic != nullptr)
            numeric = klu_factor(starts(A), rows(A), values(A), order.symbolic, &common);
        if (common.status != KLU_OK) klu_free_numeric(&numeric, &common);
    }
    Pivots(const Pivots&) = delete;
    Pivots& operator=(const Pivots&) = delete;
    ~Pivots() {
        klu_common common = settings();
        klu_free_numeric(&numeric, &common);
    }
};

bool is_finite(const Sparse& A) {
    return Eigen::Map<const VectorXd>(A.valuePtr(), A.nonZeros()).allFinite();
}

double largest_entry(const Sparse& A) {
    return A.nonZeros() == 0
               ? 0
               : Eigen::Map<const VectorXd>(A.valuePtr(), A.nonZeros()).cwiseAbs().maxCoeff();
}

// KLU form: L U + F = R⁻¹ P A Q with F above the diagonal blocks of U, R > 0.
Factors::Factors(const Sparse& A, const Factors* same_pattern) : size_(A.cols()) {
    if (size_ == 0) return;
    const bool known =
        same_pattern != nullptr && same_pattern->order_ && same_pattern->order_->is_for(A);
    order_ = known ? same_pattern->order_ : std::make_shared<const Order>(A);
    pivots_ = std::make_shared<Pivots>(A, *order_);
    const klu_numeric* numeric = pivots_->numeric;
    if (numeric == nullptr) return;
    sign_ = parity(numeric->Pnum, size_) * parity(order_->symbolic->Q, size_);
    const auto* pivot = static_cast<const double*>(numeric->Udiag);
    for (Index k = 0; k < size_; ++k) sign_ *= pivot[k] > 0 ? 1 : pivot[k] < 0 ? -1 : 0;
}

double Factors::log_determinant() const {
    if (sign_ == 0) return size_ == 0 ? 0 : -std::numeric_limits<double>::infinity();
    const klu_numeric* numeric = pivots_->numeric;
    const auto* pivot = static_cast<const double*>(numeric->Udiag);
    double sum = 0;
    for (Index k = 0; k < size_; ++k)
        sum += std::log2(std::abs(pivot[k])) + (numeric->Rs ? std::log2(numeric->Rs[k]) : 0);
    return sum;
}

double Factors::condition(const Sparse& A) const {
    if (sign_ == 0) return std::numeric_limits<double>::infinity();
    klu_common common = settings();
    klu_condest(starts(A), values(A), order_->symbolic, pivots_->numeric, &common);
    return common.condest;
}

MatrixXd Factors::solve(MatrixXd right) const {
    if (sign_ == 0) right.setConstant(std::numeric_limits<double>::quiet_NaN());
    klu_common common = settings();
    if (right.size() > 0 && sign_ != 0)
        klu_solve(order_->symbolic, pivots_->numeric, static_cast<int>(right.rows()),
                  static_cast<int>(right.cols()), right.data(), &common);
    return right;
}

MatrixXd Factors::solve_transposed(MatrixXd right) const {
    if (sign_ == 0) right.setConstant(std::numeric_limits<double>::quiet_NaN());
    klu_common common = settings();
    if (right.size() > 0 && sign_ != 0)
        klu_tsolve(order_->symbolic, pivots_->numeric, static_cast<int>(right.rows()),
                   static_cast<int>(right.cols()), right.data(), &common);
    return right;
}

// A P = Q R,  R = [R₁ R₂; 0 ~0]:  A P [-R₁⁻¹ R₂; 1] = 0, and the last columns of Q span the left
// null space.
NullBases null_bases(const Sparse& A, double threshold) {
    const Index n = A.cols();
    Eigen::SPQR<Sparse> qr;
    qr.setPivotThreshold(threshold);
    qr.compute(A);
    const Index rank = qr.rank(), k = n - rank;
    if (k == 0) return {Sparse(n, 0), Sparse(n, 0)};
    Sparse R = qr.matrixR(), R_1 = R.topLeftCorner(rank, rank), V = R.topRightCorner(rank, k);
    R_1.template triangularView<Eigen::Upper>().solveInPlace(V);
    std::vector<Eigen::Triplet<double>> right;
    const auto P = qr.colsPermutation().indices();
    for (Index j = 0; j < k; ++j) {
        for (Sparse::InnerIterator at(V, j); at; ++at)
            right.emplace_back(static_cast<int>(P[at.row()]), static_cast<int>(j), -at.value());
        right.emplace_back(static_cast<int>(P[rank + j]), static_cast<int>(j), 1.);
    }
    NullBases bases{Sparse(n, k), {}};
    bases.right.setFromTriplets(right.begin(), right.end());
    MatrixXd last = MatrixXd::Zero(n, k);
    last.bottomRows(k).setIdentity();
    const MatrixXd left = qr.matrixQ() * last;
    bases.left = left.sparseView();
    return bases;
}

}  // namespace elastocheck::reference::equilibrium
