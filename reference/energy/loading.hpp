// The dead loads at one load factor, and the scales that make a model's quantities of order one.
#pragma once

#include <span>
#include <vector>

#include "models/model.hpp"

namespace elastocheck::reference::energy {

struct Loading {
    std::vector<DeadForce> forces;    // on bodies only: a force on ground does no work
    std::vector<DeadMoment> moments;  // likewise
    double relief = 0;                // share of the elements' design stress that is switched off [-]
};

void add(Loading& loading, const std::vector<Load>& loads, double factor);

// f(a) = static loads + a · branch loads
Loading loading_at(const Model& model, const Branch& branch, double a);

// On the way to f(0): the elements' stress at the design pose and the static loads, both by the share 1 - τ.
// At τ = 1 the design pose is in equilibrium whatever the preloads, at τ = 0 all is as it should be.
Loading settling_at(const Model& model, double tau);

// A dead moment has no symmetric stiffness: in the chart the balance of moments changes by -½ m × φ more than
// the gradient of the chart's potential does. In ξ, units of F·L [6nb × 6nb].
struct Scales;
Eigen::MatrixXd moment_stiffness(const Loading& loading, const Scales& scales, int n);

// Length: the largest distance between any two attachment points at the design pose (1 m when they coincide).
// Force: all loads at their largest, and what the elements hold at the design pose (1 N when there are none).
// Rotations are of order one as they are. An energy is force · length.
struct Scales {
    double length = 1;    // L [m]
    double force = 1;     // F [N]
    double roundoff = 0;  // what the last bit of a position means, relative to L [-]

    double energy() const { return force * length; }
    Eigen::VectorXd coordinates(int n) const;        // S [6nb]: x = S ξ, ξ of order one
    Eigen::VectorXd rows(const Model& model) const;  // D [m]: D Φ of order one
};

Scales scales_of(const Model& model, const Branch& branch, std::span<const double> loads);

}  // namespace elastocheck::reference::energy
