// Outcomes of the equilibrium leg that depend on its own options, and its messages.
#include <fmt/format.h>

#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "reference/equilibrium/statement/system.hpp"
#include "tests/reference/equilibrium/scenes.hpp"
#include "tests/support/scene_text.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

// The points before a failure must be as accurate as others.
void expect_points_in_balance(const Model& model, const Branch& branch, const EquilibriumPath& path,
                              double limit = 1e-8) {
    if (path.points.empty()) return;
    Worst worst;
    for (const auto& state : path.points) {
        const auto r = residuals(model, branch, state);
        for (const double part : {r.length, r.direction, r.force, r.moment})
            worst.add(part, fmt::format("{}", state.load));
    }
    EXPECT_TRUE(within(worst, limit));
}

// A bushing with an axis along (1, 2, 3), many decades softer than its other axes, is pulled along
// it: the displacement is load / rate. Where K in ground axes has lost the soft rate to rounding,
// the leg reports a failure.
TEST(EquilibriumOutcome, MotionThirteenDecadesSofterIsNotIdle) {
    const Vector3d along = Vector3d(1, 2, 3).normalized();
    const auto pulled = [&](double stiff) {
        const Model model = compile(support::filled_scene(
            "reference/scenes/soft_axis",
            {{"RATES", fmt::format("{0}, {0}, 1e-4", stiff)},
             {"FORCE",
              fmt::format("{:.17g}, {:.17g}, {:.17g}", along.x(), along.y(), along.z())}}));
        return solve(model, model.branches[0], every_point(model.branches[0]));
    };
    for (const double stiff : {1e2, 1e5, 1e7, 1e9, 1e10}) {
        const auto path = pulled(stiff);
        ASSERT_EQ(path.outcome, Outcome::converged) << stiff << ": " << path.detail;
        Worst worst;
        for (const auto& state : path.points)
            worst.add((state.poses[0].r - state.load / 1e-4 * along).norm(),
                      fmt::format("{}", state.load));
        EXPECT_TRUE(within(worst, 1e-11)) << stiff;
    }
    for (const double stiff : {1e12, 1e14}) {
        const auto path = pulled(stiff);
        EXPECT_EQ(path.outcome, Outcome::iteration_limit) << stiff << ": " << path.detail;
        EXPECT_NE(path.detail.find("so much softer"), std::string::npos) << path.detail;
    }
}

TEST(EquilibriumOutcome, TooFewIterationsAreReportedAsSuch) {
    Options options;
    options.iteration_limit = 1;
    options.halvings = 2;
    const Model model = compile(scene("chrono_mcpherson"));
    const std::vector<double> loads = {0, 500, 1000};
    const auto path = solve(model, model.branches[0], loads, options);
    EXPECT_EQ(path.outcome, Outcome::iteration_limit) << path.detail;
    expect_points_in_balance(model, model.branches[0], path);
}

TEST(EquilibriumOutcome, UnreachableToleranceIsReported) {
    Options options;
    options.tolerance = 1e-19;
    options.halvings = 3;
    const Model model = compile(scene("chrono_mcpherson"));
    const std::vector<double> loads = {0, 500, 1000};
    const auto path = solve(model, model.branches[0], loads, options);
    EXPECT_EQ(path.outcome, Outcome::iteration_limit) << path.detail;
}

// A parallelogram is flat at half a turn, where it may continue in either of two configurations.
TEST(EquilibriumOutcome, MechanismEndsAtABifurcationOfItsConstraints) {
    const Vector3d pin = 0.04 * X, far = 0.1 * X;
    const Quaterniond quarter(Eigen::AngleAxisd(M_PI / 2, Z));
    Scene s;
    s.bodies = {{"crank", {{0, 0, 0}, quarter}},
                {"coupler", {{0, 0.04, 0}, Quaterniond::Identity()}},
                {"rocker", {far, quarter}}};
    s.joints = {{"crank pivot", Revolute{{0}, {ground}, {0, Z}, ground_z}},
                {"crank pin", Revolute{{1}, {0, pin}, {1, Z}, {0, Z}}},
                {"rocker pivot", Revolute{{2}, {ground, far}, {2, Z}, ground_z}},
                {"rocker pin", InLine{{1, far}, {2, pin}, {2, Z}}},
                {"drive", Angle{{0, X}, ground_y, {ground, -X}, 0}, true}};
    s.branches = {branch_of({{Motion{4}, 0, 1}}, M_PI, ParameterUnit::radian)};
    s.probes = {{"rocker", {2, pin}}};
    const Model whole = compile(s), driven = on_branch(whole, whole.branches[0]);
    for (const int steps : {1, 5, 20, 101}) {
        std::vector<double> points;
        for (int n = 0; n <= steps; ++n) points.push_back(M_PI * n / steps);
        const auto path = solve(driven, driven.branches[0], points);
        EXPECT_EQ(path.outcome, Outcome::singular) << steps << ": " << path.detail;
        EXPECT_NEAR(static_cast<double>(path.points.size()), 1 + std::floor(steps / 2.), 1)
            << path.detail;
    }
}

TEST(EquilibriumOutcome, MessagesGiveTheParameterInItsUnit) {
    const auto text = [](ParameterUnit unit) { return parameter(branch_of({}, 1, unit), 0.25); };
    EXPECT_EQ(text(ParameterUnit::newton), "0.25 N");
    EXPECT_EQ(text(ParameterUnit::newton_metre), "0.25 N·m");
    EXPECT_EQ(text(ParameterUnit::metre), "250 mm");
    EXPECT_EQ(text(ParameterUnit::radian), "14.323945 deg");
    EXPECT_EQ(text(ParameterUnit::none), "0.25");
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
