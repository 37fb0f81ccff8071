// Every equilibrium at one load: those that are known in closed form are found, proved, told apart, and said what they are.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/compare.hpp"
#include "compare/find_all.hpp"
#include "models/compile.hpp"
#include "models/reader/scene_file.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using reference::certificate::Answer;

// Two springs that meet flat at an apex: V(z) = 2 · ½ k (ℓ(z) - ℓ₀)² - f z, ℓ² = w² + z².
constexpr double w = 0.3, h = 0.08, k = 100e3;

std::string arch(const std::string& to) {
    return R"(elastocheck: 1
name: arch
units: {length: mm, angle: deg, force: N}
points: {l: [-300, 0, 0], r: [300, 0, 0], apex: [0, 0, 80]}
bodies: {a: {origin: apex}}
joints: {g: {type: translational, bodies: [a, ground], at: apex, axis: z}}
springs:
  l: {bodies: [a, ground], from: apex, to: l, rate: 100}
  r: {bodies: [a, ground], from: apex, to: r, rate: 100}
loads: {v: {on: a, at: apex, force: [0, 0, 1]}}
branches: {d: {load: v, to: )" +
           to + R"(, steps: 20}}
probes: {apex: {on: a, at: apex}}
)";
}

double force(double z) {
    const double length = std::hypot(w, z), drawn = std::hypot(w, h);
    return 2 * k * (length - drawn) * z / length;
}

// The heights at which the arch bears the load, by bisection between its extremes.
std::vector<double> heights(double load) {
    std::vector<double> roots;
    constexpr int pieces = 4000;
    for (int n = 0; n < pieces; ++n) {
        double low = -0.2 + 0.4 * n / pieces, high = -0.2 + 0.4 * (n + 1) / pieces;
        if ((force(low) - load) * (force(high) - load) > 0) continue;
        for (int half = 0; half < 60; ++half) {
            const double middle = (low + high) / 2;
            ((force(low) - load) * (force(middle) - load) <= 0 ? high : low) = middle;
        }
        roots.push_back(low);
    }
    return roots;
}

AllEquilibria all_of(const std::string& text, double a) {
    const Model model = compile(parse_scene(text, "scene.yaml"));
    return find_all(model, model.branches.front(), a);
}

TEST(FindAll, TheArchHasThreeAtALoadBelowItsLimitEachProvedAndWhereTheClosedFormHasThem) {
    for (const double load : {-120.0, -40.0, -200.0}) {
        const auto all = all_of(arch("-200"), load);
        const auto expected = heights(load);
        ASSERT_EQ(expected.size(), 3u);
        ASSERT_EQ(all.list.size(), 3u) << load;
        EXPECT_TRUE(all.proved);
        EXPECT_EQ(all.stable(), 2);
        std::vector<double> found;
        for (const auto& one : all.list) {
            EXPECT_EQ(one.proof.answer, Answer::proved) << one.proof.detail;
            found.push_back(one.state.poses[0].r.z());
            // It is stable where the force rises with the height.
            const double z = found.back(), e = 1e-6;
            EXPECT_EQ(one.stable, force(z + e) > force(z - e)) << z;
            EXPECT_EQ(one.stable, one.proof.stable) << z;
        }
        std::ranges::sort(found);
        for (int n = 0; n < 3; ++n)
            EXPECT_NEAR(found[static_cast<std::size_t>(n)], expected[static_cast<std::size_t>(n)], 1e-9);
        EXPECT_TRUE(all.list.front().on_branch);
        EXPECT_NEAR(all.list.front().state.poses[0].r.z(), expected[2], 1e-9);
        EXPECT_EQ(std::ranges::count(all.list, true, &FoundEquilibrium::on_branch), 1);
        EXPECT_EQ(all.list.back().body, "a");
        EXPECT_NEAR(all.list.back().length, expected[2] - expected[0], 1e-9);
        EXPECT_NE(all.list.back().meaning.find("snap over"), std::string::npos);
    }
}

TEST(FindAll, PastTheLimitThereIsOneAndTheBranchDoesNotLeadThere) {
    const auto all = all_of(arch("-1500"), -1500);
    EXPECT_NE(all.outcome, Outcome::converged);
    ASSERT_EQ(all.list.size(), 1u);
    EXPECT_TRUE(all.proved);
    EXPECT_TRUE(all.list[0].stable);
    EXPECT_FALSE(all.list[0].on_branch);
    EXPECT_NEAR(all.list[0].state.poses[0].r.z(), heights(-1500)[0], 1e-9);
    EXPECT_NE(all.list[0].meaning.find("from where the branch ends"), std::string::npos);
}

// Flat, its springs pressed: no branch begins, and what is found is where it is, not "0 mm away".
TEST(FindAll, WhereNoBranchBeginsDistancesAreFromTheDrawing) {
    std::string flat = arch("-100");
    flat.replace(flat.find("[0, 0, 80]"), 10, "[0, 0, 0]");
    for (std::size_t at; (at = flat.find("rate: 100}")) != flat.npos;)
        flat.replace(at, 10, "rate: 100, free_length: 310}");
    const auto all = all_of(flat, 0);
    EXPECT_FALSE(all.begins);
    ASSERT_EQ(all.list.size(), 3u);
    EXPECT_EQ(all.stable(), 2);
    for (const auto& one : all.list) {
        EXPECT_NEAR(one.length, one.stable ? std::sqrt(0.31 * 0.31 - 0.3 * 0.3) : 0, 1e-9);
        EXPECT_NE(one.meaning.find("from the drawing, from which no branch begins"), one.meaning.npos);
    }
}

// A rod upright on a torsion spring: it buckles at 100 N.
const std::string column = R"(elastocheck: 1
name: column
units: {length: m, angle: rad, force: N}
points: {foot: [0, 0, 0], head: [0, 0, 1], side: [0, 1, 0]}
bodies: {rod: {origin: foot}}
joints: {hinge: {type: revolute, bodies: [rod, ground], at: foot, axis: y}}
torsion_springs: {spring: {bodies: [rod, ground], at: foot, axis: y, rate: 100}}
loads: {v: {on: rod, at: head, force: [0, 0, -1]}}
branches: {d: {load: v, to: 90, steps: 20}}
probes: {head: {on: rod, at: head}}
)";

TEST(FindAll, AStraightColumnPastItsBucklingLoadHasABentOneOnEitherSide) {
    // k θ = f sin θ
    const double f = 120;
    double theta = 1;
    for (int n = 0; n < 200; ++n) theta = f / 100 * std::sin(theta);
    const auto all = all_of(column, f);
    ASSERT_EQ(all.list.size(), 3u);
    EXPECT_TRUE(all.proved);
    EXPECT_EQ(all.stable(), 2);
    std::vector<double> x;
    for (const auto& one : all.list) {
        const auto axis = one.state.poses[0].p * Eigen::Vector3d::UnitZ();
        x.push_back(std::atan2(axis.x(), axis.z()));
        EXPECT_EQ(one.stable, std::abs(x.back()) > 0.1);
    }
    std::ranges::sort(x);
    EXPECT_NEAR(x[0], -theta, 1e-8);
    EXPECT_NEAR(x[1], 0, 1e-8);
    EXPECT_NEAR(x[2], theta, 1e-8);
    // Those are turned by 59 deg; what may not turn so far has the straight one alone.
    const Model model = compile(parse_scene(column, "scene.yaml"));
    const auto upright = find_all(model, model.branches.front(), f, {.turn = 0.9});
    EXPECT_EQ(upright.list.size(), 1u);
    EXPECT_EQ(upright.turned_over, 2);
}

TEST(FindAll, LegsOnTwoBranchesAreSaidToBeAndNotToDeviate) {
    const Model model = compile(parse_scene(arch("-120"), "scene.yaml"));
    const auto comparison = compare(model);
    auto branch = comparison.branches[0];
    const auto said = [&] {
        return disagreements(model, comparison.channels, model.branches[0], branch).texts();
    };
    EXPECT_TRUE(said().empty());
    for (auto& channel : branch.uncertainty.equal_parameter.channels) channel.max = 160;
    ASSERT_FALSE(said().empty());
    EXPECT_NE(said()[0].find("the reference legs disagree on"), std::string::npos) << said()[0];
    const auto all = find_all(model, model.branches[0], -120);
    ASSERT_EQ(all.list.size(), 3u);
    auto& energy = branch.runs[static_cast<std::size_t>(Leg::energy)];
    energy.landmarks.back = all.list.back().state;
    ASSERT_EQ(said().size(), 1u);
    EXPECT_EQ(said()[0],
              fmt::format("the energy leg is on another equilibrium than the equilibrium leg at -120 N, each "
                          "proved: body 'a' is {:.3g} mm away",
                          1e3 * all.list.back().length));
    // What is no equilibrium is no other branch.
    energy.landmarks.back->poses[0].r.z() += 1e-4;
    EXPECT_NE(said()[0].find("the reference legs disagree on"), std::string::npos) << said()[0];
}

TEST(FindAll, ASlideOnItsHeadIsNoEquilibriumOfTheArch) {
    // The constraints of the slide hold there, too: they are counted.
    const auto all = all_of(arch("-200"), -120);
    EXPECT_GT(all.other_way_round, 0);
    for (const auto& one : all.list) EXPECT_LT(one.angle, 1e-6);
}

TEST(FindAll, ASuspensionHasTheOneOfItsBranch) {
    const Model model = compile(support::scene("mcpherson"));
    const auto all = find_all(model, model.branches.front(), 500, {.at_random = 4});
    ASSERT_FALSE(all.list.empty());
    EXPECT_TRUE(all.list[0].on_branch);
    EXPECT_TRUE(all.list[0].stable);
    EXPECT_EQ(all.list[0].proof.answer, Answer::proved) << all.list[0].proof.detail;
    for (const auto& one : all.list) EXPECT_EQ(one.on_branch, &one == &all.list[0]);
}

}  // namespace
}  // namespace elastocheck::compare
