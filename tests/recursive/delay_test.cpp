// Stability limit of methods that rotate stored forces with one step's delay.
// The limit is predicted before the run.
#include <gtest/gtest.h>

#include <cmath>

#include "elastocheck/compile.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/singularity/stability_limit.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

// θ tan θ = 1, F = k_R θ / (L cos θ): where F L sin θ is k_R (models/scenes/pendulum.yaml).
const double pendulum_limit = 600 * 0.8603335890193797 / (0.4 * std::cos(0.8603335890193797));

TEST(DelayedForces, StabilityLimitOfAPendulumIsWhereGeometricStiffnessExceedsTheBushings) {
    Model model = compile(support::scene("pendulum"));
    const Analysis analysis = analyse(model);
    for (auto& branch : model.branches) {  // below the limit there is none; else wherever it ends
        EXPECT_FALSE(stability_limit(model, branch, methods[0], analysis).has_value());
        for (const double times : {20., 2e4, 1.0 / 2e5}) {
            branch.to *= times;
            EXPECT_NEAR(std::abs(stability_limit(model, branch, methods[0], analysis).value_or(0)),
                        pendulum_limit, 1);
        }
        for (const Method& method : methods) {
            const auto limit = stability_limit(model, branch, method, analysis);
            ASSERT_EQ(limit.has_value(), std::holds_alternative<Linear>(method.kind))
                << method.name;
            // In `balanced` the bushing's own moment is delayed as well.
            if (method.name == "balanced") {
                EXPECT_LT(std::abs(*limit), pendulum_limit);
            } else {
                EXPECT_NEAR(std::abs(limit.value_or(pendulum_limit)), pendulum_limit, 1)
                    << method.name;
            }
        }
    }
}

// A stable equilibrium that no number of steps reaches.
TEST(DelayedForces, PublishedMethodReportsDivergenceBeyondItsStabilityLimit) {
    Model model = compile(support::scene("pendulum"));
    for (auto& branch : model.branches) {
        branch.to *= 2;
        for (const int steps : {300, 600, 2400}) {
            const auto path = solve(model, branch, {.steps = steps});
            ASSERT_EQ(path.outcome, Outcome::diverged) << steps;
            EXPECT_NE(path.detail.find("by the model the method is stable to "), std::string::npos)
                << path.detail;
            EXPECT_GT(std::abs(path.points.back().load), pendulum_limit * 0.99);
        }
    }
}

// A bar hanging from its hinge on a torsion spring, with its weight P at L: T K_G = P L / k.
// With the hinge away from the body's origin, the curvature of the joint and its reaction give
// the same value.
TEST(DelayedForces, HangingBarHasDelayedShareWeightTimesLengthOverStiffness) {
    for (const bool hinge_at_origin : {true, false}) {
        Model model = model_of("bar", {{"points.head.z", "-0.5"},
                                       {"points.o.x", hinge_at_origin ? "0" : "0.1"},
                                       {"points.o.z", hinge_at_origin ? "0" : "0.3"}});
        model.branches.push_back(model.branches[0]);
        model.branches[1].to = -150;
        const Analysis analysis = analyse(model);
        const auto path =
            solve(model, model.branches[0], {.method = *find_method("series")}, analysis);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& point : path.points)
            EXPECT_NEAR(delayed_stiffness(model, model.branches[0], methods[0], analysis, point),
                        point.load * 0.5 / 100, 1e-9)
                << hinge_at_origin;
        const auto limit = stability_limit(model, model.branches[0], methods[0], analysis);
        ASSERT_TRUE(limit.has_value());
        EXPECT_NEAR(*limit, 200, 1e-6);
        // Under compression the delayed stiffness is negative: the branch ends, the
        // method is stable.
        EXPECT_FALSE(stability_limit(model, model.branches[1], methods[0], analysis).has_value());
    }
}

// The lever and axis parts of an element's geometric tangent add up to the whole.
TEST(DelayedForces, LeverAndAxisTermsAddUpToTheGeometricTangent) {
    const Model model = compile(support::scene("chrono_mcpherson_preload"));
    const Branch& branch = model.branches[0];
    const Analysis analysis = analyse(model);
    const auto path =
        solve(model, branch, {.method = *find_method("series"), .steps = 4}, analysis);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    const auto of = [&](const StoredForces& forces) {
        return delayed_stiffness(model, branch, {"", 0, Linear{.stored = forces}}, analysis,
                                 path.points.back());
    };
    const double none = of({}), lever = of({.lever_follows = true}),
                 axis = of({.axis_follows = true}), both = of(all_follow);
    for (const double share : {none, lever, axis, both})
        EXPECT_TRUE(std::isfinite(share) && share >= 0) << share;
    EXPECT_NE(lever, none);
    EXPECT_NE(axis, none);
    EXPECT_NE(both, lever);
    EXPECT_NE(both, axis);
}

}  // namespace
}  // namespace elastocheck::recursive
