// Scenes for the tests of the equilibrium leg: those of models/scenes and some built in code.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"

namespace elastocheck::reference::equilibrium::test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

inline Scene scene(const std::string& file) {
    return read_scene(std::string(ELASTOCHECK_SCENES) + "/" + file + ".yaml");
}

// The load factors of a branch, 0 included.
inline std::vector<double> every_load(const Branch& branch) {
    std::vector<double> loads;
    for (int n = 0; n <= branch.steps; ++n) loads.push_back(branch.to * n / branch.steps);
    return loads;
}

inline Branch branch_of(const std::string& name, const std::vector<Driver>& drivers, double to,
                        int steps, ParameterUnit unit = ParameterUnit::newton) {
    return {name, 0, to, steps, unit, drivers};
}
inline Driver driven_by(const Load& load) { return {load, 0, 1}; }

inline LinearStiffness& stiffness_of(Bushing& bushing) {
    return std::get<LinearStiffness>(bushing.law);
}
inline LinearRate& rate_of(AxialSpring& spring) { return std::get<LinearRate>(spring.law); }

inline Vector3d position(const Equilibrium& state, const Point& p) {
    if (p.body == ground) return p.s_local;
    const auto& pose = state.poses[static_cast<std::size_t>(p.body)];
    return pose.r + pose.p * p.s_local;
}

inline Vector3d random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> in(-size, size);
    return {in(random), in(random), in(random)};
}
inline Quaterniond random_turn(std::mt19937& random) {
    std::normal_distribution<double> in;
    return Quaterniond(in(random), in(random), in(random), in(random)).normalized();
}
inline Matrix6 random_stiffness(std::mt19937& random) {
    const Matrix6 root =
        Matrix6::NullaryExpr([&] { return std::uniform_real_distribution<double>(-1, 1)(random); });
    Vector6 units;  // √(N/m), √(N·m/rad)
    units << 400, 400, 400, 30, 30, 30;
    const Matrix6 spd = root * root.transpose() + 0.3 * Matrix6::Identity();
    return units.asDiagonal() * spd * units.asDiagonal();
}

// A bar from the origin along `u`, hinged at the origin about `axis`, with a rotational bushing
// there. Its probe is its tip.
inline Scene hinged_bar(const Vector3d& u, const Vector3d& axis, double k_R) {
    Scene s;
    s.name = "hinged bar";
    s.bodies = {{"bar", {}}};
    s.joints = {
        {"hinge", Revolute{{0, {0, 0, 0}}, {ground, {0, 0, 0}}, {0, axis}, {ground, axis}}}};
    Bushing torsion;
    torsion.i.body = 0;
    stiffness_of(torsion).K.bottomRightCorner<3, 3>() = k_R * Matrix3d::Identity();
    s.elastics = {{"torsion", torsion}};
    s.probes = {{"tip", {0, u}}};
    return s;
}

inline Branch pull(const Point& at, const Vector3d& f) {
    return branch_of("pull", {driven_by({"pull", DeadForce{at, f}})}, 1, 1);
}
inline Branch twist(BodyId body, const Vector3d& m) {
    return branch_of("twist", {driven_by({"twist", DeadMoment{body, m}})}, 1, 1);
}

// Keeps the worst of many comparisons and its place, to be judged and printed once.
struct Worst {
    double value = 0;
    std::string where = "nowhere";
    int compared = 0;
    void see(double deviation, const std::string& at) {
        ++compared;
        if (!(std::isfinite(deviation) && deviation <= value)) value = deviation, where = at;
        if (!std::isfinite(deviation)) value = std::numeric_limits<double>::infinity();
    }
};
inline ::testing::AssertionResult within(const Worst& worst, double limit) {
    const bool ok = worst.compared > 0 && std::isfinite(worst.value) && worst.value <= limit;
    return (ok ? ::testing::AssertionSuccess() : ::testing::AssertionFailure())
           << "worst " << worst.value << " of " << worst.compared << " at " << worst.where
           << ", allowed " << limit;
}

}  // namespace elastocheck::reference::equilibrium::test
