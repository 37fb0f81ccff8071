// Stress test: verdicts (right, reported failure, wrong), and the sweeps on built-in scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "compare/stress/stress.hpp"
#include "compare/stress/transforms.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

Scene small(const std::string& name, int steps = 10) {
    Scene scene = support::scene(name);
    scene.branches.resize(1);
    scene.branches.front().steps = steps;
    return scene;
}

std::string told(const StressCell& cell) {
    return fmt::format("{}, {}, {}, {}: {} {} {}", cell.scene, cell.variant, cell.side, cell.solver,
                       name(cell.verdict), cell.why, cell.detail);
}

TEST(Transforms, StiffenedElementHasTheScaledForceAtEqualDeformation) {
    Scene scene = small("single_bushing");
    Branch& branch = scene.branches.front();
    const Model a = compile(scene);
    scene.elastics.front() = stiffened(scene.elastics.front(), 8);
    branch.from *= 8;
    branch.to *= 8;
    const Model b = compile(scene);
    const auto here = solve_branch(sides_of(a, a.branches.front()), {.leg = Leg::equilibrium}),
               there = solve_branch(sides_of(b, b.branches.front()), {.leg = Leg::equilibrium});
    ASSERT_EQ(here.points.size(), there.points.size());
    for (std::size_t p = 0; p < here.points.size(); ++p)
        EXPECT_LE((here.points[p].poses[0].r - there.points[p].poses[0].r).norm(), 1e-12);
}

TEST(Stress, ResultThatChangesUnderATransformIsWrong) {
    // Declared to be the scene moved by 1 mm, but unchanged: every unchanged answer
    // must be detected.
    const Scene scene = small("pendulum");
    const Trial itself{"pendulum", std::string(as_it_is), {"as it is", scene}};
    const Trial lie{
        "pendulum",
        "moved",
        {.label = "not moved at all", .scene = scene, .transforms = Transform{.t = {1e-3, 0, 0}}}};
    const Survival survival = stress(std::vector{itself, lie});
    ASSERT_FALSE(survival.cells.empty());
    for (const auto& cell : survival.cells)
        EXPECT_EQ(cell.verdict == CellVerdict::wrong, cell.sweep == "moved") << told(cell);
}

TEST(Stress, WrongReactionAtACorrectPositionIsWrong) {
    // Declared to have forces larger by a thousandth: positions are the same, reactions are not.
    const Scene scene = small("pendulum");
    const Trial itself{"pendulum", std::string(as_it_is), {"as it is", scene}};
    const Trial lie{"pendulum", "scaled", {"not scaled at all", scene, Transform{.force = 1.001}}};
    const Survival survival = stress(std::vector{itself, lie});
    for (const auto& cell : survival.cells)
        EXPECT_EQ(cell.verdict == CellVerdict::wrong,
                  cell.sweep == "scaled" && std::isfinite(cell.claim) && cell.claim < 1e-6)
            << told(cell);
}

TEST(Stress, ConvergingWhereNoEquilibriumExistsIsWrong) {
    const Trial impossible{"pendulum",
                           "none",
                           {.label = "said to have none",
                            .scene = small("pendulum"),
                            .known = Variant::Construction::no_equilibrium}};
    const Survival survival = stress(std::vector{impossible});
    EXPECT_EQ(survival.count(CellVerdict::wrong), static_cast<int>(survival.solvers.size()));
}

TEST(Stress, ReportedFailureIsNotCountedAsWrong) {
    // Followers have no energy.
    const Survival survival =
        stress(std::vector{Trial{"follower", "x", {"as it is", small("follower")}}});
    for (const auto& cell : survival.cells)
        if (cell.solver == "energy") {
            EXPECT_EQ(cell.outcome, Outcome::not_conservative);
            EXPECT_EQ(cell.verdict, CellVerdict::reported_failure) << told(cell);
        }
}

TEST(Stress, CorrectDigitsAreRelativeToTheMovement) {
    // The published recursion of the pendulum has a known error (closed form in the head of the
    // scene) and reports its digits.
    const Survival survival =
        stress(std::vector{Trial{"pendulum", "x", {"as it is", small("pendulum", 60)}}});
    for (const auto& cell : survival.cells) {
        EXPECT_TRUE(std::isfinite(cell.error) && cell.range > 0) << told(cell);
        if (cell.digits < 16) {
            EXPECT_NEAR(cell.error, cell.range * std::pow(10, -cell.digits), 1e-6 * cell.error)
                << told(cell);
        }
        if (cell.solver == "published") {
            EXPECT_EQ(cell.verdict, CellVerdict::no_claim);
            EXPECT_LT(cell.digits, 4);
        }
        if (cell.solver == "equilibrium") {
            EXPECT_EQ(cell.verdict, CellVerdict::right);
            EXPECT_GT(cell.digits, 9);
        }
    }
}

// NaN in any acting quantity: no norm may drop it, no comparison may pass it.
TEST(Stress, NaNInAnyInputNeverConverges) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Scene scene = small("mcpherson", 4);
    std::vector<Trial> poisoned;
    const auto add = [&](const std::string& where, const auto& put) {
        Trial trial{
            "mcpherson",
            "NaN",
            {.label = where, .scene = scene, .known = Variant::Construction::no_equilibrium}};
        put(trial.variant.scene);
        poisoned.push_back(std::move(trial));
    };
    for (int k = 0; k < 3; ++k) {
        for (std::size_t e = 0; e < scene.elastics.size(); ++e)
            add(fmt::format("element {}, {}", e, k), [&](Scene& s) {
                if (auto* spring = std::get_if<AxialSpring>(&s.elastics[e].kind))
                    spring->free_length = nan;
                if (auto* bushing = std::get_if<Bushing>(&s.elastics[e].kind))
                    bushing->preload[k] = nan;
            });
        add(fmt::format("load, {}", k), [&](Scene& s) {
            std::get<DeadForce>(std::get<Load>(s.branches[0].drivers[0].what).kind).f[k] = nan;
        });
    }
    for (std::size_t e = 0; e < scene.elastics.size(); ++e)
        add(fmt::format("law of element {}", e),
            [&](Scene& s) { s.elastics[e] = stiffened(s.elastics[e], nan); });
    const Survival survival = stress(poisoned);
    EXPECT_GT(survival.cells.size(), 150u);
    for (const auto& cell : survival.cells)
        EXPECT_NE(cell.verdict, CellVerdict::wrong) << told(cell);
}

// A sample of ./dev stress.
TEST(Stress, NoResultOfThePendulumAndTheParallelSpringsIsWrong) {
    std::vector<Trial> sample;
    for (const auto& name : {"pendulum", "parallel_springs"})
        for (auto& trial : trials(name, small(name, 8)))
            if (trial.sweep != "steps") sample.push_back(std::move(trial));
    const Survival survival = stress(sample);
    EXPECT_GT(survival.judged(), 350);
    for (const auto& cell : survival.cells)
        EXPECT_NE(cell.verdict, CellVerdict::wrong) << told(cell);
}

}  // namespace
}  // namespace elastocheck::compare
