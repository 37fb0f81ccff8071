// Prediction of the end of a branch from the remaining stiffness.
#include <filesystem>

#include <gtest/gtest.h>

#include "compare/comparison/compare.hpp"
#include "compare/comparison/extrapolation.hpp"
#include "compare/comparison/legs.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

EquilibriumPath accounted(const Model& model, double to, Leg leg) {
    Branch branch = model.branches[0];
    branch.to = to;
    branch.steps = 20;
    return walk(sides_of(model, branch), {.leg = leg,
                                          .recursion = {.method = *recursive::find_method("chord")},
                                          .error_bound = true});
}

ErrorBoundSummary summary_of(std::span<const Equilibrium> points,
                             const std::optional<ErrorBound>& tolerance = {}) {
    ErrorBoundSummary summary;
    for (const auto& point : points) add(summary, point, tolerance);
    return summary;
}

// The squared stiffness is linear in the load only near the limit point: three points at a
// twentieth of the branch predict the limit to a tenth of the remaining distance.
TEST(Extrapolation, ALimitPointIsAnnouncedBeforeItIsMet) {
    const Model model = compile(support::scene("two_spring_arch"));  // the limit is at -211.5166 N
    for (const Leg leg : {Leg::recursive, Leg::equilibrium, Leg::energy, Leg::series})
        for (const double to : {-150., -200., -211.}) {
            const auto path = accounted(model, to, leg);
            ASSERT_EQ(path.outcome, Outcome::converged) << name(leg) << path.detail;
            const auto gone = stiffness_gone_near(path.points);
            ASSERT_TRUE(gone.has_value()) << name(leg);
            EXPECT_NEAR(*gone, -211.5166, 0.1 * (211.5166 + to)) << name(leg) << " from " << to;
            EXPECT_TRUE(stiffness_message(path.points, ParameterUnit::newton)
                            .starts_with("by extrapolation the stiffness vanishes near -2"))
                << stiffness_message(path.points, ParameterUnit::newton);
        }
}

TEST(Extrapolation, ABucklingLoadIsAnnouncedFromHalfTheWay) {
    const Model model =
        compile(read_scene((std::filesystem::path(ELASTOCHECK_SCENES) /
                            "../../tests/recursive/found/straight-column-one-body.yaml")
                               .string()));
    for (const Leg leg : {Leg::recursive, Leg::equilibrium, Leg::energy, Leg::series}) {
        const auto path = accounted(model, 1000, leg);  // it buckles at k / L = 1000 / 0.5
        ASSERT_EQ(path.outcome, Outcome::converged) << name(leg) << path.detail;
        const auto gone = stiffness_gone_near(path.points);
        ASSERT_TRUE(gone.has_value()) << name(leg);
        EXPECT_NEAR(*gone, 2000, 0.1) << name(leg);
    }
}

TEST(Extrapolation, IsToldSinceThePointFromWhichOnItIsSaid) {
    const Model model = compile(support::scene("two_spring_arch"));
    const auto path = accounted(model, -211, Leg::series);
    const std::span<const Equilibrium> points(path.points);
    const auto from = summary_of(points).announced_from;
    ASSERT_TRUE(from.has_value());
    for (std::size_t k = 3; k <= points.size(); ++k)
        EXPECT_EQ(!stiffness_message(points.first(k), ParameterUnit::newton).empty(),
                  points[k - 1].load <= *from)
            << points[k - 1].load;
    EXPECT_LT(-211, *from);
    EXPECT_FALSE(summary_of(accounted(model, 150, Leg::series).points).announced_from.has_value());
}

// Both sides of a branch start at a = 0: the prediction of the first is reported although the
// second has none.
TEST(Extrapolation, OfABranchIsToldWayByWay) {
    const Model model = compile(support::scene("two_spring_arch"));
    BranchErrorBounds error_bound;
    for (const double to : {-211., 150.})
        for (const auto& point : accounted(model, to, Leg::series).points) add(error_bound, point);
    EXPECT_EQ(error_bound.sides.size(), 2u);
    const auto lines = messages(error_bound, ParameterUnit::newton);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_TRUE(lines[0].starts_with("by extrapolation the stiffness vanishes near -211."))
        << lines[0];
    EXPECT_NE(lines[0].find(", predicted from -"), std::string::npos) << lines[0];
}

// A comparison reports the prediction of the equilibrium leg for any recursion method, and the
// tolerance check of a method with a tolerance. Error bounds change no state and no count.
TEST(Extrapolation, IsToldByWhoeverCompares) {
    Scene scene = support::scene("two_spring_arch");
    scene.branches.resize(1);
    scene.branches[0].to = -211, scene.branches[0].steps = 20;
    const Model model = compile(scene);
    for (const char* method : {"published", "chord", "series"}) {
        Options options;
        options.recursion.method = *recursive::find_method(method);
        options.prove = false;
        const Comparison all = compare(model, options);
        const auto& runs = all.branches[0].runs;
        const LegRun& equilibrium = runs[1];
        ASSERT_EQ(equilibrium.messages.size(), 1u) << method;
        EXPECT_TRUE(equilibrium.messages[0].starts_with(
            "by extrapolation the stiffness vanishes near -211."))
            << equilibrium.messages[0];
        const LegRun alone = run(model, model.branches[0], Leg::equilibrium);
        EXPECT_TRUE(alone.messages.empty());
        EXPECT_EQ(alone.counts.factorisations, equilibrium.counts.factorisations);
        EXPECT_EQ(alone.counts.evaluations, equilibrium.counts.evaluations);
        EXPECT_EQ(alone.curve.a, equilibrium.curve.a);
        if (std::string(method) != "series") {
            EXPECT_TRUE(runs[0].messages.empty()) << method;
        } else {
            EXPECT_FALSE(runs[0].messages.empty()) << method;  // the series predicts it too
        }
    }
    const Comparison bushing = compare(compile(support::scene("single_bushing")));
    for (const auto& run : bushing.branches[0].runs)
        EXPECT_TRUE(run.messages.empty()) << run.messages[0];
}

TEST(Extrapolation, APromiseIsSaidNotToBeKeptWhereABoundLiesAboveIt) {
    const auto tolerance = tolerance_of_method(*recursive::find_method("adaptive"), 1);
    ASSERT_TRUE(tolerance.has_value());
    EXPECT_EQ(tolerance->length, recursive::Adaptive{}.length_tolerance);
    EXPECT_FALSE(tolerance_of_method(*recursive::find_method("published"), 1).has_value());
    std::vector<Equilibrium> points(3);
    for (std::size_t k = 0; k < 3; ++k)
        points[k].load = 1e3 * static_cast<double>(k),
        points[k].bound = {tolerance->length, tolerance->angle};
    const auto text = [&] {
        return exceeded_bounds(summary_of(points, tolerance), *tolerance, ParameterUnit::newton);
    };
    EXPECT_EQ(text(), "");
    points[2].bound.length *= 2;
    EXPECT_TRUE(
        text().starts_with("promises 0.01 mm and 0.001 deg, which the error bounds of 1 of 3 "
                           "points exceed: 0.02 mm and 0.001 deg at 2000 N"))
        << text();
    points[1].bound = {};
    EXPECT_TRUE(text().ends_with("; 1 of 3 points have no error bound")) << text();
}

TEST(Extrapolation, NothingIsAnnouncedOfAStiffnessThatStaysOrThatNobodyTold) {
    const Model model = compile(support::scene("two_spring_arch"));
    EXPECT_EQ(
        stiffness_message(accounted(model, 150, Leg::equilibrium).points, ParameterUnit::newton),
        "");
    const auto untold = walk(sides_of(model, model.branches[0]), {.leg = Leg::recursive});
    EXPECT_FALSE(stiffness_gone_near(untold.points).has_value());
    EXPECT_FALSE(stiffness_gone_near({}).has_value());
}

}  // namespace
}  // namespace elastocheck::compare
