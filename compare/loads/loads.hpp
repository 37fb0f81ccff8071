// Loads at the pickup points of every body under load cases, for stress analysis.
//
// A case is a branch of its own: a = 0 is the scene under its static loads, a = 1 the case. The
// equilibrium leg solves it, and the series, which shares no equation with it, confirms it.
//
// On body b, with the wrench (F, M) of every joint, element and load at its point p of the body,
//
//   Σ F = 0,   Σ ( (p - r_b) × F + M ) = 0
//
// is the check of balance: the joints' wrenches are the equilibrium leg's, those of the elements
// come from the recursion's formulas.
#pragma once

#include <string>
#include <vector>

#include "compare/result/result.hpp"
#include "elastocheck/legs.hpp"

namespace elastocheck::compare {

// A force, moment or travel that a case asks for.
struct CaseInput {
    enum class Kind {
        patch_force,   // of the road [N]; along x a brake on the carrier takes its torque
        centre_force,  // at the wheel centre [N]: of a drive shaft
        wheel_moment,  // on the carrier [N·m]
        travel,        // height of the wheel centre above the design position, held [m]
        body_force,    // at the centre of mass, of a body without a mass at its origin [N]
        acceleration,  // of the vehicle, in parts of gravity; -m a acts on every body with a mass
    } kind = Kind::patch_force;
    std::size_t of = 0;  // the wheel or body, in Scene::wheels or Scene::bodies
    int axis = 2;        // 0 x, 1 y, 2 z
    double value = 0;
};
struct LoadCase {
    std::string name;
    std::vector<CaseInput> inputs;
};

// Throws std::invalid_argument for a case that with_cases() refuses as it has the height of a wheel and the
// force that holds it there.
void check_heights(const LoadCase& load_case, const Scene& scene);

// The scene with the cases in place of its branches. Static loads stay; the force at a patch is the
// whole force there, so that a case adds what a static load lacks. Throws std::invalid_argument for a
// case with a vertical force at the patch of a wheel whose travel it holds, and for an acceleration
// of a scene without masses under gravity.
Scene with_cases(Scene scene, const std::vector<LoadCase>& cases);

// Place where a joint or an element holds a body, or "applied": loads together, at the body's
// origin. "A+B" is the sum of joints that share a load in an undetermined way, at the point of A.
struct Pickup {
    std::string body, connection;
    Eigen::Vector3d at;  // as drawn, ground axes [m]
};
// The wrench on the body at its point [N, N·m].
struct PickupLoad {
    Vector6 in_ground_axes;  // infinite: redundant joints share it, and no load determines how
    Vector6 in_body_axes;
};
struct SolvedCase {
    std::string name;
    Outcome outcome = Outcome::converged;
    std::string detail;             // why it has no loads
    std::vector<PickupLoad> loads;  // per pickup
    // largest remainder of a body's balance, as a share of the largest force or moment on any
    double imbalance = 0;
    // largest difference of a joint's force or moment from the series, as a share of the largest
    double disagreement = 0;
};
struct PickupLoads {
    std::vector<Pickup> pickups;
    std::vector<SolvedCase> cases;
};

// Pre: the branches of the model are cases of with_cases(), compiled with Detail::everything.
PickupLoads pickup_loads(const Model& model);

Result result_of(const PickupLoads& loads);

}  // namespace elastocheck::compare
