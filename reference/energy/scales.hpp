// What makes a model's quantities of order one, whatever its unit of length and its rates.
#pragma once

#include <span>

#include "models/model.hpp"
#include "reference/energy/prescribed.hpp"

namespace elastocheck::reference::energy {

// Length: the largest distance between any two attachment points at the design pose (1 m when they coincide).
// Force: what acts at the ends of the branch (1 N when nothing does): its loads, what the elements hold at
// the design pose, and the force that it takes, to first order, to lead the joints from where they are drawn
// to where they are held and driven. Rotations are of order one as they are. An energy is force · length.
struct Scales {
    double length = 1;    // L [m]
    double force = 1;     // F [N]
    double roundoff = 0;  // what the last bit of a position means, relative to L [-]

    double energy() const { return force * length; }
    Eigen::VectorXd coordinates(int n) const;        // S [6nb]: x = S ξ, ξ of order one
    Eigen::VectorXd rows(const Model& model) const;  // D [m]: D Φ of order one
};

// Length and round-off alone, the force 1 N: enough where energies are not compared, at a cost in proportion to the model.
Scales lengths_of(const Model& model, const Course& course);

// `values` of the parameter: where the branch is asked for.
Scales scales_of(const Model& model, const Course& course, std::span<const double> values);

}  // namespace elastocheck::reference::energy
