// Order of convergence of the stepping methods, and outcomes where they must fail.
#include <gtest/gtest.h>

#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;

Method rung(const char* name) { return *find_method(name); }
bool sees_the_truth(const Method& method) { return !std::holds_alternative<Linear>(method.kind); }

// Largest distance of any body's origin [m], or of the orientation of a body without an idle mode
// [rad], over the recorded points.
double between(const Model& model, const EquilibriumPath& a, const EquilibriumPath& b) {
    EXPECT_EQ(a.points.size(), b.points.size());
    const auto idle = idle_bodies(model, diagnose(model));
    double worst = 0;
    for (std::size_t k = 0; k < std::min(a.points.size(), b.points.size()); ++k)
        for (std::size_t body = 0; body < idle.size(); ++body) {
            const Pose &in_a = a.points[k].poses[body], &in_b = b.points[k].poses[body];
            worst = std::max(
                {worst, (in_a.r - in_b.r).norm(), idle[body] ? 0 : in_a.p.angularDistance(in_b.p)});
        }
    return worst;
}

// Branch to round-off, by the series, checked by its residuals.
EquilibriumPath truth(const Model& model, const Branch& branch, int record = 10) {
    auto path = solve(model, branch, {.method = rung("series"), .steps = record});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    const auto left = residuals(model, branch, path.points.back());
    EXPECT_LE(std::max(left.force, left.moment), 1e-4);
    EXPECT_LE(left.length, 1e-12);
    return path;
}

TEST(Methods, EachMethodConvergesToTheEquilibriumAtItsFormalOrder) {
    for (const char* name : {"chrono_mcpherson", "chrono_mcpherson_preload", "pinned_bar",
                             "bushing_pair", "two_spring_arch"}) {
        for (const auto& [model, branch] : all_sides(compile(support::scene(name)))) {
            const auto exact = truth(model, branch);
            for (const auto& method : methods) {
                if (!has_steps(method)) continue;
                const auto error = [&](int steps) {
                    const auto path =
                        solve(model, branch, {.method = method, .steps = steps, .record = 10});
                    EXPECT_EQ(path.outcome, Outcome::converged)
                        << name << " " << method.name << ": " << path.detail;
                    return between(model, path, exact);
                };
                // Fine enough for the asymptotic order, coarse enough to stay above round-off.
                const int steps = method.formal_order == 2   ? 4000
                                  : method.formal_order == 3 ? 500
                                                             : 1000;
                const double coarse = error(steps), fine = error(2 * steps);
                if (fine < 1e-11) continue;
                EXPECT_NEAR(std::log2(coarse / fine), method.formal_order,
                            method.formal_order > 0 ? 0.15 : 0.12)
                    << name << " " << branch.name << " " << method.name << ": " << coarse << " "
                    << fine;
            }
        }
    }
}

// Eq. (31): |Φ| falls as 1/N, and where the constraints are closed as 1/N².
TEST(Methods, ConstraintErrorIsSecondOrderWhereConstraintsAreClosed) {
    for (const auto& [model, branch] : all_sides(compile(support::scene("chrono_mcpherson"))))
        for (const auto& [name, order] : {std::pair{"published", 1}, {"closed", 2}}) {
            const auto Phi = [&](int steps) {
                const auto path = solve(model, branch, {.method = rung(name), .steps = steps});
                EXPECT_EQ(path.points.size(), static_cast<std::size_t>(steps) + 1);
                return path.points.back().constraint_error;
            };
            for (const int steps : {75, 300, 1200})
                EXPECT_NEAR(std::log2(Phi(steps) / Phi(2 * steps)), order, 0.1) << name << steps;
        }
}

TEST(Methods, RecordingFewerPointsDoesNotChangeTheRecordedPoints) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    for (const auto& method : methods) {
        if (!has_steps(method)) continue;
        const auto full = solve(model, model.branches[0], {.method = method, .steps = 60});
        const auto some =
            solve(model, model.branches[0], {.method = method, .steps = 60, .record = 12});
        ASSERT_EQ(some.points.size(), 13u);
        for (std::size_t k = 0; k < 13; ++k) {
            EXPECT_EQ(some.points[k].load, full.points[5 * k].load);
            EXPECT_EQ(some.points[k].poses[1].r, full.points[5 * k].poses[1].r);
            EXPECT_EQ(some.points[k].reactions[0].force, full.points[5 * k].reactions[0].force);
        }
    }
}

TEST(Methods, AdaptiveKeepsItsToleranceAtAndBetweenItsSteps) {
    for (const auto& name : support::small_scene_names()) {
        for (const auto& [model, branch] : all_sides(compile(support::scene(name)))) {
            const auto exact = truth(model, branch, 150);
            for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
                const auto path = solve(
                    model, branch,
                    {.method = {"adaptive", 3, Adaptive{tolerance, tolerance}}, .steps = 150});
                ASSERT_EQ(path.outcome, Outcome::converged) << name << ": " << path.detail;
                EXPECT_LE(between(model, path, exact), tolerance + 1e-9)
                    << name << " " << branch.name << " " << tolerance;
            }
        }
    }
}

TEST(Methods, AdaptiveNeedsAtMostTwentyFactorisationsForThreeHundredPoints) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    for (const auto& branch : model.branches) {
        // 0.01 mm, 0.001 deg
        const auto path = solve(model, branch, {.method = rung("adaptive"), .steps = 300});
        EXPECT_EQ(path.points.size(), 301u);
        EXPECT_LE(path.counts.factorisations, 20);
    }
}

TEST(Methods, PublishedSumWithAllTermsConvergesToTheEquilibrium) {
    // Gap attribution starts from the published sum; with all three terms its limit is
    // the true equilibrium.
    const Model model = compile(support::scene("bushing_pair"));
    const auto exact = truth(model, model.branches[0]);
    Method method;
    method.kind = Linear{.stored = all_follow};
    const auto coarse =
                   solve(model, model.branches[0], {.method = method, .steps = 200, .record = 10}),
               fine =
                   solve(model, model.branches[0], {.method = method, .steps = 400, .record = 10});
    EXPECT_NEAR(std::log2(between(model, coarse, exact) / between(model, fine, exact)), 1, 0.1);
}

TEST(Methods, FewStepsGiveABoundedErrorOrAReportedFailure) {
    // With very few steps a method may be inaccurate or fail. Methods with the true residual reject
    // errors above half the motion; the others cannot detect it, but stay within twice the motion.
    double worst_share = 0;
    for (const auto& name : support::small_scene_names()) {
        for (auto [model, branch] : all_sides(compile(support::scene(name)))) {
            if (branch.unit == ParameterUnit::radian)
                branch.to /= 2;  // a full turn ends where it began
            const auto exact = truth(model, branch, 1);
            double moved = 0;
            for (std::size_t body = 0; body < model.bodies.size(); ++body)
                moved = std::max(
                    {moved, (exact.points[1].poses[body].r - exact.points[0].poses[body].r).norm(),
                     exact.points[1].poses[body].p.angularDistance(exact.points[0].poses[body].p)});
            for (const auto& method : methods)
                for (const int steps : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 17, 20}) {
                    const auto path =
                        solve(model, branch, {.method = method, .steps = steps, .record = 1});
                    if (path.outcome != Outcome::converged) continue;
                    const double share = between(model, path, exact) / moved;
                    EXPECT_LE(share, sees_the_truth(method) ? 0.5 : 2)
                        << name << " " << branch.name << " " << method.name << " " << steps;
                    if (sees_the_truth(method)) worst_share = std::max(worst_share, share);
                }
        }
    }
    EXPECT_GT(worst_share, 0.1);  // inaccurate results did occur: not everything was rejected
}

TEST(Methods, EveryMethodIsFoundByItsName) {
    for (const auto& method : methods) EXPECT_EQ(find_method(method.name)->name, method.name);
    EXPECT_FALSE(find_method("tangnt"));
    EXPECT_EQ(Options{}.method.name, "published");
}

}  // namespace
}  // namespace elastocheck::recursive
