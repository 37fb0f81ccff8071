// Nonlinear least squares within bounds: Levenberg and Marquardt's method of Eigen (MINPACK's lmder).
//
//   minimise  |r(P(x))|² + w² |P(x) - c|²,   P(x): the point of the box that is nearest to x
//
// w is `pull` times the largest column norm of ∂r/∂x at the start; it keeps numbers that r does not
// determine where they are. A number at a bound beyond which the sum would decrease has no column in
// the Jacobian: the steps are those of the others. A search that ends beside a point without residuals
// has not converged.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace elastocheck::compare {

struct Box {
    Eigen::VectorXd low, high;
};
Eigen::VectorXd within(const Box& box, const Eigen::VectorXd& x);  // P(x)

struct LeastSquares {
    std::function<Eigen::VectorXd(const Eigen::VectorXd& x)> residual;  // NaN where there is none
    std::function<Eigen::MatrixXd(const Eigen::VectorXd& x)> jacobian;
    Box box;
    Eigen::VectorXd centre = {};  // c
    double pull = 1e-8;
};

struct Minimum {
    Eigen::VectorXd x, residual = {};
    bool converged = false;
};

// Minimises the sum from `start`, which must be within the box.
Minimum minimise(const LeastSquares& problem, Eigen::VectorXd start);

// For each number: -1 or 1 at the lower or upper limit if |r| would decrease beyond it, else 0.
std::vector<int> limits_reached(const LeastSquares& problem, const Minimum& at);

}  // namespace elastocheck::compare
