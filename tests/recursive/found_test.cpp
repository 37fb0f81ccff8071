// Regression scenes: solvable scenes that were rejected, and branches that were accepted although
// they lose their stability.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/series/path.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

Method named(const char* name) { return find_method(name).value(); }

// Without its stop the arch has a limit point at 204 N; the stop closes a fraction of a newton
// before. The result must not depend on the length of the branch.
TEST(Series, LimitPointBeyondAKnotIsNotReported) {
    const Model model = found("limit-behind-a-stop");
    for (const double to : {204.2, 300., 2000., 1e4, 1e5, 1e6}) {
        Branch branch = model.branches[0];
        branch.to = to;
        const auto path = solve(model, branch, {.method = named("series")});
        EXPECT_EQ(path.outcome, Outcome::converged) << to << ": " << path.detail;
    }
}
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

// In a driven mechanism without loads the joint reactions consist of rounding only.
TEST(Adaptive, BranchWithoutForcesConverges) {
    const Model model = found("adaptive-lost-without-forces");
    const auto path = solve(model, model.branches[0], {.method = named("adaptive")});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    EXPECT_EQ(path.points.size(), 21u);
}

// A column whose load has a small offset from its axis has no limit point, however sharp the bend
// of its path.
TEST(Found, ImperfectColumnHasNoLimitPoint) {
    for (const double off : {1e-3, 1e-6, 1e-9, 1e-10, 1e-11})
        for (const double to : {250., 1e3}) {
            Model model = model_of("bar", {setting("points.head.x", off)});
            model.branches[0].to = to;
            for (const char* method : {"series", "adaptive"}) {
                const auto path = solve(model, model.branches[0], {.method = named(method)});
                EXPECT_EQ(path.outcome, Outcome::converged)
                    << off << " " << to << " " << method << ": " << path.detail;
            }
        }
}

// The arch is unstable sideways near its shortest spring length, 2.7 mm to either side, and stable
// at both ends of the branch.
TEST(Series, InstabilityInsideOneExpansionIsDetected) {
    const Model model = found("unstable-inside-an-expansion");
    for (const int order : {8, 16, 24}) {
        const auto path = series::follow(model, model.branches[0], {.order = order});
        EXPECT_EQ(path.outcome, Outcome::bifurcation_point) << order << ": " << path.detail;
        ASSERT_FALSE(path.expansions.empty());
        const auto place = series::Place{path.expansions.size() - 1, path.expansions.back().reach};
        const auto last = series::evaluate(model, model.branches[0], path, place);
        EXPECT_NEAR(last.poses[0].r.z(), 2.7e-3, 0.2e-3) << order;
    }
}

// A table with 1000 rows needs an expansion for nearly every row.
TEST(Series, ExpansionLimitAppliesPerKnot) {
    constexpr int rows = 1000;
    std::string table;
    for (int k = 0; k <= rows; ++k) {
        const double x = 0.1 * k / rows;
        table += fmt::format("{}[{}, {}]", k > 0 ? ", " : "", x, 1e4 * x * (1 + 10 * x));
    }
    const Model model = compile(parse_scene(fmt::format(
                                                R"(elastocheck: 1
name: rows
units: {{length: m, angle: rad, force: N}}
points: {{a: [0, 0, 0], b: [0, 0, 0.5]}}
bodies: {{m: {{origin: a}}}}
joints: {{g: {{type: translational, bodies: [m, ground], at: a, axis: z}}}}
springs: {{s: {{bodies: [m, ground], from: a, to: b, curve: {{table: [{}], symmetric: true}}}}}}
loads: {{f: {{on: m, at: a, force: [0, 0, 1]}}}}
branches: {{d: {{load: f, to: 1900, steps: 10}}}}
probes: {{a: {{on: m, at: a}}}}
)",
                                                table),
                                            "rows.yaml"));
    const auto path = series::follow(model, model.branches[0], {.expansions = 5});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    EXPECT_GT(path.expansions.size(), 900u);
}

// Pivots are judged in the scaling of the present matrix: the geometric stiffness of links that bear
// 770 kN is nothing at λ = 0, where the scaling was chosen.
TEST(Found, LargeReactionsOnRigidBodiesAreNotReportedSingular) {
    const auto sides = one_ways(found("bodies-without-stiffness"));
    ASSERT_EQ(sides.size(), 1u);
    for (const Method& method : methods) {
        const auto path = solve(sides[0].model, sides[0].branch, {.method = method});
        EXPECT_EQ(path.outcome, Outcome::converged) << method.name << ": " << path.detail;
        EXPECT_EQ(path.points.size(), 61u) << method.name;
    }
}

}  // namespace
}  // namespace elastocheck::recursive
