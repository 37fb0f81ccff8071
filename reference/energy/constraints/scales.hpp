// Scales that make the quantities of a model of order one, independent of its unit of length and
// its rates.
#pragma once

#include <span>

#include "elastocheck/model.hpp"
#include "reference/energy/potential/prescribed.hpp"

namespace elastocheck::reference::energy {

// Length: the largest distance between any two attachment points in the design pose (1 m when they
// coincide). Force: the largest at the ends of the branch (1 N without any) of its loads, the
// elastic forces in the design pose, and the force that, to first order, moves the joints from the
// design pose to their held and driven values. Rotations are of order one unscaled. An energy is
// force · length.
struct Scales {
    double length = 1;    // L [m]
    double force = 1;     // F [N]
    double roundoff = 0;  // relative rounding of a position, over L [-]

    double energy() const { return force * length; }
    Eigen::VectorXd coordinates(int n) const;        // S [6nb]: x = S ξ, ξ of order one
    Eigen::VectorXd rows(const Model& model) const;  // D [m]: D Φ of order one
};

// Length and round-off only, force 1 N: for uses without a comparison of energies, at a cost
// proportional to the model.
Scales lengths_of(const Model& model, const Course& course);

// `values`: the requested values of the parameter.
Scales scales_of(const Model& model, const Course& course, std::span<const double> values);

}  // namespace elastocheck::reference::energy
