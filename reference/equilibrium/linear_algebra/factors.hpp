// Sparse factorisations: LU (KLU) for regular matrices, QR (SPQR) for matrices that
// may be singular.
//
// The elimination order depends only on the pattern.
#pragma once

#include <Eigen/SparseCore>
#include <memory>

namespace elastocheck::reference::equilibrium {

using Sparse = Eigen::SparseMatrix<double>;

bool is_finite(const Sparse& A);
double largest_entry(const Sparse& A);  // absolute

struct Order;
struct Pivots;

class Factors {
  public:
    Factors() = default;
    // `same_pattern`: factors whose elimination order is used again if their pattern is that of A.
    explicit Factors(const Sparse& A, const Factors* same_pattern = nullptr);

    // Sign of the determinant: 0 where a pivot is zero; solve() is then not available.
    int sign() const { return sign_; }
    Eigen::Index size() const { return size_; }
    // log₂ |determinant|; -infinity where a pivot is zero
    double log_determinant() const;

    // `A`: the factorised matrix. Its condition number in the 1-norm, rows and columns scaled to size one (Higham & Tisseur
    // 2000 estimate); infinite where a pivot is zero.
    double condition(const Sparse& A) const;

    Eigen::MatrixXd solve(Eigen::MatrixXd right) const;             // A x = b, column by column
    Eigen::MatrixXd solve_transposed(Eigen::MatrixXd right) const;  // Aᵀ x = b

  private:
    Eigen::Index size_ = 0;
    int sign_ = 0;
    std::shared_ptr<const Order> order_;
    std::shared_ptr<Pivots> pivots_;
};

// Bases of the null spaces of A (square) and Aᵀ: A right = 0, Aᵀ left = 0. Neither is orthonormal;
// both are sparse where possible. A column whose distance from the span of those before it is
// at most `threshold`, in the unit of A's entries, counts as dependent.
struct NullBases {
    Sparse right, left;
};
NullBases null_bases(const Sparse& A, double threshold);

}  // namespace elastocheck::reference::equilibrium
