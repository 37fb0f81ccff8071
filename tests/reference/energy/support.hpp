// Shared by the tests of the energy leg: scenes from files, random poses, worst residuals.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"

namespace elastocheck::reference::energy {

inline Scene scene_named(const std::string& name) {
    return read_scene(fmt::format("{}/{}.yaml", ELASTOCHECK_SCENES, name));
}

// Rates of linear laws.
inline double& rate_of(AxialSpring& spring) { return std::get<LinearRate>(spring.law).k; }
inline double rate_of(const AxialSpring& spring) { return std::get<LinearRate>(spring.law).k; }
inline Matrix6& stiffness_of(Bushing& bushing) { return std::get<LinearStiffness>(bushing.law).K; }
inline const Matrix6& stiffness_of(const Bushing& bushing) {
    return std::get<LinearStiffness>(bushing.law).K;
}

// f = 0 up to `clearance`, then `rate` (x - clearance): a stop that closes with growing x.
inline Curve stop(double clearance, double rate) {
    return {{clearance}, {{{0, 0, 0, 0}, {0, rate, 0, 0}}}};
}

// Cubic Hermite interpolation through (x, f) with these slopes, linear outside: continuously
// differentiable.
inline Curve hermite(const std::vector<double>& x, const std::vector<double>& f,
                     const std::vector<double>& slope) {
    Curve curve{x, {{f[0], slope[0], 0, 0}}};
    for (std::size_t k = 0; k + 1 < x.size(); ++k) {
        const double h = x[k + 1] - x[k], mean = (f[k + 1] - f[k]) / h;
        curve.pieces.push_back({f[k], slope[k], (3 * mean - 2 * slope[k] - slope[k + 1]) / h,
                                (slope[k] + slope[k + 1] - 2 * mean) / (h * h)});
    }
    curve.pieces.push_back({f.back(), slope.back(), 0, 0});
    return curve;
}

// A branch driven by these loads, from 0 to `to`.
inline Branch load_branch(const std::string& name, const std::vector<Load>& loads, double to,
                          int steps) {
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

inline EquilibriumPath solve(const Scene& scene, std::size_t branch,
                             std::span<const double> loads) {
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
    // Random curve, not monotonic, with `knots` knots over about [-1, 1], continuously
    // differentiable.
    Curve smooth_curve(int knots) {
        std::vector<double> x, f, slope;
        for (int k = 0; k < knots; ++k) {
            x.push_back(-1 + 2.0 * k / std::max(1, knots - 1) + 0.3 / knots * (*this)());
            f.push_back((*this)(-3, 3));
            slope.push_back((*this)(-3, 3));
        }
        return hermite(x, f, slope);
    }
    // The same with slopes that jump at the knots.
    Curve kinked_curve(int knots) {
        Curve curve = smooth_curve(knots);
        for (int k = 0; k + 1 < knots; ++k) {
            const auto i = static_cast<std::size_t>(k);
            const double h = curve.knots[i + 1] - curve.knots[i], bend = 5 * (*this)();
            curve.pieces[i + 1][1] += bend * h;  // bend · t (h - t), zero at both ends
            curve.pieces[i + 1][2] -= bend;
        }
        curve.pieces.front()[1] = (*this)(-3, 3);
        curve.pieces.back()[1] = (*this)(-3, 3);
        return curve;
    }
};

}  // namespace elastocheck::reference::energy
