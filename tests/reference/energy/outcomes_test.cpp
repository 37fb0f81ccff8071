// Outcomes of the energy leg that depend on its own options, and its messages.
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

TEST(Outcomes, TooFewEvaluationsAreReported) {
    const Model model = compile(scene_named("chrono_mcpherson"));
    Options options;
    options.evaluation_limit = 1;
    options.recentre_limit = 1;
    options.tolerance = 1e-17;
    const double loads[] = {0, 1000};
    const auto path = solve(model, model.branches[0], loads, options);
    EXPECT_EQ(path.outcome, Outcome::iteration_limit) << path.detail;
    EXPECT_LT(path.points.size(), 2u);
}

// Between points the strut rotates only across its axis; the spin is of second order in the step.
TEST(Outcomes, IdleStrutDoesNotSpin) {
    const Eigen::Vector3d axis = Eigen::Vector3d(0.04097493, 0.0682915, -0.3305464).normalized();
    const Model model = compile(scene_named("chrono_mcpherson"));
    ASSERT_EQ(model.bodies[2].name, "strut");
    double worst = 0, turned = 0;
    const auto path = solve(model, model.branches[0], every_point(model.branches[0]));
    for (std::size_t k = 1; k < path.points.size(); ++k) {
        const auto &p = path.points[k - 1].poses[2].p, &q = path.points[k].poses[2].p;
        const Eigen::AngleAxisd turn(q * p.conjugate());
        worst = std::max(worst, std::abs(turn.angle() * turn.axis().dot(q * axis)));
        turned = std::max(turned, turn.angle());
    }
    EXPECT_GT(turned, 1e-4);  // [rad] per step
    EXPECT_LE(worst, 1e-6);
}

TEST(Outcomes, MessagesGiveTheParameterInItsUnit) {
    Scene scene = scene_named("pinned_bar");
    const std::pair<ParameterUnit, const char*> texts[] = {
        {ParameterUnit::newton, "at inf N:"},
        {ParameterUnit::newton_metre, "at inf N·m:"},
        {ParameterUnit::metre, "at inf mm:"},
        {ParameterUnit::radian, "at inf deg:"},
        {ParameterUnit::none, "at inf:"}};
    for (const auto& [unit, text] : texts) {
        scene.branches[0].unit = unit;
        const double values[] = {INFINITY};
        const auto path = solve(scene, 0, values);
        EXPECT_EQ(path.outcome, Outcome::not_finite);
        EXPECT_NE(path.detail.find(text), std::string::npos) << path.detail;
    }
}

}  // namespace
}  // namespace elastocheck::reference::energy
