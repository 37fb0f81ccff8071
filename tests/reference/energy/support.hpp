// Shared by the tests of the energy leg: scenes from files, random poses, worst residuals.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "models/branch.hpp"
#include "models/compile.hpp"
#include "models/reader/scene_file.hpp"
#include "reference/energy/solve.hpp"

namespace elastocheck::reference::energy {

inline Scene scene_named(const std::string& name) {
    return read_scene(fmt::format("{}/{}.yaml", ELASTOCHECK_SCENES, name));
}

// The linear laws' numbers.
inline double& rate_of(AxialSpring& spring) { return std::get<LinearRate>(spring.law).k; }
inline double rate_of(const AxialSpring& spring) { return std::get<LinearRate>(spring.law).k; }
inline Matrix6& stiffness_of(Bushing& bushing) { return std::get<LinearStiffness>(bushing.law).K; }
inline const Matrix6& stiffness_of(const Bushing& bushing) {
    return std::get<LinearStiffness>(bushing.law).K;
}

// A branch that its loads alone drive, from 0 to `to`.
inline Branch load_branch(const std::string& name, const std::vector<Load>& loads, double to, int steps) {
    Branch branch{.name = name, .to = to, .steps = steps, .drivers = {}};
    for (const auto& load : loads) branch.drivers.push_back({load, 0, 1});
    return branch;
}

// Factors 0, 1/steps, ... 1 of the branch.
inline std::vector<double> sweep(const Branch& branch, int steps = 0) {
    if (steps == 0) steps = branch.steps;
    std::vector<double> loads;
    for (int i = 0; i <= steps; ++i) loads.push_back(branch.to * i / steps);
    return loads;
}

inline EquilibriumPath solve(const Scene& scene, std::size_t branch, std::span<const double> loads) {
    const Model model = compile(scene);
    const Branch& walked = model.branches.at(branch);
    return solve(on_branch(model, walked), walked, loads);
}

inline Eigen::Vector3d position(const Equilibrium& state, const Point& p) {
    if (p.body == ground) return p.s_local;
    const Pose& pose = state.poses.at(static_cast<std::size_t>(p.body));
    return pose.r + pose.p * p.s_local;
}

inline double largest(const Residuals& r) {
    const double all[] = {r.length, r.direction, r.force, r.moment};
    double worst = 0;
    for (const double x : all) worst = std::isfinite(x) ? std::max(worst, x) : INFINITY;
    return worst;
}

struct Random {
    std::mt19937 engine{20040607};

    double operator()(double low = -1, double high = 1) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    Eigen::Vector3d vector(double size = 1) {
        return size * Eigen::Vector3d((*this)(), (*this)(), (*this)());
    }
    Eigen::Vector3d unit() { return vector().normalized(); }
    Eigen::VectorXd many(int n, double size = 1) {
        Eigen::VectorXd v(n);
        for (int i = 0; i < n; ++i) v[i] = size * (*this)();
        return v;
    }
    Eigen::Quaterniond rotation(double largest_angle = 3) {
        return Eigen::Quaterniond(Eigen::AngleAxisd((*this)(0, largest_angle), unit()));
    }
    Pose pose() { return {vector(), rotation()}; }
};

}  // namespace elastocheck::reference::energy
