// Newton's method for the system at one loading.
#pragma once

#include "elastocheck/equilibrium.hpp"
#include "reference/equilibrium/linear_algebra/derivatives.hpp"
#include "reference/equilibrium/linear_algebra/linearisation.hpp"

namespace elastocheck::reference::equilibrium {

struct Attempt {
    Eigen::VectorXd x;
    double residual = 0;       // largest entry of |E|, evaluated at x; NaN when there is none
    bool out_of_time = false;  // stopped at the iteration limit, before stagnation
};

// `near`: regular linearisation at the start of the step to `start`.
Attempt newton(const System& system, const Loading& loading, const Eigen::VectorXd& start,
               const Linearisation& near, const Options& options, Counts& counts);

}  // namespace elastocheck::reference::equilibrium
