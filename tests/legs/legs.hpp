// The legs as parameters of a test: each claim is stated once and holds for every leg.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/recursive_method.hpp"
#include "elastocheck/scene.hpp"
#include "tests/support/slopes.hpp"

namespace elastocheck::legs {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using support::OneWay;

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

// Equilibria at the parameters 0, to/steps, ... to of the side of a branch.
EquilibriumPath solve(const Leg& leg, const OneWay& side, int steps);
Residuals residuals(const Leg& leg, const OneWay& side, const Equilibrium& state);
Response linear_response(const Leg& leg, const OneWay& side, const Equilibrium& state,
                         const Disturbance& disturbance);

// The n-th branch of the scene, its last side, and the model that is active there.
OneWay side_of(const Scene& scene, std::size_t n = 0);
OneWay side_of(const Model& model, std::size_t n = 0);

// A path that must converge; every state of an exact leg must balance in the leg's own residuals:
// lengths and directions to 1e-10, forces and moments to `balance` [N, N·m].
EquilibriumPath solved(const Leg& leg, const OneWay& side, int steps, double balance = 1e-7);

// Base of a suite whose tests run once per leg.
struct LegTest : testing::TestWithParam<Leg> {
    const Leg& leg() const { return GetParam(); }
    double limit(double of_references) const { return leg().wider(of_references); }
};
#define ELASTOCHECK_FOR(legs_of_suite, Suite)                                 \
    INSTANTIATE_TEST_SUITE_P(Legs, Suite, testing::ValuesIn(legs_of_suite()), \
                             [](const auto& one) { return testing::PrintToString(one.param); })

// ---- Scenes.

inline const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ();
inline const Direction ground_x{ground, X}, ground_y{ground, Y}, ground_z{ground, Z};

inline Branch branch_of(std::vector<Driver> drivers, double to,
                        ParameterUnit unit = ParameterUnit::newton) {
    return {"branch", 0, to, 1, unit, std::move(drivers)};
}
inline Branch load_branch(const LoadKind& load, double to) {
    return branch_of({{Load{"load", load}, 0, 1}}, to);
}
inline Branch motion_branch(int joint, double to, ParameterUnit unit = ParameterUnit::metre) {
    return branch_of({{Motion{joint}, 0, 1}}, to, unit);
}

inline double& rate_of(Elastic& spring) {
    return std::get<LinearRate>(std::get<AxialSpring>(spring.kind).law).k;
}
inline Matrix6& stiffness_of(Bushing& bushing) { return std::get<LinearStiffness>(bushing.law).K; }
inline Bushing& bushing_of(Elastic& element) { return std::get<Bushing>(element.kind); }

// Diagonal rates [N/m] [N·m/rad].
Bushing bushing(const Marker& i, const Marker& j, const Vector3d& rates,
                const Vector3d& rotational);

// A bar with its origin at a hinge about `axis`, on a rotational bushing of the rate k_R; its probe
// is its tip at `tip`.
Scene hinged_bar(const Vector3d& tip, const Vector3d& axis, double k_R);
// A block that slides along z on springs whose deformation is its height.
Scene block(const std::vector<ScalarLaw>& laws);
// The scene with a jack under its wheel centre as the last joint, active only where driven.
Scene with_jack(Scene scene);
// The scene's tie rod ends on a rack, a new body that slides along y and is held by the last joint.
Scene with_rack(Scene scene);

Vector3d position(const Equilibrium& state, const Point& p);
Vector3d drawn_position(const Scene& scene, const Point& p);
inline Point wheel_centre(const Scene& scene) {
    return {scene.wheels[0].body, scene.wheels[0].centre_local};
}
std::size_t joint_named(const Model& model, const std::string& name);
// Distance of two states over all bodies but `idle`: positions [m] and orientations [rad].
double distance(const Equilibrium& a, const Equilibrium& b, BodyId idle = ground);

// ---- Random numbers and worst cases.

struct Random {
    std::mt19937 engine{2004};
    double operator()(double low = -1, double high = 1) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    Vector3d vector(double size = 1) { return size * Vector3d((*this)(), (*this)(), (*this)()); }
    Vector3d unit() { return vector().normalized(); }
    Quaterniond rotation(double angle = 3) {
        return Quaterniond(Eigen::AngleAxisd((*this)(0, angle), unit()));
    }
    Vector6 wrench(double force, double moment) {
        Vector6 w;
        w << vector(force), vector(moment);
        return w;
    }
    Matrix6 stiffness();  // positive definite and coupled
};

// The worst of many deviations and its place.
struct Worst {
    double value = 0;
    std::string where = "nowhere";
    void see(double deviation, const std::string& at) {
        if (deviation <= value || std::isnan(value)) return;
        value = deviation, where = at;
    }
    void see(double deviation, double at) { see(deviation, fmt::format("{}", at)); }
};
inline testing::AssertionResult within(const Worst& worst, double limit) {
    const bool seen = worst.where != "nowhere" || worst.value == 0;
    return (seen && worst.value <= limit ? testing::AssertionSuccess()
                                         : testing::AssertionFailure())
           << "worst " << worst.value << " at " << worst.where << ", allowed " << limit;
}
inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace elastocheck::legs
