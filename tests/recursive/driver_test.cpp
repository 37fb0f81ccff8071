// Driven branches and loss of stability, by methods of the recursion; more outcomes of every method are
// in tests/reports/claims/outcomes.claims.
#include <gtest/gtest.h>

#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/singularity/branch_events.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;

EquilibriumPath run(const SideModel& d, const Method& method, int steps = 0, int record = 0) {
    auto path = solve(d.model, d.branch, {.method = method, .steps = steps, .record = record});
    EXPECT_EQ(path.outcome, Outcome::converged) << method.name << ": " << path.detail;
    return path;
}
Method rung(const char* name) { return *find_method(name); }

// ---- A mechanism without elasticity, driven through a full turn: models/scenes/slider_crank.yaml.

SideModel slider_crank() { return all_sides(compile(support::scene("slider_crank"))).front(); }
double worst_slider(const EquilibriumPath& path) {
    constexpr double r = 0.06, l = 0.15;
    double worst = 0;
    for (const auto& point : path.points) {
        const double a = point.load, height = r * std::sin(a);
        worst = std::max(worst, std::abs(point.poses[1].r.x() - r * std::cos(a) -
                                         std::sqrt(l * l - height * height)));
    }
    return worst;
}

TEST(Driver, SliderCrankIsFollowedAtTheOrderOfEachMethod) {
    const SideModel d = slider_crank();
    // The error at a point is that of the method's last step: the order of one step.
    for (const auto& [name, order] :
         {std::pair{"closed", 2.0}, {"tangent", 2.0}, {"chord", 3.0}, {"midpoint", 3.0}}) {
        const double coarse = worst_slider(run(d, rung(name), 360, 36)),
                     fine = worst_slider(run(d, rung(name), 720, 36));
        if (fine > 1e-13) {
            EXPECT_GE(std::log2(coarse / fine), order - 0.2)
                << name << " " << coarse << " " << fine;
        }
    }
}

TEST(Driver, PublishedMethodHasFirstOrderConstraintErrorOnASliderCrank) {
    const SideModel d = slider_crank();
    // Over a whole turn the leading term vanishes, so the worst point of the branch is tested.
    const auto error = [&](int steps) {
        double worst = 0;
        for (const auto& point : run(d, rung("published"), steps, 8).points)
            worst = std::max(worst, point.constraint_error);
        return worst;
    };
    const double coarse = error(720), fine = error(1440);
    EXPECT_NEAR(std::log2(coarse / fine), 1, 0.1) << coarse << " " << fine;
}

// ---- An arch on a jack: the limit of the published sum past both limit points is
// ∫ 2k ζ²/(b² + ζ²) dζ, with the spring axes of each step.

TEST(Driver, PublishedJackForceOnAnArchConvergesToItsOwnClosedForm) {
    Scene scene = support::scene("two_spring_arch");
    constexpr double k = 1e5, b = 0.3, h = 0.08;
    scene.joints.push_back(
        {"jack", InPlane{scene.probes[0].at, {ground, {0, 0, h}}, {ground, Vector3d::UnitZ()}},
         true});
    const Motion jack{static_cast<int>(scene.joints.size()) - 1};
    const SideModel d =
        walked(scene, {"driven", 0, -2 * h - 0.02, 400, ParameterUnit::none, {{jack, 0, 1}}});
    for (const char* method : {"published", "closed"})
        for (const auto& point : run(d, rung(method)).points) {
            const double z = h + point.load;
            EXPECT_NEAR(point.reactions.back().force.z(),
                        2 * k * (z - h - b * (std::atan(z / b) - std::atan(h / b))), 5)
                << method;
        }
}

// ---- Stability lost inside a branch and regained before its end.

// The body of found/bubble.yaml, between two springs that are compressed as it moves through the
// line between their ends. It is unstable sideways while the springs are shorter than
// ℓ = ℓ_d / (1 + k_y / 2k), and stable before and after.
Model bubble(double k_y, double to) {
    return found("bubble", {setting("bushings.k.rates.y", k_y), setting("branches.d.to", to)});
}

// Load [N] at which the body of bubble() becomes unstable; NaN if k_y keeps it stable.
double bubble_begins(double k_y) {
    const double drawn = std::hypot(300, 80), length = drawn / (1 + k_y / 200),
                 z = std::sqrt(length * length - 300 * 300);
    return 20 * (z - 80) + 200 * (1 - drawn / length) * z;
}

TEST(StabilityWatch, SteppingMethodsEndWhereAnUnstableStretchBegins) {
    for (const double k_y : {6.5, 6.8, 6.9, 6.95, 6.97, 6.98, 6.985, 6.988})
        for (const double to : {-3200., -2500., -2100., -4100., -8000.}) {
            const Model model = bubble(k_y, to);
            const auto event = watch(model, model.branches[0], analyse(model));
            ASSERT_TRUE(event) << k_y << " " << to;
            EXPECT_NEAR(event->load, bubble_begins(k_y), 1e-4 * std::abs(to)) << k_y << " " << to;
        }
    const Model model = found("bubble");
    for (const auto& method : methods) {
        if (!has_steps(method)) continue;
        const auto path = solve(model, model.branches[0], {.method = method, .steps = 20});
        EXPECT_NE(path.outcome, Outcome::converged) << method.name;
        EXPECT_GE(path.points.back().load, bubble_begins(6.95)) << method.name;
    }
}

TEST(StabilityWatch, StableBranchHasNoEvent) {
    for (const double k_y : {6.99, 7.0, 7.1, 7.5})
        for (const double to : {-3200., -2500., -8000.}) {
            const Model model = bubble(k_y, to);
            EXPECT_FALSE(watch(model, model.branches[0], analyse(model))) << k_y << " " << to;
        }
}

TEST(StartStability, SceneAtRestIsJudgedOnceForAllItsBranches) {
    for (const int preload : {45, 55}) {
        const auto found =
            analyse(model_of("squeezed_block", {setting("springs.left.preload", preload),
                                                setting("springs.right.preload", preload)}));
        EXPECT_TRUE(found.at_rest);
        EXPECT_EQ(found.start.unstable, preload > 50);
    }
    EXPECT_FALSE(analyse(model_of("upright_bars")).at_rest);
}

}  // namespace
}  // namespace elastocheck::recursive
