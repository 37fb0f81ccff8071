// Krawczyk's test, in doubles whose rounding is bounded. For every y in [y] = ỹ ± r,
//
//   |Y F(ỹ)| + |I - Y F'([y])| r < r   ⟹   one and only one zero of F in [y]
//
// F' is a matrix of intervals M ± R, and with u the unit of rounding, p the most entries of a column of M,
//
//   |I - Y F'| r ≤ |I - fl(Y M)| r + γ_p |Y| (|M| r) + |Y| (R r),     γ_p = p u / (1 - p u)
//
// whatever order the products are summed in. All sums on the right are of numbers that are not negative: each is computed
// as it stands and raised by more than it can have lost.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/certificate/interval.hpp"

namespace elastocheck::reference::certificate {

// At least A x, A and x ≥ 0.
Eigen::VectorXd above(const Eigen::MatrixXd& A, const Eigen::VectorXd& x);

struct Contraction {
    Eigen::MatrixXd rest;     // |I - fl(Y M)|
    Eigen::MatrixXd Y, M, R;  // |Y|, |M|, and the radii
    double gamma = 0;
    bool finite = false;
    // At least |I - Y F'| r.
    Eigen::VectorXd operator()(const Eigen::VectorXd& r) const;
};
// J by rows.
Contraction contraction(const Eigen::MatrixXd& Y, const std::vector<Interval>& J);

// An r with `first` + |I - Y F'| r < r, from the fixed point of that by solving for it: over the corner of a stop r is many
// times `first`. Empty where there is none.
Eigen::VectorXd passing(const Eigen::VectorXd& first, const Contraction& rest);

// At least |Y F|.
Eigen::VectorXd step(const Eigen::MatrixXd& Y, const std::vector<Interval>& F);

inline bool all_less(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return (a.array() < b.array()).all();  // false where anything is NaN
}

}  // namespace elastocheck::reference::certificate
