// What every leg returns: the equilibria along one branch, or each as it is found, and how the solution ended.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "models/mechanism.hpp"

namespace elastocheck {

struct Wrench {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [N], ground axes
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // [N·m], ground axes
};

// How far a state may be from the equilibrium that it stands for, by the leg's own account: above the true error, and
// infinite where the leg can promise nothing.
struct ErrorBound {
    double length = std::numeric_limits<double>::infinity();  // of any body's origin [m]
    double angle = std::numeric_limits<double>::infinity();   // of any body's orientation [rad]
};

struct Equilibrium {
    double load = 0;          // load factor a of the branch
    std::vector<Pose> poses;  // one per Model::bodies
    std::vector<Wrench>
        reactions;  // one per Model::joints: exerted by the joint on its body i, about ModelJoint::at
    double constraint_error = 0;  // |Φ(q*)| of the leg's own constraint equations, eq. (31) [m, rad]
    // What a leg says of the point where it is asked to give account of its path; else as here.
    ErrorBound bound = {};
    // The least stiffness of what the joints leave free and something resists, in the leg's own scaling, over what it was
    // at a = 0: 0 where the branch turns back, divides or loses its stability, negative past that.
    double stiffness_left = std::numeric_limits<double>::quiet_NaN();
};

enum class Outcome {
    converged,
    singular,                  // the linear system lost rank on the way
    loaded_idle_mode,          // a motion that nothing resists is pushed by a load
    inconsistent_constraints,  // the joints contradict each other
    not_finite,                // a NaN or infinity appeared
    iteration_limit,           // the solver gave up before its own criterion was met
    diverged,                  // steps that swing back and forth and grow: the method is unstable here
    limit_point,               // the branch ends here: it turns back, and no equilibrium continues it
    dividing_point,    // another curve of equilibria crosses the branch here, which is unstable past it
    branch_lost,       // no equilibrium continues the branch, however small the load step
    not_conservative,  // a load or a formulation has no energy: the energy leg cannot be asked
    too_large,         // more work than a leg whose cost grows with the cube of the scene is worth: not asked
    outside_table,     // a curve that says nothing beyond its ends was led beyond them
};
const char* name(Outcome outcome);  // "converged", "loaded idle mode", ...

// How far a state is from satisfying a leg's own equations: the largest absolute entries. Every leg can judge
// any state, its own or another's, so nobody has to grade himself.
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
    std::string detail;               // what failed, in words; empty when converged
    std::vector<Equilibrium> points;  // all requested points, or those reached before the failure
    Counts counts;
};

// Takes each point as it is found, in their order, so that a path need not keep them: told of one, a leg returns the
// path without points. What is handed over is the leg's own, and may be another point once this returns.
using Visit = std::function<void(const Equilibrium&)>;

}  // namespace elastocheck
