// A-posteriori error bounds of path points hold and are tight.
// The remaining stiffness vanishes at the end of the branch.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

std::vector<double> every_point(const Branch& branch) {
    std::vector<double> a;
    for (int k = 0; k <= branch.steps; ++k) a.push_back(branch.to * k / branch.steps);
    return a;
}

// Every state with an error bound, of the legs and methods on a branch that the equilibrium leg
// solves, is within its bound of the state of that leg. The bound does not cover idle modes.
void expect_bounds(const Model& model, const Branch& branch, bool conservative,
                   const std::string& what) {
    const Analysis analysis = analyse(model);
    const auto idle = idle_bodies(model, analysis.diagnosis);
    const auto truth =
        reference::equilibrium::solve(model, branch, every_point(branch), {.error_bound = true});
    if (truth.outcome != Outcome::converged) return;
    const auto judge = [&](std::string_view who, const EquilibriumPath& path) {
        if (path.outcome != Outcome::converged) return;
        ASSERT_EQ(path.points.size(), truth.points.size()) << what << " " << who;
        for (std::size_t k = 0; k < path.points.size(); ++k) {
            const Equilibrium &point = path.points[k], &exact = truth.points[k];
            double length = 0, angle = 0;
            for (std::size_t b = 0; b < idle.size(); ++b) {
                if (idle[b]) continue;
                length = std::max(length, (point.poses[b].r - exact.poses[b].r).norm());
                const auto between =
                    point.poses[b].p.normalized().conjugate() * exact.poses[b].p.normalized();
                angle =
                    std::max(angle, 2 * std::atan2(between.vec().norm(), std::abs(between.w())));
            }
            EXPECT_TRUE(length <= point.bound.length + exact.bound.length &&
                        angle <= point.bound.angle + exact.bound.angle)
                << what << " " << who << " at " << point.load << ": " << length << " m, " << angle
                << " rad off, the bound is " << point.bound.length << " and " << point.bound.angle;
        }
    };
    judge("equilibrium", truth);
    if (conservative)
        judge("energy",
              reference::energy::solve(model, branch, every_point(branch), {.error_bound = true}));
    for (const Method& method : methods)
        judge(method.name, solve(model, branch, {.method = method, .error_bound = true}, analysis));
}

TEST(Account, BoundsHoldOnSmallScenesAndRandomOnes) {
    for (const std::string& name : support::small_scene_names()) {
        const Scene scene = support::scene(name);
        for (OneWay side : one_ways(compile(scene))) {
            side.branch.steps = std::min(side.branch.steps, 12);
            expect_bounds(side.model, side.branch, support::has_potential(scene),
                          name + " " + side.branch.name);
        }
    }
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const auto scene = compare::small_random_scene(seed);
        if (!scene) continue;
        OneWay side = one_ways(compile(*scene)).back();
        side.branch.steps = 5;
        expect_bounds(side.model, side.branch, support::has_potential(*scene),
                      fmt::format("seed {}", seed));
    }
}

// ---- Remaining stiffness.

// The arch of two springs, which moves only vertically: F'(z) over F'(z₀).
double arch_stiffness(double z) {
    const double l = std::hypot(0.3, z), l_0 = std::hypot(0.3, 0.08);
    return 2e5 * (1 - l_0 / l + l_0 * z * z / (l * l * l));
}

TEST(Account, TellsTheStiffnessThatIsLeftOfAnArch) {
    const Model model = compile(support::scene("two_spring_arch"));
    Branch branch = model.branches[0];
    branch.to = -211.5;  // the limit is at -211.5166 N
    branch.steps = 20;
    const auto judge = [&](const char* who, const EquilibriumPath& path) {
        ASSERT_EQ(path.outcome, Outcome::converged) << who << path.detail;
        for (const auto& point : path.points)
            EXPECT_NEAR(point.stiffness_left,
                        arch_stiffness(point.poses[0].r.z()) / arch_stiffness(0.08), 1e-6)
                << who << " at " << point.load;
        EXPECT_LT(path.points.back().stiffness_left, 0.02) << who;
    };
    judge("equilibrium",
          reference::equilibrium::solve(model, branch, every_point(branch), {.error_bound = true}));
    judge("energy",
          reference::energy::solve(model, branch, every_point(branch), {.error_bound = true}));
    judge("series", solve(model, branch, {.method = *find_method("series"), .error_bound = true}));
}

// A path by arc length continues past the limit point; there the stiffness is negative.
TEST(Account, StiffnessIsNegativePastALimitPoint) {
    Model model = compile(support::scene("two_spring_arch"));
    Branch& branch = model.branches[0];
    branch.to = -400;
    const Method arc{"series", 0, Series{.arc_length = true}};
    const auto path = solve(model, branch, {.method = arc, .steps = 60, .error_bound = true});
    ASSERT_FALSE(path.points.empty());
    int negative = 0;
    for (const auto& point : path.points) {
        const double exact = arch_stiffness(point.poses[0].r.z()) / arch_stiffness(0.08);
        EXPECT_NEAR(point.stiffness_left, exact, 1e-6) << point.load;
        negative += point.stiffness_left < 0;
        EXPECT_LE(point.bound.length, 1e-9) << point.load;
    }
    EXPECT_GT(negative, 5);
}

// Two modes that become unstable at once leave the sign of the determinant unchanged: a bar on a
// ball joint, with the same torsional rate in both directions.
TEST(Account, AColumnThatMayFallAnyWayIsNotFollowedPastItsLoad) {
    const Model model = model_of("column");
    const Branch& branch = model.branches[0];
    for (const Method& method : methods) {
        const auto path = solve(model, branch, {.method = method, .error_bound = true});
        EXPECT_EQ(path.outcome, Outcome::bifurcation_point)
            << method.name << " " << path.detail;  // at 100 / 0.5
        ASSERT_FALSE(path.points.empty()) << method.name;
        EXPECT_NEAR(path.points.back().load, 192.5, 1e-9) << method.name;
        for (const auto& point : path.points)
            EXPECT_NEAR(point.stiffness_left, 1 - point.load / 200, 1e-6)
                << method.name << " " << point.load;
    }
    EXPECT_EQ(reference::equilibrium::solve(model, branch, every_point(branch)).outcome,
              Outcome::bifurcation_point);
    EXPECT_EQ(reference::energy::solve(model, branch, every_point(branch)).outcome,
              Outcome::bifurcation_point);
}

// Newton's method may converge between two inconsistent links that stay open: no equilibrium, on no
// branch.
TEST(Account, WhereTheFirstPointHasNoBoundNothingIsPromised) {
    const Model model = model_of("links");
    for (const auto& method : methods) {
        const auto path = solve(model, model.branches[0], {.method = method, .error_bound = true});
        for (const auto& point : path.points)
            EXPECT_EQ(point.bound.length, std::numeric_limits<double>::infinity())
                << method.name << " at " << point.load;
    }
}

// Error bounds are computed only on request.
TEST(Account, IsGivenWhereItIsAsked) {
    const Model model = compile(support::scene("two_spring_arch"));
    Branch branch = model.branches[0];
    branch.to = -100;
    for (const bool asked : {false, true}) {
        for (const Method& method : methods)
            for (const auto& point :
                 solve(model, branch, {.method = method, .error_bound = asked}).points) {
                EXPECT_EQ(std::isfinite(point.bound.length), asked) << method.name;
                EXPECT_EQ(std::isnan(point.stiffness_left), !asked) << method.name;
            }
        const double loads[] = {0, -50, -100};
        for (const auto& path :
             {reference::equilibrium::solve(model, branch, loads, {.error_bound = asked}),
              reference::energy::solve(model, branch, loads, {.error_bound = asked})})
            for (const auto& point : path.points) {
                EXPECT_EQ(std::isfinite(point.bound.length), asked);
                EXPECT_EQ(std::isnan(point.stiffness_left), !asked);
            }
    }
}

}  // namespace
}  // namespace elastocheck::recursive
