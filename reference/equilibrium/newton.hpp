// Solving the system at one loading, and its Jacobian. The only place that knows Ceres.
#pragma once

#include "reference/equilibrium/solve.hpp"
#include "reference/equilibrium/system.hpp"

namespace elastocheck::reference::equilibrium {

struct Attempt {
    Eigen::VectorXd x;
    double residual = 0;       // largest entry of |E|, from an evaluation of our own; NaN when there is none
    bool out_of_time = false;  // the iteration limit came before a standstill
};

Attempt newton(const System& system, const Loading& loading, const Eigen::VectorXd& start,
               const Options& options, Counts& counts);

// ∂E/∂(step) [n × n], by automatic differentiation.
Eigen::MatrixXd jacobian(const System& system, double load_factor, const Eigen::VectorXd& x, Counts& counts);

}  // namespace elastocheck::reference::equilibrium
