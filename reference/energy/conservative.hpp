// What has no potential, so that nothing can be minimised.
#pragma once

#include <optional>
#include <string>

#include "models/model.hpp"

namespace elastocheck::reference::energy {

// The first load or bushing that acts somewhere along the branch and has no energy, and why it has none; nothing where
// the model is conservative. A follower on ground, one that is held at zero, and a bushing without law and preload do
// not act.
std::optional<std::string> without_potential(const Model& model, const Branch& branch);

}  // namespace elastocheck::reference::energy
