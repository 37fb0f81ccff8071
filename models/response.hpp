// Linear response (compliance) of an equilibrium to small disturbances: result of every leg.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "models/overloaded.hpp"

namespace elastocheck {

// Small dead force at a point of a body, and small moment on the body, ground axes.
struct UnitWrench {
    Point at;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [N]
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // [N·m]
};

// A disturbance, all else on the branch unchanged: a wrench, or the offset of a driven joint by one
// unit [m, rad].
using Disturbance = std::variant<UnitWrench, Motion>;

// Throws std::invalid_argument where a disturbance does not act on the model.
inline void check(const Model& model, std::span<const Disturbance> disturbances) {
    const auto require = [](bool met, const char* what) {
        if (!met) throw std::invalid_argument(what);
    };
    const auto check_one =
        overloaded{[&](const UnitWrench& wrench) {
                       require(static_cast<std::size_t>(wrench.at.body) < model.bodies.size(),
                               "a disturbance acts on no body of the model");
                   },
                   [&](const Motion& motion) {
                       const auto joint = static_cast<std::size_t>(motion.joint);
                       require(joint < model.joints.size() && model.joints[joint].driven >= 0,
                               "a disturbance drives a joint without offset, length or angle");
                   }};
    for (const Disturbance& disturbance : disturbances) std::visit(check_one, disturbance);
}

// "a wrench on 'knuckle'", "moving 'rack'"
inline std::string name_of(const Model& model, const Disturbance& disturbance) {
    const auto quoted = [](const auto& list, int k) {
        return "'" + list[static_cast<std::size_t>(k)].name + "'";
    };
    return std::visit(
        overloaded{
            [&](const UnitWrench& w) { return "a wrench on " + quoted(model.bodies, w.at.body); },
            [&](const Motion& m) { return "moving " + quoted(model.joints, m.joint); },
        },
        disturbance);
}

// First-order displacement of a body: dr of its origin, rotation dpi about ground axes.
struct Increment {
    Eigen::Vector3d dr = Eigen::Vector3d::Zero();   // [m] per unit of the disturbance
    Eigen::Vector3d dpi = Eigen::Vector3d::Zero();  // [rad] per unit
};

// One response per disturbance, in their order, each with one increment per Model::bodies; empty unless
// converged. Idle modes are held (minimum norm √(|dr|² + L²|dπ|²) over all bodies, L a length that the leg chooses). A
// disturbance that acts on an idle mode gives loaded_idle_mode, an offset that redundant joints hold gives
// inconsistent_constraints, a state that has lost its stiffness gives singular.
//
// Compliance to dead wrenches is reciprocal, C = Cᵀ, with the work-conjugate displacements (force
// with dp of its point, moment with dπ), if all forces have a potential: no follower, no
// formulation without energy, no dead moment on a body. A dead moment m on a body gives
// C - Cᵀ = C_π m̃ C_πᵀ, C_π the response to moments on that body.
struct Response {
    Outcome outcome = Outcome::converged;
    std::string detail;  // message on the failure; empty when converged
    std::vector<std::vector<Increment>> increments;
};

}  // namespace elastocheck
