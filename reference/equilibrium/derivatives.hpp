// Derivatives of the system, by automatic differentiation. The only place that knows Ceres.
#pragma once

#include "reference/equilibrium/factors.hpp"
#include "reference/equilibrium/system.hpp"

namespace elastocheck::reference::equilibrium {

struct Derivatives {
    Sparse J;                // ∂E/∂(step) [n × n]
    Eigen::VectorXd E;       // [n]
    Eigen::VectorXd E_rate;  // dE/dt at fixed x along the way that `loading` is on: ∂E/∂a where t = a [n]
};

Derivatives derivatives(const System& system, const Loading& loading, const Eigen::VectorXd& x,
                        Counts& counts);

// dE/dt alone.
Eigen::VectorXd rate_of(const System& system, const Loading& loading, const Eigen::VectorXd& x);

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
