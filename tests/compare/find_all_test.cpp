// Multiple equilibria at one load: closed-form cases are found, proved,
// distinguished and described.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/comparison/compare.hpp"
#include "compare/proofs/multiple_equilibria.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using reference::certificate::ProofState;

// Two springs meeting at a flat apex: V(z) = 2 · ½ k (ℓ(z) - ℓ₀)² - f z, ℓ² = w² + z².
constexpr double w = 0.3, h = 0.08, k = 100e3;

Model arch(double to) {
    return compile(support::scene_of("compare/scenes/arch", {setting("branches.d.to", to)}));
}

double force(double z) {
    const double length = std::hypot(w, z), drawn = std::hypot(w, h);
    return 2 * k * (length - drawn) * z / length;
}

// Equilibrium heights of the arch under the load, by bisection between its extremes.
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

AllEquilibria all_of(const Model& model, double a) {
    return find_equilibria(model, model.branches.front(), a);
}

TEST(FindAll, ArchBelowItsLimitHasTheThreeClosedFormEquilibriaProved) {
    for (const double load : {-120.0, -40.0, -200.0}) {
        const auto all = all_of(arch(-200), load);
        const auto expected = heights(load);
        ASSERT_EQ(expected.size(), 3u);
        ASSERT_EQ(all.list.size(), 3u) << load;
        EXPECT_TRUE(all.proved);
        EXPECT_EQ(all.stable(), 2);
        std::vector<double> found;
        for (const auto& one : all.list) {
            EXPECT_EQ(one.proof.state, ProofState::proved) << one.proof.detail;
            found.push_back(one.state.poses[0].r.z());
            // Stable where the force increases with the height.
            const double z = found.back(), e = 1e-6;
            EXPECT_EQ(one.stable, force(z + e) > force(z - e)) << z;
            EXPECT_EQ(one.stable, one.proof.stable) << z;
        }
        std::ranges::sort(found);
        for (int n = 0; n < 3; ++n)
            EXPECT_NEAR(found[static_cast<std::size_t>(n)], expected[static_cast<std::size_t>(n)],
                        1e-9);
        EXPECT_TRUE(all.list.front().on_branch);
        EXPECT_NEAR(all.list.front().state.poses[0].r.z(), expected[2], 1e-9);
        EXPECT_EQ(std::ranges::count(all.list, true, &FoundEquilibrium::on_branch), 1);
        EXPECT_EQ(all.list.back().body, "a");
        EXPECT_NEAR(all.list.back().length, expected[2] - expected[0], 1e-9);
        EXPECT_NE(all.list.back().meaning.find("snap over"), std::string::npos);
    }
}

// Near the limit point the unstable equilibrium is 0.7 mm from the stable one.
TEST(FindAll, StableAndUnstableEquilibriumNearTheLimitPointAreFound) {
    const auto all = all_of(arch(-200), -211.5);
    const auto expected = heights(-211.5);
    ASSERT_EQ(expected.size(), 3u);
    ASSERT_EQ(all.list.size(), 3u);
    EXPECT_TRUE(all.proved);
    std::vector<double> found;
    for (const auto& one : all.list) found.push_back(one.state.poses[0].r.z());
    std::ranges::sort(found);
    for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(found[n], expected[n], 1e-8);
}

// The arch snaps onto a stop that is so stiff that Newton's method with deflation
// does not converge.
TEST(FindAll, EquilibriumHeldByAStopIsFound) {
    const auto all = all_of(compile(support::scene_of("compare/scenes/arch_on_a_stop")), 2.528);
    EXPECT_TRUE(all.proved);
    const auto held = std::ranges::find_if(all.list, [](const FoundEquilibrium& one) {
        return std::abs(one.state.poses[0].r.z() + 0.0139) < 1e-4;
    });
    ASSERT_NE(held, all.list.end());
    EXPECT_TRUE(held->stable);
    EXPECT_EQ(std::ranges::count_if(all.list, [](const auto& one) { return !one.stable; }), 1);
}

TEST(FindAll, TooLargeModelIsNotSearched) {
    Model large = arch(-200);
    large.bodies.resize(101, large.bodies[0]);
    const auto all = find_equilibria(large, large.branches.front(), -120);
    EXPECT_EQ(all.outcome, Outcome::too_large);
    EXPECT_EQ(all.detail, "101 bodies, equilibria are searched for up to 100");
    EXPECT_FALSE(all.proved);
}

TEST(FindAll, OnlyEquilibriumBeyondTheLimitPointIsReportedAsOffTheBranch) {
    const auto all = all_of(arch(-1500), -1500);
    EXPECT_NE(all.outcome, Outcome::converged);
    ASSERT_EQ(all.list.size(), 1u);
    EXPECT_TRUE(all.proved);
    EXPECT_TRUE(all.list[0].stable);
    EXPECT_FALSE(all.list[0].on_branch);
    EXPECT_NEAR(all.list[0].state.poses[0].r.z(), heights(-1500)[0], 1e-9);
    EXPECT_NE(all.list[0].meaning.find("from the end of the branch"), std::string::npos);
}

// Flat arch with compressed springs: no branch starts, and distances are from the design position,
// not "0 mm away".
TEST(FindAll, DistancesAreFromTheDesignPositionIfNoBranchStarts) {
    std::string flat = support::scene_text("compare/scenes/arch");
    flat.replace(flat.find("[0, 0, 80]"), 10, "[0, 0, 0]");
    for (std::size_t at; (at = flat.find("rate: 100}")) != flat.npos;)
        flat.replace(at, 10, "rate: 100, free_length: 310}");
    const auto all = all_of(compile(parse_scene(flat, "scene.yaml")), 0);
    EXPECT_FALSE(all.has_start);
    ASSERT_EQ(all.list.size(), 3u);
    EXPECT_EQ(all.stable(), 2);
    for (const auto& one : all.list) {
        EXPECT_NEAR(one.length, one.stable ? std::sqrt(0.31 * 0.31 - 0.3 * 0.3) : 0, 1e-9);
        EXPECT_NE(one.meaning.find("from the design position, from which no branch begins"),
                  one.meaning.npos);
    }
}

// Vertical rod on a torsion spring: it buckles at 100 N.
TEST(FindAll, BuckledColumnHasABentEquilibriumOnEitherSide) {
    // k θ = f sin θ
    const double f = 120;
    double theta = 1;
    for (int n = 0; n < 200; ++n) theta = f / 100 * std::sin(theta);
    const Model model = compile(support::scene_of("compare/scenes/column"));
    const auto all = all_of(model, f);
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
    // These are rotated by 59 deg; a smaller limit leaves only the straight one.
    const auto upright = find_equilibria(model, model.branches.front(), f, {.max_rotation = 0.9});
    EXPECT_EQ(upright.list.size(), 1u);
    EXPECT_EQ(upright.with_overturned_body, 2);
}

TEST(FindAll, LegsAtDifferentEquilibriaAreReportedAsSuch) {
    const Model model = arch(-120);
    const auto comparison = compare(model);
    auto branch = comparison.branches[0];
    const auto said = [&] {
        return disagreements(model, comparison.channels, model.branches[0], branch).texts();
    };
    EXPECT_TRUE(said().empty());
    for (auto& channel : branch.uncertainty.equal_parameter.channels) channel.max = 160;
    ASSERT_FALSE(said().empty());
    EXPECT_NE(said()[0].find("the reference legs disagree on"), std::string::npos) << said()[0];
    const auto all = find_equilibria(model, model.branches[0], -120);
    ASSERT_EQ(all.list.size(), 3u);
    auto& energy = branch.run(Leg::energy);
    energy.landmarks.back = all.list.back().state;
    ASSERT_EQ(said().size(), 1u);
    EXPECT_EQ(
        said()[0],
        fmt::format(
            "the energy leg is on another equilibrium than the equilibrium leg at -120 N, each "
            "proved: body 'a' is {:.3g} mm away",
            1e3 * all.list.back().length));
    // A state that is no equilibrium is not another branch.
    energy.landmarks.back->poses[0].r.z() += 1e-4;
    EXPECT_NE(said()[0].find("the reference legs disagree on"), std::string::npos) << said()[0];
}

TEST(FindAll, SlideInTheOppositeDirectionIsNotAnEquilibrium) {
    // The constraints of the slide hold in the reversed assembly too: these states are counted.
    const auto all = all_of(arch(-200), -120);
    EXPECT_GT(all.with_reversed_joint, 0);
    for (const auto& one : all.list) EXPECT_LT(one.angle, 1e-6);
}

TEST(FindAll, SuspensionHasOnlyTheEquilibriumOfItsBranch) {
    const Model model = compile(support::scene("mcpherson"));
    const auto all = find_equilibria(model, model.branches.front(), 500, {.random_starts = 4});
    ASSERT_FALSE(all.list.empty());
    EXPECT_TRUE(all.list[0].on_branch);
    EXPECT_TRUE(all.list[0].stable);
    EXPECT_EQ(all.list[0].proof.state, ProofState::proved) << all.list[0].proof.detail;
    for (const auto& one : all.list) EXPECT_EQ(one.on_branch, &one == &all.list[0]);
}

}  // namespace
}  // namespace elastocheck::compare
