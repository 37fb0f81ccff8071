// Result of every leg, that is of every solver (recursive methods and references): the equilibria along
// one branch, stored or streamed, and the outcome.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "elastocheck/mechanism.hpp"

namespace elastocheck {

struct Wrench {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();   // [N], ground axes
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // [N·m], ground axes
};

struct Equilibrium {
    double load = 0;          // parameter a of the branch, in Branch::unit
    std::vector<Pose> poses;  // one per Model::bodies
    // one per Model::joints: exerted by the joint on its body i, about ModelJoint::at
    std::vector<Wrench> reactions;
    // |Φ(q*)| of the leg's own constraint equations, eq. (31) [m, rad]
    double constraint_error = 0;
};

// How a path ended. J is the matrix of the linearised equations, ∂(G, Φ)/∂(q, λ); M its reduced
// Hessian, the stiffness of the motions that the joints allow; z' = dz/da the tangent of the path of
// z = (q, λ); nb bodies, m rows of Φ; ε = 2⁻⁵², the machine epsilon. The thresholds are those of the leg
// that returns the outcome; its tolerance for |u·f| is relative to the forces on the bodies.
enum class Outcome {
    // every requested point is reached, with the residual of each below the tolerance of its leg
    converged,
    // smallest / largest pivot of J ≤ ε (6nb + m), or det J or det M changes its sign on the step and
    // nothing shows whether the path turns back or another one crosses it
    singular,
    // |u·f| > tolerance · |f| for a motion u with Φ_q u = 0 and K u = 0, f the forces on the bodies
    loaded_idle_mode,
    // |y·Φ| > tolerance for a dependency yᵀ Φ_q = 0 of the joints, or |Φ| > tolerance at the pose that
    // minimises it: no pose satisfies all joints
    inconsistent_constraints,
    not_finite,  // !isfinite of a residual, a correction, a state or its response
    // the residual or the correction is above its tolerance after the last iteration allowed
    iteration_limit,
    // fixed steps: Δqⁿ·Δqⁿ⁻¹ < 0 with |Δqⁿ| > |Δqⁿ⁻¹| twice in a row, a rotation |Δπ| > 1 rad in a step,
    // or two increments that should agree differ by more than half the larger one
    diverged,
    // |z'| ~ (a* - a)^-½ → ∞ as the step approaches a*: the branch turns back at a*, and no equilibrium
    // continues it
    limit_point,
    // det J or an eigenvalue of M passes zero while z' stays finite: another path crosses here, and the
    // branch is unstable past it
    bifurcation_point,
    // no step above the smallest one reaches an equilibrium of this path, and none of the reasons above
    // is shown
    branch_lost,
    // a follower load, moment or formulation with curl f ≠ 0: the energy leg has no function to minimise
    not_conservative,
    // 6nb + m above the leg's limit (its cost grows with the cube): not run
    too_large,
    // x < x_first or x > x_last of a curve that is defined between its end knots only
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

// Visitor that receives each point as it is found, in order, so that the path need not be stored: with a
// visitor a leg returns the path without points. The reference is valid during the call only.
using PointVisitor = std::function<void(const Equilibrium&)>;

}  // namespace elastocheck
