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
// are held (minimum norm √(|dr|² + L²|dπ|²) over all bodies, L a length of the leg's own), unless a disturbance pushes one:
// loaded_idle_mode. An offset that redundant joints hold: inconsistent_constraints. A state that has lost its stiffness:
// singular.
//
// With dead wrenches as disturbances and the displacements they work on, force with dp of its point, moment with dπ, the
// answers of an equilibrium are reciprocal, C = Cᵀ, where everything that acts has a potential: no follower, no
// formulation without energy, and no dead moment on a body. One m of these on a body makes C - Cᵀ = C_π m̃ C_πᵀ, C_π the
// answers to moments on that body.
struct Response {
    Outcome outcome = Outcome::converged;
    std::string detail;  // what failed, in words; empty when converged
    std::vector<std::vector<Increment>> increments;
};

}  // namespace elastocheck
