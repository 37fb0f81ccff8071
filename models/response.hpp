// How an equilibrium answers a small change of what acts on it: what every leg returns of a state.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "models/equilibrium_path.hpp"
#include "models/mechanism.hpp"
#include "models/scene.hpp"

namespace elastocheck {

// A small dead force at a point of a body, and a small moment on it, ground axes.
struct UnitWrench {
    Point at;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [N]
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // [N·m]
};

// What changes, alone, everything else of the branch as it is: a wrench, or the offset of a driven joint by one unit
// [m, rad].
using Disturbance = std::variant<UnitWrench, Motion>;

// Of a body, to first order: its origin moves by dr, it turns by dpi about ground axes.
struct Increment {
    Eigen::Vector3d dr = Eigen::Vector3d::Zero();   // [m] per unit of the disturbance
    Eigen::Vector3d dpi = Eigen::Vector3d::Zero();  // [rad] per unit
};

// One answer a disturbance, in their order, each with one increment per Model::bodies; none unless converged. Idle modes
// are held (minimum norm), unless a disturbance pushes one: loaded_idle_mode.
struct Response {
    Outcome outcome = Outcome::converged;
    std::string detail;  // what failed, in words; empty when converged
    std::vector<std::vector<Increment>> increments;
};

}  // namespace elastocheck
