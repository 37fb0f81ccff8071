// The list of what is drawn of a suspension, by the report's fixed views, its turned view and the
// live page: points, lines and labels at the design position, and their positions along every
// branch.
#pragma once

#include <nlohmann/json.hpp>

#include "compare/comparison/compare.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::reports {

//   points     every attachment of a joint, element, wheel or probe: hardpoint's name, body,
//              position [mm]
//   links      pairs of points joined by a line: of one body, of a rod (distance), a spring, a
//              stop, a beam
//   faces      a body's coplanar points, in order along their outline: an arm
//   symbols    joints and bushings of the scene: kind, name, point (null: none there), position
//              [mm], axis if any
//   wheels     centre, patch and spin axis at the design position
//   positions  of all points [mm], by the equilibrium leg, at the middle and the ends of every
//              branch
//   motion     for each branch, at up to 17 stations of the equilibrium leg: the parameter, the
//              coordinates of all points one after the other [mm], and the spin axes of the wheels;
//              rounded, since they are only drawn
nlohmann::ordered_json drawing_json(const Scene& scene, const Model& model,
                                    const compare::Comparison& comparison);

}  // namespace elastocheck::reports
