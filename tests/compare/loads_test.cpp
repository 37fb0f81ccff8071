// Loads at pickup points against closed forms, other outputs and the balance of the whole.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/loads/loads.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;
using Kind = CaseInput::Kind;

PickupLoads loads_of(const Scene& scene, const std::vector<LoadCase>& cases) {
    return pickup_loads(compile(with_cases(scene, cases), Detail::everything));
}

const Vector6& load(const PickupLoads& all, std::size_t c, const std::string& body,
                    const std::string& connection) {
    for (std::size_t k = 0; k < all.pickups.size(); ++k)
        if (all.pickups[k].body == body && all.pickups[k].connection == connection)
            return all.cases[c].loads[k].in_ground_axes;
    throw std::out_of_range(body + "." + connection);
}

// A carrier on six rigid links does not move under load, so that the forces of the links are the
// solution of six linear equations in the geometry as drawn:  Σ f_k n_k = -F,  Σ f_k p_k × n_k = -p × F.
TEST(Loads, ForcesOfSixLinksAreTheSolutionOfSixEquationsOfBalance) {
    const Scene scene = support::scene_of("compare/scenes/six_links");
    const LoadCase one{"kerb",
                       {{Kind::patch_force, 0, 2, 9000},
                        {Kind::patch_force, 0, 1, -2500},
                        {Kind::centre_force, 0, 0, 1200},
                        {Kind::wheel_moment, 0, 2, 30},
                        {Kind::acceleration, 0, 1, 0.8}}};
    const auto all = loads_of(scene, {one});
    ASSERT_FALSE(all.cases[0].loads.empty()) << all.cases[0].detail;

    const Vector3d a{0.1, 0.8, 0.2}, b{-0.1, 0.82, 0.22}, c{0.05, 0.85, -0.15}, patch{0, 0.9, -0.3},
        centre{0, 0.9, 0};
    const std::array<std::pair<Vector3d, Vector3d>, 6> links{{{a, {0.15, 0.4, 0.25}},
                                                              {a, {-0.2, 0.42, 0.2}},
                                                              {c, {0.2, 0.35, -0.18}},
                                                              {c, {-0.25, 0.38, -0.16}},
                                                              {b, {0.15, 0.4, -0.1}},
                                                              {b, {0.02, 0.7, 0.7}}}};
    Matrix6 M;
    for (int k = 0; k < 6; ++k) {
        const auto& [p, q] = links[static_cast<std::size_t>(k)];
        const Vector3d n = (q - p).normalized();
        M.col(k) << n, p.cross(n);
    }
    const double weight = 40 * 9.81;
    const Vector3d at_patch{0, -2500, 9000}, at_centre{1200, 0, 0}, at_b{0, -0.8 * weight, -weight};
    Vector6 applied;
    applied << at_patch + at_centre + at_b,
        patch.cross(at_patch) + centre.cross(at_centre) + b.cross(at_b) + Vector3d{0, 0, 30};
    const Vector6 f = M.lu().solve(-applied);
    for (int k = 0; k < 6; ++k) {
        const auto& [p, q] = links[static_cast<std::size_t>(k)];
        const Vector6& w = load(all, 0, "carrier", "l" + std::to_string(k + 1));
        EXPECT_LT((w.head<3>() - f[k] * (q - p).normalized()).norm(), 1e-7) << k;
        EXPECT_LT(w.tail<3>().norm(), 1e-7) << k;
        EXPECT_LT(
            (load(all, 0, "ground", "l" + std::to_string(k + 1)).head<3>() + w.head<3>()).norm(),
            1e-9);
    }
    EXPECT_LT(all.cases[0].imbalance, 1e-9);
    EXPECT_EQ(result_of(all).verdict.grade, Grade::pass);
}

// A bushing's force on its first body, in the axes of that body, is its output in its own frame.
TEST(Loads, BushingForceInBodyAxesIsTheElasticForceInItsFrame) {
    const Scene scene = support::scene_of("compare/scenes/bushed_arm");
    const Model model = compile(
        with_cases(scene,
                   {{"up", {{Kind::patch_force, 0, 2, 800}, {Kind::patch_force, 0, 1, -300}}}}),
        Detail::everything);
    const auto all = pickup_loads(model);
    ASSERT_FALSE(all.cases[0].loads.empty()) << all.cases[0].detail;
    const BranchSide side = sides_of(model, model.branches[0]).front();
    std::optional<Equilibrium> state;
    const double end = 1;
    solve_at(side, Leg::equilibrium, std::span(&end, 1), [&](const auto& s) { state = s; });
    const auto channels = element_channels(model);
    const auto values = evaluate(model, side.branch, channels, *state);
    int compared = 0;
    for (std::size_t k = 0; k < all.pickups.size(); ++k)
        for (const char* axis : {"x", "y", "z"}) {
            const auto& [body, connection, at] = all.pickups[k];
            const int c = find_channel(channels, connection + ".elastic_force_" + axis);
            if (body != "arm" || c < 0) continue;
            EXPECT_NEAR(all.cases[0].loads[k].in_body_axes[axis[0] - 'x'],
                        values[static_cast<std::size_t>(c)], 1e-7)
                << connection << axis;
            ++compared;
        }
    EXPECT_EQ(compared, 6);
    EXPECT_LT(all.cases[0].imbalance, 1e-9);
}

// Balance of all bodies as one: reactions of the ground are the opposite of wheel forces and weights.
TEST(Loads, GroundReactionsBalanceTheLoadsOfACaseOnAnAxle) {
    const Scene scene = trim(support::scene("front_axle")).scene;
    const std::size_t left = 0, right = 1;
    const auto all = loads_of(scene, {{"static", {}},
                                      {"corner",
                                       {{Kind::patch_force, left, 2, 6000},
                                        {Kind::patch_force, left, 1, -4000},
                                        {Kind::patch_force, right, 2, 2500},
                                        {Kind::patch_force, right, 1, -1500},
                                        {Kind::patch_force, left, 0, -800}}}});
    for (std::size_t c = 0; c < 2; ++c) {
        ASSERT_FALSE(all.cases[c].loads.empty()) << all.cases[c].detail;
        EXPECT_LT(all.cases[c].imbalance, 1e-9);
        EXPECT_LT(all.cases[c].disagreement, 1e-7);
        Vector3d borne = Vector3d::Zero(), applied = Vector3d::Zero();
        for (std::size_t k = 0; k < all.pickups.size(); ++k) {
            const Vector3d force = all.cases[c].loads[k].in_ground_axes.head<3>();
            if (all.pickups[k].body == "ground") borne += force;
            if (all.pickups[k].connection == "applied") applied += force;
        }
        EXPECT_LT((borne - applied).norm(), 1e-6);
        const Vector3d expected = c == 0 ? applied : Vector3d{-800, -5500, 8500};
        EXPECT_LT((applied - expected).norm(), 1e-9);
    }
}

TEST(Loads, JointsThatShareALoadIndeterminatelyAreNamedAndTheirSumIsGiven) {
    const Scene scene = support::scene_of("compare/scenes/two_hinges");
    const auto all = loads_of(scene, {{"pull", {{Kind::body_force, 0, 1, 500}}}});
    ASSERT_FALSE(all.cases[0].loads.empty()) << all.cases[0].detail;
    EXPECT_FALSE(std::isfinite(load(all, 0, "bar", "first")[1]));
    EXPECT_NEAR(load(all, 0, "bar", "first+second")[1] + load(all, 0, "bar", "k")[1], -500, 1e-6);
    const Result result = result_of(all);
    EXPECT_EQ(result.verdict.grade, Grade::pass) << result.verdict.sentence;
    ASSERT_FALSE(result.notes.empty());
    EXPECT_NE(result.notes.front().find("'first', 'second'"), std::string::npos);
}

}  // namespace
}  // namespace elastocheck::compare
