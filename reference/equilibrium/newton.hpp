// Solving the system at one loading.
#pragma once

#include "reference/equilibrium/derivatives.hpp"
#include "reference/equilibrium/linearisation.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck::reference::equilibrium {

struct Attempt {
    Eigen::VectorXd x;
    double residual = 0;       // largest entry of |E|, from an evaluation of our own; NaN when there is none
    bool out_of_time = false;  // the iteration limit came before a standstill
};

// `near`: the system where the step to `start` began; regular.
Attempt newton(const System& system, const Loading& loading, const Eigen::VectorXd& start,
               const Linearisation& near, const Options& options, Counts& counts);

}  // namespace elastocheck::reference::equilibrium
