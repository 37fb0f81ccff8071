// Regression scenes: branches of the series that were accepted although they lose their stability, or
// rejected; those that every method answers are in tests/reports/claims/outcomes.claims.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "elastocheck/compile.hpp"
#include "recursive/series/path.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scene_text.hpp"

namespace elastocheck::recursive {
namespace {

// With its stop further away the arch has a limit point at 204 N.
TEST(Series, LimitPointBeforeAKnotIsReported) {
    Model model = found("limit-behind-a-stop");
    for (auto& elastic : model.elastics)
        if (auto* spring = std::get_if<AxialSpring>(&elastic.kind))
            if (auto* curve = std::get_if<Curve>(&spring->law))
                for (double& knot : curve->knots) knot *= 1.2;
    for (const double to : {300., 1e4, 1e6}) {
        Branch branch = model.branches[0];
        branch.to = to;
        const auto path = series::follow(model, branch);
        ASSERT_EQ(path.outcome, Outcome::limit_point) << to << ": " << path.detail;
        EXPECT_NEAR(path.limits.back(), 204.08, 0.02) << to;
    }
}

// The arch is unstable sideways near its shortest spring length, 2.7 mm to either side, and stable
// at both ends of the branch.
TEST(Series, InstabilityInsideOneExpansionIsDetected) {
    const Model model = found("unstable-inside-an-expansion");
    for (const int order : {8, 16, 24}) {
        const auto path =
            series::follow(model, model.branches[0], {.order = order, .last_order = order});
        EXPECT_EQ(path.outcome, Outcome::bifurcation_point) << order << ": " << path.detail;
        ASSERT_FALSE(path.expansions.empty());
        const auto place = series::Place{path.expansions.size() - 1, path.expansions.back().reach};
        const auto last = series::evaluate(model, model.branches[0], path, place);
        EXPECT_NEAR(last.poses[0].r.z(), 2.7e-3, 0.2e-3) << order;
    }
}

// A table with 1000 rows needs an expansion for nearly every row.
TEST(Series, LimitOnExpansionsAppliesBetweenKnots) {
    constexpr int rows = 1000;
    std::string table;
    for (int k = 0; k <= rows; ++k) {
        const double x = 0.1 * k / rows;
        table += fmt::format("{}[{}, {}]", k > 0 ? ", " : "", x, 1e4 * x * (1 + 10 * x));
    }
    const Model model =
        compile(support::filled_scene("recursive/scenes/long_table", {{"ROWS", table}}));
    const auto path = series::follow(model, model.branches[0], {.expansions = 5});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    EXPECT_GT(path.expansions.size(), 900u);
}

}  // namespace
}  // namespace elastocheck::recursive
