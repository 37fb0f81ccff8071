// The mechanism told from its own middle. Where it stands does not matter to any energy, but its digits do: 10 km from the
// origin a double knows a place to 2e-12 m, which is a thousand times what is left of a gradient at a minimum.
#pragma once

#include "models/model.hpp"

namespace elastocheck::reference::energy {

// The mean of where the bodies are drawn, in ground axes; nothing if that is no number.
Eigen::Vector3d centre_of(const Model& model);

// The same with what is on the ground, and the bodies, moved by -c.
Model about(const Model& model, const Eigen::Vector3d& c);

std::vector<Pose> moved_by(std::vector<Pose> poses, const Eigen::Vector3d& r);

}  // namespace elastocheck::reference::energy
