// Detects loads and bushing formulations without a potential, for which no energy can be minimised.
#pragma once

#include <optional>
#include <string>

#include "elastocheck/model.hpp"

namespace elastocheck::reference::energy {

// The first load or bushing that acts somewhere along the branch and has no energy, with the
// reason; empty for a conservative model. A follower on ground, a follower held at zero, and a
// bushing without law and preload do not act.
std::optional<std::string> why_not_conservative(const Model& model, const Branch& branch);

}  // namespace elastocheck::reference::energy
