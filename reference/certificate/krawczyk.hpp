// Krawczyk's existence and uniqueness test (Krawczyk 1969; Moore 1977), in doubles with bounded
// rounding errors.
//
// For the box [y] = ỹ ± r and any matrix Y, in practice Y ≈ F'(ỹ)⁻¹,
//
//   |Y F(ỹ)| + |I - Y F'([y])| r < r   ⟹   F has exactly one zero in [y]
//
// because y - Y F(y) then maps [y] into its interior, and is a contraction there. F' is an interval
// matrix M ± R. With the unit roundoff u and p the most entries of a column of M,
//
//   |I - Y F'| r ≤ |I - fl(Y M)| r + γ_p |Y| (|M| r) + |Y| (R r),     γ_p = p u / (1 - p u)
//
// for any order of summation of the products. All sums on the right have nonnegative terms: each is
// computed directly and increased by more than its possible rounding loss.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/certificate/interval/interval.hpp"
#include "reference/certificate/statement/bordered.hpp"

namespace elastocheck::reference::certificate {

// Upper bound of A x, for A and x ≥ 0.
Eigen::VectorXd product_bound(const Eigen::MatrixXd& A, const Eigen::VectorXd& x);
Eigen::MatrixXd product_bounds(const Eigen::MatrixXd& A, const Eigen::MatrixXd& x);
Eigen::VectorXd product_bound(const SparseMatrix& A, const Eigen::VectorXd& x);

// F' = M ± R, where most entries are zero.
struct Split {
    SparseMatrix M, R;
    double gamma = 0;  // of a product with M
    bool finite = false;
};
Split split(const SparseRows<Interval>& J);
// fl(Y M)
Eigen::MatrixXd product(const Eigen::MatrixXd& Y, const SparseMatrix& M);

struct Contraction {
    Eigen::MatrixXd rest, Y;  // |I - fl(Y M)|, |Y|
    SparseMatrix M, R;        // |M|, and the radii
    double gamma = 0;
    bool finite = false;
    // Upper bound of |I - Y F'| r.
    Eigen::VectorXd operator()(const Eigen::VectorXd& r) const;
};
Contraction contraction(const Eigen::MatrixXd& Y, const SparseRows<Interval>& J);

// An r with `first` + |I - Y F'| r < r, by solving the fixed-point equation: across the corner of a
// stop r is many times `first`. Empty if none is found.
Eigen::VectorXd passing_radii(const Eigen::VectorXd& first, const Contraction& rest);

// Upper bound of |Y F|.
Eigen::VectorXd defect_bound(const Eigen::MatrixXd& Y, const Values<Interval>& F);

// The terms of the inequality for a system too large to keep Y. Each row of the inequality needs
// the same row of Y alone, which is solved for and discarded.
struct OverRows {
    Eigen::VectorXd defect;  // |Y F|
    Eigen::MatrixXd rest;    // |I - Y F'| r for each box, in columns
};
// J [box]: over each box, all with the M of the first; r [n × boxes].
OverRows over_rows(const Factors& factors, const Values<Interval>& F, const std::vector<Split>& J,
                   const Eigen::MatrixXd& r);
// An interval matrix with the given middle M that contains `original`.
Split recentred(const Split& original, const SparseMatrix& M);

inline bool all_less(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return (a.array() < b.array()).all();  // false for a NaN entry
}

}  // namespace elastocheck::reference::certificate
