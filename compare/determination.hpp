// Which joint wrenches the equations determine.
#pragma once

#include <vector>

#include "models/model.hpp"

namespace elastocheck::compare {

// Joints that repeat each other share a load as they like: any λ with Φ_qᵀ λ = 0 may be added to theirs. Only
// those that take part in such a λ are undetermined, and what a group of them exerts together is not.
struct Determination {
    std::vector<bool> joint;               // per Model::joints
    std::vector<std::vector<int>> groups;  // of undetermined joints that hang together
};

// Of a model as it stands on a branch, at the design position.
Determination determination(const Model& model);

}  // namespace elastocheck::compare
