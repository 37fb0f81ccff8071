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
