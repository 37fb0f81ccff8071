// Branch sides for the tests of the certificate: of the built-in scenes with the points of a leg on
// them, and the first of any scene.
#pragma once

#include <gtest/gtest.h>

#include "compare/comparison/legs.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "models/branch.hpp"
#include "reference/certificate/certificate.hpp"
#include "tests/support/builders.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reference::certificate {

using Eigen::Vector3d;

struct Walked {
    Model model;  // active on the side
    Branch branch;
    compare::Leg leg;
    std::vector<Equilibrium> points;
};
// Every branch side of a built-in scene by every leg that applies to it.
inline std::vector<Walked> walked(const std::string& scene, int points,
                                  const std::vector<compare::Leg>& legs = {
                                      compare::Leg::equilibrium}) {
    const Model model = compile(compare::trim(support::scene(scene)).scene);
    std::vector<Walked> all;
    for (const auto& branch : model.branches)
        for (const auto& way : compare::sides_of(model, branch, points))
            for (const auto leg : legs) {
                const EquilibriumPath path = compare::solve_branch(way, {.leg = leg});
                if (compare::is_not_applicable(path.outcome)) continue;
                EXPECT_EQ(path.outcome, Outcome::converged)
                    << scene << " " << way.name << " " << path.detail;
                all.push_back({way.model, way.branch, leg, path.points});
            }
    return all;
}

// The first side of the first branch.
struct Side {
    Model model;
    Branch branch;

    explicit Side(const Model& whole) {
        branch = branch_sides(whole.branches.front()).front();
        model = on_branch(whole, branch);
    }
    explicit Side(const std::string& scene) : Side(compile(parse_scene(scene, "test.yaml"))) {}

    Equilibrium solved(double a) const {
        const auto path = equilibrium::solve(model, branch, std::span(&a, 1));
        EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
        return path.points.empty() ? Equilibrium{} : path.points[0];
    }
    // As drawn, at this parameter.
    Equilibrium drawn(double a) const {
        Equilibrium state;
        state.load = a;
        for (const auto& body : model.bodies) state.poses.push_back(body.design);
        state.reactions.resize(model.joints.size());
        return state;
    }
    Certificate certify(const Equilibrium& state, const Tolerance& within = {}) const {
        return certificate::certify(model, branch, state, within);
    }
};

// Of a scene of tests/reference/scenes.
inline Side side_of(const std::string& name) {
    return Side(compile(support::scene_of("reference/scenes/" + name)));
}

}  // namespace elastocheck::reference::certificate
