// Planes of the wishbones of a wheel: of each body that is joined to the wheel's body at one point
// and to ground along a line.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compare/outputs/catalogue/subject.hpp"

namespace elastocheck::compare {

struct Plane {
    Eigen::Vector3d normal;  // unit vector
    double offset = 0;       // normal · p for the points p of the plane [m]
};

// One plane per wishbone of the wheel's body. The line to ground is that of two bushings or ball joints,
// or the axis of a revolute or cylindrical joint.
std::vector<Plane> wishbone_planes(const Subject& wheel);

}  // namespace elastocheck::compare
