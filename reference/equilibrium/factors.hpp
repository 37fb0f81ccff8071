// Factors of sparse matrices, behind plain calls: LU (KLU) for what is regular, QR (SPQR) for what may not be.
//
// The order of elimination is that of the pattern; whoever factorises the same pattern again hands on the factors
// before, and the order is not sought anew.
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
    explicit Factors(const Sparse& A, const Factors* of_such = nullptr);

    // Of the determinant: 0 where a pivot is zero, and then nothing is solved.
    int sign() const { return sign_; }
    Eigen::Index size() const { return size_; }

    // Of A, columns and rows scaled to size one: the condition number in the norm of sums (Higham and Tisseur's
    // estimate), infinite where a pivot is zero.
    double condition(const Sparse& A) const;

    Eigen::MatrixXd solve(Eigen::MatrixXd right) const;             // A x = b, column by column
    Eigen::MatrixXd solve_transposed(Eigen::MatrixXd right) const;  // Aᵀ x = b

  private:
    Eigen::Index size_ = 0;
    int sign_ = 0;
    std::shared_ptr<const Order> order_;
    std::shared_ptr<Pivots> pivots_;
};

// Bases of the vectors that A (square) takes to nothing, and that it never reaches: A right = 0, Aᵀ left = 0. Neither is
// orthonormal; both are sparse where they can be. A column that is within `threshold` of those before it is taken to
// depend on them.
struct NullBases {
    Sparse right, left;
};
NullBases null_bases(const Sparse& A, double threshold);

}  // namespace elastocheck::reference::equilibrium
