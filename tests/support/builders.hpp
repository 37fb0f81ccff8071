// Directions, branches, elements and small scenes that tests of several folders build in code, random
// numbers, and the worst of many deviations.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::support {

using Eigen::Quaterniond;
using Eigen::Vector3d;

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
// Parameters at 0, 1/steps, ... 1 of the branch.
inline std::vector<double> every_point(const Branch& branch, int steps = 0) {
    if (steps == 0) steps = branch.steps;
    std::vector<double> all;
    for (int k = 0; k <= steps; ++k) all.push_back(branch.to * k / steps);
    return all;
}

inline double& rate_of(AxialSpring& spring) { return std::get<LinearRate>(spring.law).k; }
inline double& rate_of(Elastic& spring) { return rate_of(std::get<AxialSpring>(spring.kind)); }
inline Matrix6& stiffness_of(Bushing& bushing) { return std::get<LinearStiffness>(bushing.law).K; }
inline Bushing& bushing_of(Elastic& element) { return std::get<Bushing>(element.kind); }

// Diagonal rates [N/m] [N·m/rad].
inline Bushing bushing(const Marker& i, const Marker& j, const Vector3d& rates,
                       const Vector3d& rotational) {
    LinearStiffness law;
    law.K.diagonal() << rates, rotational;
    return {i, j, law};
}

// f = 0 up to the clearance c, rate (x - c) beyond; reversed for c < 0.
inline Curve stop(double c, double rate) {
    const std::array<double, 4> open{}, closed{0, rate, 0, 0};
    return c >= 0 ? Curve{{c}, {open, closed}} : Curve{{c}, {closed, open}};
}
// Cubic Hermite interpolation through (x, f) with these slopes, linear outside.
inline Curve hermite(const std::vector<double>& x, const std::vector<double>& f,
                     const std::vector<double>& slope) {
    Curve curve{x, {{f[0], slope[0], 0, 0}}};
    for (std::size_t k = 0; k + 1 < x.size(); ++k) {
        const double h = x[k + 1] - x[k], chord = (f[k + 1] - f[k]) / h;
        curve.pieces.push_back({f[k], slope[k], (3 * chord - 2 * slope[k] - slope[k + 1]) / h,
                                (slope[k] + slope[k + 1] - 2 * chord) / (h * h)});
    }
    curve.pieces.push_back({f.back(), slope.back(), 0, 0});
    return curve;
}
// The force of a curve as include/elastocheck/mechanism.hpp states it.
template <class Real = double>
Real stated_force(const Curve& curve, Real x) {
    std::size_t k = 0;
    while (k < curve.knots.size() && static_cast<Real>(curve.knots[k]) <= x) ++k;
    const auto& c = curve.pieces[k];
    const Real t = x - static_cast<Real>(curve.knots[k == 0 ? 0 : k - 1]);
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

// A bar with its origin at a hinge about `axis`, on a rotational bushing of the rate k_R; its probe
// is its tip at `tip`.
inline Scene hinged_bar(const Vector3d& tip, const Vector3d& axis, double k_R) {
    Scene s;
    s.name = "hinged bar";
    s.bodies = {{"bar", {}}};
    s.joints = {{"hinge", Revolute{{0}, {ground}, {0, axis}, {ground, axis}}}};
    s.elastics = {{"torsion", bushing({0}, {ground}, Vector3d::Zero(), Vector3d::Constant(k_R))}};
    s.probes = {{"tip", {0, tip}}};
    return s;
}

inline Vector3d position(const Equilibrium& state, const Point& p) {
    if (p.body == ground) return p.s_local;
    const Pose& pose = state.poses.at(static_cast<std::size_t>(p.body));
    return pose.r + pose.p * p.s_local;
}

struct Random {
    std::mt19937 engine{2004};

    double operator()(double low = -1, double high = 1) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    Vector3d vector(double size = 1) { return size * Vector3d((*this)(), (*this)(), (*this)()); }
    Vector3d unit() { return vector().normalized(); }
    Eigen::VectorXd many(int n, double size = 1) {
        return Eigen::VectorXd::NullaryExpr(n, [&] { return size * (*this)(); });
    }
    Quaterniond rotation(double angle = 3) {
        return Quaterniond(Eigen::AngleAxisd((*this)(0, angle), unit()));
    }
    Pose pose(double angle = 3) { return {vector(), rotation(angle)}; }
    Vector6 wrench(double force, double moment) {
        Vector6 w;
        w << vector(force), vector(moment);
        return w;
    }
    // Positive definite and coupled, of the size of suspension bushings.
    Matrix6 stiffness() {
        const Matrix6 root = Matrix6::NullaryExpr([&] { return (*this)(); });
        Vector6 units;  // √(N/m), √(N·m/rad)
        units << Vector3d::Constant(400), Vector3d::Constant(30);
        const Matrix6 K = units.asDiagonal() *
                          (root * root.transpose() + 0.3 * Matrix6::Identity()) *
                          units.asDiagonal();
        return (K + K.transpose()) / 2;
    }
};

// The largest of many deviations and its place; a NaN is the largest.
struct Worst {
    double value = 0;
    std::string where = "nowhere";
    int compared = 0;
    void add(double deviation, const std::string& at) {
        ++compared;
        if (deviation <= value || std::isnan(value)) return;
        value = deviation, where = at;
    }
    void add(double deviation, double at) { add(deviation, fmt::format("{}", at)); }
};
inline testing::AssertionResult within(const Worst& worst, double limit) {
    const bool ok = worst.compared > 0 && worst.value <= limit;
    return (ok ? testing::AssertionSuccess() : testing::AssertionFailure())
           << "worst " << worst.value << " of " << worst.compared << " at " << worst.where
           << ", allowed " << limit;
}
inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace elastocheck::support
