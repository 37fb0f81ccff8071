// Result of every leg: the equilibria along one branch, stored or streamed, and the outcome.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "elastocheck/mechanism.hpp"

namespace elastocheck {

struct Wrench {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [N], ground axes
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // [N·m], ground axes
};

struct Equilibrium {
    double load = 0;          // load factor a of the branch
    std::vector<Pose> poses;  // one per Model::bodies
    std::vector<Wrench>
        // one per Model::joints: exerted by the joint on its body i, about ModelJoint::at
        reactions;
    double constraint_error =
        0;  // |Φ(q*)| of the leg's own constraint equations, eq. (31) [m, rad]
};

enum class Outcome {
    converged,
    singular,                  // the linear system is rank deficient on the branch
    loaded_idle_mode,          // a load acts on a motion that nothing resists
    inconsistent_constraints,  // redundant joints are inconsistent
    not_finite,                // a NaN or infinity appeared
    iteration_limit,           // the iteration stopped before its own criterion was met
    diverged,                  // steps alternate and grow: the method is unstable here
    // limit point: the branch turns back, and no equilibrium continues it
    limit_point,
    // bifurcation: another path of equilibria crosses here, and the branch is unstable past it
    bifurcation_point,
    branch_lost,       // no equilibrium continues the branch, however small the load step
    not_conservative,  // a load or a formulation has no energy: the energy leg does not apply
    // the cost grows with the cube of the scene and exceeds the leg's limit: not run
    too_large,
    // the branch left the range of a curve that is defined within its end knots only
    outside_table,
};
const char* name(Outcome outcome);  // "converged", "loaded idle mode", ...

// Residuals of a state in a leg's own equations: the largest absolute entries. Every leg can
// evaluate the states of every other leg, so that no leg judges its own result.
struct Residuals {
    double length = 0;     // constraints that are lengths [m]
    double direction = 0;  // constraints that are cosines of directions [-]
    double force = 0;      // balance of forces on a body [N]
    double moment = 0;     // balance of moments on a body about its origin [N·m]
};

// Work done, in units that do not depend on the machine.
struct Counts {
    long factorisations = 0;
    long iterations = 0;
    long evaluations = 0;  // of residual, or of energy with gradient
};

struct EquilibriumPath {
    Outcome outcome = Outcome::converged;
    std::string detail;               // message on the failure; empty when converged
    std::vector<Equilibrium> points;  // all requested points, or those reached before the failure
    Counts counts;
};

// Visitor that receives each point as it is found, in order, so that the path need not be stored:
// with a visitor a leg returns the path without points. The reference is valid during the call
// only.
using Visit = std::function<void(const Equilibrium&)>;

}  // namespace elastocheck
