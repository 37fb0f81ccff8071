// Moves the origin to the centre of the model to avoid cancellation. The energy is invariant, but
// its digits are not: 10 km from the origin a double resolves a position to 2e-12 m, a thousand
// times the gradient left at a minimum.
#pragma once

#include "elastocheck/model.hpp"

namespace elastocheck::reference::energy {

// Mean of the bodies' design positions in ground axes; zero if it is not finite.
Eigen::Vector3d centre_of(const Model& model);

// The model with the points on ground and the bodies moved by -c.
Model about(const Model& model, const Eigen::Vector3d& c);

std::vector<Pose> moved_by(std::vector<Pose> poses, const Eigen::Vector3d& r);

}  // namespace elastocheck::reference::energy
