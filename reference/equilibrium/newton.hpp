// Solving the system at one loading, and its Jacobian. The only place that knows Ceres.
#pragma once

#include "reference/equilibrium/linearisation.hpp"
#include "reference/equilibrium/solve.hpp"
#include "reference/equilibrium/system.hpp"

namespace elastocheck::reference::equilibrium {

struct Attempt {
    Eigen::VectorXd x;
    double residual = 0;       // largest entry of |E|, from an evaluation of our own; NaN when there is none
    bool out_of_time = false;  // the iteration limit came before a standstill
};

// `near`: the system where the step to `start` began; regular.
Attempt newton(const System& system, const Loading& loading, const Eigen::VectorXd& start,
               const Linearisation& near, const Options& options, Counts& counts);

struct Derivatives {
    Eigen::MatrixXd J;       // ∂E/∂(step) [n × n]
    Eigen::VectorXd E_rate;  // dE/dt at fixed x along the way that `loading` is on: ∂E/∂a where t = a [n]
};

// By automatic differentiation.
Derivatives derivatives(const System& system, const Loading& loading, const Eigen::VectorXd& x,
                        Counts& counts);

// A deformation that follows a curve, and how fast it changes.
struct OnCurve {
    std::size_t element, axis;
    const Curve* curve;
    double size;  // what it is small or large beside: L [m] or 1 [rad]
    double x;     // [m] or [rad]
    double rate;  // dx/dt along the way that `loading` is on, the state changing by dx/dt [n]
};

std::vector<OnCurve> on_curves(const System& system, const Loading& loading, const Eigen::VectorXd& x,
                               const Eigen::VectorXd& rate);

}  // namespace elastocheck::reference::equilibrium
