// Planes of the wishbones of a wheel: of each body that is joined to the wheel's body at one point
// and to ground along a line.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck::compare {

struct Plane {
    Eigen::Vector3d normal;  // unit
    double offset = 0;       // normal · p of its points [m]
};

// In a state, one plane per wishbone of the body. The line to ground is that of two bushings or
// ball joints, or the axis of a revolute or cylindrical joint.
std::vector<Plane> wishbone_planes(const Model& model, BodyId wheel,
                                   const std::vector<Pose>& poses);

}  // namespace elastocheck::compare
