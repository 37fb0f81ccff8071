// Derivatives of the system by automatic differentiation. Only the source of this header uses
// Ceres.
#pragma once

#include "reference/equilibrium/linear_algebra/factors.hpp"
#include "reference/equilibrium/statement/system.hpp"

namespace elastocheck::reference::equilibrium {

struct Derivatives {
    Sparse J;                // ∂E/∂(step) [n × n]
    Eigen::VectorXd E;       // [n]
    Eigen::VectorXd E_rate;  // dE/dt at fixed x along the stage of `loading`: ∂E/∂a where t = a [n]
};

Derivatives derivatives(const System& system, const Loading& loading, const Eigen::VectorXd& x,
                        Counts& counts);

// Adds reactions R [m] to those of `result`: E is linear in them, so only the constraints are
// evaluated again, at the poses of x.
void add_reactions(const System& system, const Loading& loading, const Eigen::VectorXd& x,
                   const Eigen::VectorXd& R, Derivatives& result, Counts& counts);

// dE/dt alone [n]: only the terms that depend on t are evaluated.
Eigen::VectorXd rate_of(const System& system, const Loading& loading, const Eigen::VectorXd& x);

// A deformation whose law is a curve, and its rate.
struct CurveDeformation {
    std::size_t element, axis;
    const Curve* curve;
    double size;  // reference size of the deformation: L [m] or 1 [rad]
    double x;     // [m] or [rad]
    double rate;  // dx/dt along the stage of `loading`, the state changing by dx/dt [n]
};

// Deformation rates e' of the elements along dx [n] and the forces of their laws, (∂²u/∂e²) e' over
// F L, six rows per element (of a spring the first). They are in the element's axes, where a soft
// axis keeps its digits beside stiff ones. A force that is only rounding is zero.
struct DeformationRates {
    Eigen::VectorXd rate, force_rate;
};
DeformationRates deformation_rates(const System& system, const Loading& loading,
                                   const Eigen::VectorXd& x, const Eigen::VectorXd& dx);

// The deformations at x whose laws are curves, with dx/dt = `rate` [n].
std::vector<CurveDeformation> curve_deformations(const System& system, const Loading& loading,
                                                 const Eigen::VectorXd& x,
                                                 const Eigen::VectorXd& rate);

}  // namespace elastocheck::reference::equilibrium
