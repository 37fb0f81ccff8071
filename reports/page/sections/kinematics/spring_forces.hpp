// Forces of springs and stops over wheel travel.
#pragma once

#include <string>
#include <vector>

#include "reports/page/common.hpp"

namespace elastocheck::reports {

// Force of a spring or stop over the travel of its wheel, at the stations of the leading sweep.
struct SpringForce {
    std::string element;  // "coil bump stop"
    std::size_t wheel = 0;
    double clearance = compare::nan;                 // of a stop [mm]
    std::vector<std::vector<double>> stations = {};  // travel, force, deformation
};

std::vector<SpringForce> spring_forces(const SceneAnalyses& scene, const Sweep& sweep);

// The curve, with a point where a stop touches: there its deformation is the clearance, between a
// station without and one with force.
std::vector<std::vector<double>> curve_of(const SpringForce& force, std::vector<double>& touches);

}  // namespace elastocheck::reports
