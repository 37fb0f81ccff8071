// Ill-posed scenes give an outcome instead of a wrong number.
// Nearly redundant or inconsistent joints, limits of the laws, points next to a limit point.
#include <gtest/gtest.h>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/diagnosis/loops.hpp"
#include "tests/recursive/walks.hpp"

namespace elastocheck::recursive {
namespace {

TEST(Extremes, UndecidableRankIsReported) {
    for (const double skew : {0.0, 1e-15, 1e-12, 3e-10, 1e-6}) {
        const Model model = model_of("door", {setting("points.skew.x", skew)});
        for (const Method& method : methods) {
            const auto path = solve(model, model.branches[0], {.method = method});
            const bool in_doubt = skew > 1e-13 && skew < 1e-9;
            EXPECT_EQ(path.outcome, in_doubt ? Outcome::singular : Outcome::converged)
                << method.name << " " << skew << path.detail;
            EXPECT_EQ(
                path.detail.find("joint 'upper' is redundant is undecidable") != std::string::npos,
                in_doubt)
                << path.detail;
            EXPECT_EQ(path.points.empty(), in_doubt) << method.name;
        }
    }
}

TEST(Extremes, JointsInconsistentByMoreThanNineDigitsAreRejected) {
    for (const double apart : {0.0, 1e-13, -1e-8, 1e-8, 1e-6, 1e-3}) {
        SCOPED_TRACE(apart);
        expect_of_every_method(
            model_of("links", {setting("joints.link.length", 500 + 1e3 * apart)}),
            {std::abs(apart) < 1e-9 ? Outcome::converged : Outcome::inconsistent_constraints});
    }
}

// The lever of models/extremes/over_centre has its limit point at 63.3413 N. The expansions before
// it are short, and rounding of the load exceeds the range of some.
TEST(Extremes, SeriesReachesEveryPointUpToALimitPoint) {
    int converged = 0;
    for (int k = 0; k < 40; ++k) {
        const Model model = model_of("lever", {setting("branches.pull.to", 63.3 + 0.001 * k)});
        const auto path = solve(model, model.branches[0], {.method = *find_method("series")});
        converged += path.outcome == Outcome::converged;
        EXPECT_EQ(path.points.size() == 41, path.outcome == Outcome::converged)
            << model.branches[0].to << " " << path.points.size() << " " << path.detail;
    }
    EXPECT_GT(converged, 30);
}

// A row without moving bodies forms a loop of its own.
TEST(Extremes, LinkBetweenFixedPointsIsConsistentOnlyAtItsOwnLength) {
    const Model model = model_of("fixed_link");
    ASSERT_EQ(model.bodies.size(), 1u);  // the block is ground
    for (const int row : loops(model)) EXPECT_GE(row, 0);
    for (const Method& method : methods) {
        EXPECT_EQ(solve(model, model.branches[0], {.method = method}).outcome, Outcome::converged)
            << method.name;
        EXPECT_EQ(solve(model, model.branches[1], {.method = method}).outcome,
                  Outcome::inconsistent_constraints)
            << method.name;
    }
}

Model rod(double weight, double to) {
    return model_of(
        "rod", {setting("static_loads.weight.force.x", weight), setting("branches.along.to", to)});
}

TEST(Extremes, CompressedRodIsUnstableAndTensionedRodIsStable) {
    for (const Method& method : methods) {
        const Model pulled = rod(0, 500), pushed = rod(0, -500);
        EXPECT_EQ(solve(pulled, pulled.branches[0], {.method = method}).outcome, Outcome::converged)
            << method.name;
        const auto falls = solve(pushed, pushed.branches[0], {.method = method});
        EXPECT_EQ(falls.outcome, Outcome::bifurcation_point) << method.name << falls.detail;
        EXPECT_LE(falls.points.size(), 1u) << method.name;  // at most the first point
    }
}

TEST(Extremes, BodyBalancedOnABallJointStartsUnstable) {
    for (const Method& method : methods) {
        const Model hangs = rod(50, 100), stands = rod(-50, 10), falls = rod(50, -100);
        const auto path = solve(hangs, hangs.branches[0], {.method = method});
        EXPECT_EQ(path.outcome, Outcome::converged) << method.name << path.detail;
        const auto none = solve(stands, stands.branches[0], {.method = method});
        EXPECT_EQ(none.outcome, Outcome::singular) << method.name;
        EXPECT_NE(none.detail.find("that settles at 0"), none.detail.npos)
            << method.name << none.detail;
        // Hangs until the load exceeds its weight, at 50 N.
        const auto over = solve(falls, falls.branches[0], {.method = method});
        EXPECT_EQ(over.outcome, Outcome::bifurcation_point) << method.name << over.detail;
        ASSERT_FALSE(over.points.empty());
        EXPECT_NEAR(over.points.back().load, -50, 13) << method.name;
        EXPECT_GE(over.points.back().load, -50 * (1 + 1e-5)) << method.name;
    }
}

// Two modes that become unstable at once leave the sign of the determinant unchanged: a bar on a
// ball joint, with the same torsional rate in both directions.
TEST(Extremes, AxisymmetricColumnEndsAtItsBucklingLoad) {
    const Model model = model_of("column");
    const Branch& branch = model.branches[0];
    for (const Method& method : methods) {
        const auto path = solve(model, branch, {.method = method});
        EXPECT_EQ(path.outcome, Outcome::bifurcation_point)
            << method.name << " " << path.detail;  // at 100 / 0.5
        ASSERT_FALSE(path.points.empty()) << method.name;
        EXPECT_NEAR(path.points.back().load, 192.5, 1e-9) << method.name;
    }
    const double loads[] = {0, branch.to};
    EXPECT_EQ(reference::equilibrium::solve(model, branch, loads).outcome,
              Outcome::bifurcation_point);
    EXPECT_EQ(reference::energy::solve(model, branch, loads).outcome, Outcome::bifurcation_point);
}

}  // namespace
}  // namespace elastocheck::recursive
