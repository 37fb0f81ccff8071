// Lowers joints to the four basic constraints (Nikravesh 1988).
#pragma once

#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck {

// Constraints of a joint, at most six rows; a constraint with an offset is the only one
// of its joint:
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
// `bodies` gives the design orientation, needed for a direction that is not part of the joint: the
// transverse directions of a translational joint are perpendicular at the design pose.
std::vector<ConstraintKind> lower(const JointKind& joint, const std::vector<Body>& bodies);

}  // namespace elastocheck
