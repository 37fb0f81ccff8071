// The legs as parameters of a test: each claim is stated once and holds for every leg.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/recursive_method.hpp"
#include "elastocheck/scene.hpp"
#include "tests/support/builders.hpp"
#include "tests/support/slopes.hpp"

namespace elastocheck::legs {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using namespace support;  // builders.hpp, SideModel

// ---- Legs.

struct Leg {
    enum Kind { equilibrium, energy, recursive } kind = equilibrium;
    elastocheck::recursive::Method method = {};  // of the recursive leg

    bool needs_energy() const { return kind == energy; }
    // Whether the points are equilibria to rounding: both references and the series.
    bool exact() const {
        return kind != recursive ||
               std::holds_alternative<elastocheck::recursive::Series>(method.kind);
    }
    // A limit for the references, wider for the series and for adaptive steps, whose tolerances of
    // 1e-12 m bound the truncation error of a point but not its rounding nor its reactions.
    double wider(double limit) const {
        return kind != recursive ? limit : exact() ? 10 * limit : 1000 * limit;
    }
};
void PrintTo(const Leg& leg, std::ostream* out);

// Both references, the series, and adaptive steps with a tolerance of 1e-12.
std::vector<Leg> accurate_legs();
// Both references and the series.
std::vector<Leg> exact_legs();
// Both references and the recursive leg by each of its methods.
std::vector<Leg> legs_by_every_method();

// Equilibria at the parameters 0, to/steps, ... to of the side of a branch; by a reference also at
// any others.
EquilibriumPath solve(const Leg& leg, const SideModel& side, int steps);
EquilibriumPath solve(const Leg& reference, const SideModel& side, std::span<const double> values);
Residuals residuals(const Leg& leg, const SideModel& side, const Equilibrium& state);
Response linear_response(const Leg& leg, const SideModel& side, const Equilibrium& state,
                         const Disturbance& disturbance);

// The n-th branch of the scene, its last side, and the model that is active there.
SideModel side_of(const Scene& scene, std::size_t n = 0);
SideModel side_of(const Model& model, std::size_t n = 0);

// A path that must converge; every state of an exact leg must balance in the leg's own residuals:
// lengths and directions to 1e-10, forces and moments to `balance` [N, N·m].
EquilibriumPath solved(const Leg& leg, const SideModel& side, int steps, double balance = 1e-7);

// Base of a suite whose tests run once per leg.
struct LegTest : testing::TestWithParam<Leg> {
    const Leg& leg() const { return GetParam(); }
    double limit(double of_references) const { return leg().wider(of_references); }
};
#define ELASTOCHECK_FOR(legs_of_suite, Suite)                                 \
    INSTANTIATE_TEST_SUITE_P(Legs, Suite, testing::ValuesIn(legs_of_suite()), \
                             [](const auto& one) { return testing::PrintToString(one.param); })

// ---- Scenes.

// A block that slides along z on springs whose deformation is its height.
Scene block(const std::vector<ScalarLaw>& laws);
// The scene with a jack under its wheel centre as the last joint, active only where driven.
Scene with_jack(Scene scene);
// The scene's tie rod ends on a rack, a new body that slides along y and is held by the last joint.
Scene with_rack(Scene scene);

Vector3d drawn_position(const Scene& scene, const Point& p);
inline Point wheel_centre(const Scene& scene) {
    return {scene.wheels[0].body, scene.wheels[0].centre_local};
}
std::size_t joint_named(const Model& model, const std::string& name);
// Distance of two states over all bodies but `idle`: positions [m] and orientations [rad].
double distance(const Equilibrium& a, const Equilibrium& b, BodyId idle = ground);

}  // namespace elastocheck::legs
