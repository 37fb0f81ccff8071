// Response to a small disturbance by central differences of whole solutions: the reference for a leg's linear response.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "elastocheck/compile.hpp"
#include "models/branch.hpp"
#include "models/response.hpp"

namespace elastocheck::support {

// A side of a branch and the model that is active on it.
struct SideModel {
    Model model;
    Branch branch;
};
// The side towards the sign of `to` of the branch whose name begins with `name`.
inline SideModel side_named(const Scene& scene, const std::string& name, double to) {
    const Model model = compile(scene);
    for (const auto& branch : model.branches)
        for (const auto& way : branch_sides(branch))
            if (way.name.starts_with(name) && way.to * to > 0) return {on_branch(model, way), way};
    throw std::logic_error("no branch " + name);
}

// The poses and the parameter of a state, without reactions.
inline Equilibrium poses_only(const Equilibrium& state) { return {state.load, state.poses, {}, 0}; }

// (dr, dπ) of every body [6nb].
inline Eigen::VectorXd stacked(const std::vector<Increment>& increments) {
    Eigen::VectorXd all(6 * static_cast<Eigen::Index>(increments.size()));
    for (Eigen::Index b = 0; b < all.size() / 6; ++b) {
        const Increment& body = increments[static_cast<std::size_t>(b)];
        all.segment<6>(6 * b) << body.dr, body.dpi;
    }
    return all;
}

// Largest difference of two entries over the largest entry of b; infinite for different sizes.
inline double relative_distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return a.size() == b.size() ? (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff()
                                : INFINITY;
}

inline UnitWrench at_wheel(const Model& model, const Eigen::Vector3d& force,
                           const Eigen::Vector3d& moment = Eigen::Vector3d::Zero()) {
    const Wheel& wheel = model.wheels[0];
    return {wheel.contact, force, moment};
}

// The branch with `by` times the disturbance as a constant driver.
inline Branch disturbed(Branch branch, const Disturbance& disturbance, double by) {
    if (const auto* wrench = std::get_if<UnitWrench>(&disturbance)) {
        branch.drivers.push_back({Load{"f", DeadForce{wrench->at, wrench->force}}, by, 0});
        branch.drivers.push_back({Load{"m", DeadMoment{wrench->at.body, wrench->moment}}, by, 0});
    } else {
        branch.drivers.push_back({std::get<Motion>(disturbance), by, 0});
    }
    return branch;
}

// State at the end of a branch by a leg.
using Solve = std::function<Equilibrium(const Model&, const Branch&)>;

// Central difference of the end states by the disturbance [6nb].
inline Eigen::VectorXd slope(const SideModel& way, const Disturbance& disturbance, double h,
                             const Solve& solve) {
    const Equilibrium plus = solve(way.model, disturbed(way.branch, disturbance, h)),
                      minus = solve(way.model, disturbed(way.branch, disturbance, -h));
    Eigen::VectorXd dq(coordinates(way.model));
    for (std::size_t b = 0; b < plus.poses.size(); ++b) {
        const Eigen::AngleAxisd turn(plus.poses[b].p * minus.poses[b].p.conjugate());
        const auto at = static_cast<Eigen::Index>(6 * b);
        dq.segment<3>(at) = (plus.poses[b].r - minus.poses[b].r) / (2 * h);
        dq.segment<3>(at + 3) = turn.angle() * turn.axis() / (2 * h);
    }
    return dq;
}

inline void expect_slope(const Eigen::VectorXd& answer, const SideModel& way,
                         const Disturbance& disturbance, double h, const Solve& solve,
                         const std::string& where) {
    const Eigen::VectorXd coarse = slope(way, disturbance, h, solve),
                          fine = slope(way, disturbance, h / 2, solve);
    // The error of central differences is of second order, so that it falls to a quarter unless it is rounding;
    // after extrapolation the error is of fourth order.
    const double missed = relative_distance(coarse, answer);
    if (missed > 1e-5) {
        EXPECT_NEAR(missed / relative_distance(fine, answer), 4, 0.5) << where;
    }
    EXPECT_LE(relative_distance((4 * fine - coarse) / 3, answer), missed * missed + 1e-6) << where;
}

}  // namespace elastocheck::support
