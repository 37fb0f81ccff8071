// Joints as compositions of the four basic constraints.
#pragma once

#include <vector>

#include "models/model.hpp"

namespace elastocheck {

// The constraints a joint is made of, at most six rows; where one of them has an offset, it is the only one:
//
//   spherical      coincident points                                          3
//   revolute       coincident points  + axis_i ⟂ two directions across axis_j  5
//   universal      coincident points  + axis_i ⟂ axis_j                        4
//   cylindrical    point i in two planes along axis_j + axis_i ⟂ both          4
//   translational  cylindrical + one direction across i ⟂ one across j         5
//   planar         point i in plane j + normal_i ⟂ two directions in plane j   3
//   fixed          coincident points + x_i ⟂ y_j, x_i ⟂ z_j, y_i ⟂ z_j         6
//   distance 1 · in-plane 1 · in-line 2 · perpendicular 1 · parallel 2 · angle 1 (DirectionAtAngle)
//
// `bodies` gives the design orientation, needed where a direction across an axis is not part of the joint:
// the perpendicular directions of a translational joint are perpendicular at the design pose.
std::vector<ConstraintKind> lower(const JointKind& joint, const std::vector<Body>& bodies);

}  // namespace elastocheck
