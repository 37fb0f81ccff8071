// Nonlinear least squares within bounds: Levenberg and Marquardt's method on a bounded linear
// problem.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace elastocheck::compare {

struct Box {
    Eigen::VectorXd low, high;
};

// The x within the box that minimises |A x - b|². A has full column rank, and the box contains
// zero. Active-set method: from a feasible point to the minimum over the free x, or to the first
// bound on the way; a bound whose multiplier has the wrong sign is released.
Eigen::VectorXd bounded_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                      const Box& box);

struct LeastSquares {
    std::function<Eigen::VectorXd(const Eigen::VectorXd& x)> residual;  // NaN where there is none
    std::function<Eigen::MatrixXd(const Eigen::VectorXd& x)> jacobian;
};

struct Minimum {
    Eigen::VectorXd x, residual;
    Eigen::MatrixXd jacobian;  // at x
    int iterations = 0;
    // no step within the bounds decreases |residual|² by more than 1e-13 of itself
    bool converged = false;
};

// Minimises |r(x)|² within the box. A step d minimises |r + J d|² + λ |d|² over the box; λ is zero
// as long as the steps decrease |r|. `start` is within the box and has a residual.
Minimum minimise(const LeastSquares& problem, Eigen::VectorXd start, const Box& box);

}  // namespace elastocheck::compare
