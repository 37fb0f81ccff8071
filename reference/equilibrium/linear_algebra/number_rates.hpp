// Derivatives of the system by the numbers of the model, by automatic differentiation.
//
// `rate` is a Model of the same shape with the derivatives of its numbers (models/state_rate.hpp).
// A point, axis or marker that changes within its body moves like a point of a body of its own: the
// frame that a term receives moves by that rigid motion, and the moment of its force is taken about
// the origin of the true body. Offsets, free lengths, preloads and load factors are the numbers that
// the system already differentiates by a. A law that changes adds its change of force, at a
// constant deformation, to the preload.
#pragma once

#include "reference/equilibrium/linear_algebra/derivatives.hpp"

namespace elastocheck::reference::equilibrium {

// Of a system whose drivers are frozen (state_tangent.hpp) at the parameter a of its branch.
struct NumberRate {
    const Model* rate = nullptr;  // with its branch first
    System changing;              // each quantity at the rate of the number
    // largest motion of a feature within its body, or change of an undeformed length, over L or in
    // radians
    double motion = 0;
    // per element: the part of changing.preload's rates that is the change of its law at x
    std::vector<Vector6> laws = {};
    // the terms of the system that the number changes, by their positions
    std::vector<bool> elements = {}, loads = {}, constraints = {};
};
// `x`: at which the laws change. Throws std::invalid_argument for a rate of another model.
NumberRate number_rate(const System& frozen, const Model& rate, double a, const Eigen::VectorXd& x);

// ∂E/∂m dm at fixed x [n].
Eigen::VectorXd rate_of(const NumberRate& number, const Eigen::VectorXd& x);

// Rates of Equilibrium::reactions where x changes by dx.
std::vector<Wrench> wrench_rates(const NumberRate& number, const Eigen::VectorXd& x,
                                 const Eigen::VectorXd& dx);

// ---- Derivatives of the response to disturbances, J X + ∂E/∂t = 0, by hyper-dual numbers.

struct Responding {
    Eigen::MatrixXd X;       // steps dx [n], one column per disturbance
    Eigen::MatrixXd offset;  // the disturbance of each constraint's offset [constraints × columns]
};
// Per disturbance: D with D dx = change of J X + ∂E/∂t by the step dx of x [n × n].
std::vector<Eigen::MatrixXd> curvatures(const System& frozen, const Eigen::VectorXd& x,
                                        const Responding& to);
// The change of J X + ∂E/∂t by ∂/∂m dm at fixed x and X [n × columns].
Eigen::MatrixXd rates_of(const NumberRate& number, const Eigen::VectorXd& x, const Responding& to);

}  // namespace elastocheck::reference::equilibrium
