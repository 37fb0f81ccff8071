// Scenes with a closed-form solution. The scene files contain the formulas.
#include <fmt/format.h>

#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

// Solves every branch of a scene and checks every point by `expected`, which returns the deviation
// relative to the size of the scene.
void expect_closed_form(const std::string& file,
                        const std::function<double(const Model&, const Equilibrium&)>& deviation) {
    const Model model = compile(scene(file));
    Worst worst, balance;
    for (const auto& branch : model.branches) {
        const auto loads = every_load(branch);
        const auto path = solve(model, branch, loads);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        ASSERT_EQ(path.points.size(), loads.size());
        for (std::size_t n = 0; n < loads.size(); ++n) {
            EXPECT_EQ(path.points[n].load, loads[n]);
            const auto where = fmt::format("{}, load factor {}", branch.name, loads[n]);
            worst.see(deviation(model, path.points[n]), where);
            const auto r = residuals(model, branch, path.points[n]);
            balance.see(std::max({r.length, r.direction, r.force, r.moment}), where);
        }
    }
    EXPECT_TRUE(within(worst, 1e-10));
    EXPECT_TRUE(within(balance, 1e-9));
    ::testing::Test::RecordProperty("worst_deviation", fmt::format("{:.1e}", worst.value));
}

Vector3d probe(const Model& model, const Equilibrium& state, std::size_t n) {
    return position(state, model.probes[n].at);
}

TEST(EquilibriumClosedForm, PinnedBarTurnsByItsFormula) {
    expect_closed_form("pinned_bar", [](const Model& model, const Equilibrium& state) {
        const double L = 0.5, theta = std::atan(state.load / (20e3 * L));
        return (probe(model, state, 0) - L * Vector3d(std::cos(theta), 0, std::sin(theta))).norm() /
               L;
    });
}

TEST(EquilibriumClosedForm, SingleBushingMovesByItsCompliance) {
    expect_closed_form("single_bushing", [](const Model& model, const Equilibrium& state) {
        const Vector3d moved = probe(model, state, 0) - Vector3d(0.1, 0.2, 0.3);
        const Vector3d expected = state.load * Vector3d(0.6 / 2e5, 0.48 / 3e5, 0.64 / 5e5);
        return (moved - expected).norm() / 0.012;
    });
}

TEST(EquilibriumClosedForm, ParallelSpringsShareTheLoad) {
    expect_closed_form("parallel_springs", [](const Model& model, const Equilibrium& state) {
        return (probe(model, state, 0) - Vector3d(0, 0, 0.4 + state.load / 75e3)).norm() / 0.4;
    });
}

TEST(EquilibriumClosedForm, ArchStandsUnderItsLoad) {
    expect_closed_form("two_spring_arch", [](const Model& model, const Equilibrium& state) {
        const Vector3d apex = probe(model, state, 0);
        const double b = 0.3, h = 0.08, k = 100e3, l = std::hypot(b, apex[2]),
                     l_0 = std::hypot(b, h);
        const double F = 2 * k * (l - l_0) * apex[2] / l;
        return std::max(std::hypot(apex[0], apex[1]) / h, std::abs(F - state.load) / 2000);
    });
}

TEST(EquilibriumClosedForm, BushingPairKeepsTheMomentOfItsForces) {
    expect_closed_form("bushing_pair", [](const Model& model, const Equilibrium& state) {
        const double a = 0.15, e = 0.25, k = 2e5, k_R = 500;
        const Vector3d arm = probe(model, state, 0) - probe(model, state, 1);
        const double theta = std::atan2(arm[2], arm[0]);
        const double F =
            (2 * k * a * a * std::sin(theta) + 2 * k_R * theta) / (e * std::cos(theta));
        const Vector3d nose(e * std::cos(theta), 0, state.load / (2 * k) + e * std::sin(theta));
        return std::max((probe(model, state, 0) - nose).norm() / e,
                        std::abs(F - state.load) / 6000);
    });
}

TEST(EquilibriumClosedForm, PendulumTurnsInItsPlane) {
    expect_closed_form("pendulum", [](const Model& model, const Equilibrium& state) {
        const double L = 0.4, k_R = 600;
        const Vector3d tip = probe(model, state, 0);
        const double theta = std::asin(tip[2] / L);
        const Vector3d expected =
            L * Vector3d(0.8 * std::cos(theta), 0.6 * std::cos(theta), std::sin(theta));
        return std::max((tip - expected).norm() / L,
                        std::abs(k_R * theta / (L * std::cos(theta)) - state.load) / 3000);
    });
}

// k_R θ = M about a fixed axis, up to nearly half a turn, for a frame on either body.
TEST(EquilibriumClosedForm, DeadMomentTurnsAnIsotropicBushingByMOverK) {
    std::mt19937 random(11);
    Worst worst;
    for (int trial = 0; trial < 20; ++trial) {
        const Vector3d axis = random_vector(random, 1).normalized();
        const double k_R = 250;
        Scene s = hinged_bar({0.3, 0, 0}, axis, k_R);
        s.joints = {{"ball", Spherical{{0, {0, 0, 0}}, {ground, {0, 0, 0}}}}};
        auto& bushing = std::get<Bushing>(s.elastics[0].kind);
        bushing.i.A_local = bushing.j.A_local = random_turn(random);
        if (trial % 2 == 1) std::swap(bushing.i, bushing.j);
        s.branches = {twist(0, axis)};
        const Model model = compile(s);
        std::vector<double> loads;
        for (int n = 0; n <= 30; ++n) loads.push_back(k_R * 3.1 * n / 30);
        const auto path = solve(model, model.branches[0], loads);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& state : path.points)
            worst.see(state.poses[0].p.angularDistance(
                          Quaterniond(Eigen::AngleAxisd(state.load / k_R, axis))),
                      fmt::format("trial {}, {} N·m", trial, state.load));
    }
    EXPECT_TRUE(within(worst, 1e-10));
}

// About a principal axis of anisotropic rates, the same with that axis' rate, for a frame different
// from the ground's.
TEST(EquilibriumClosedForm, DeadMomentAboutAPrincipalAxisMeetsItsRateOnly) {
    std::mt19937 random(12);
    Worst worst;
    const Vector3d k_R(300, 700, 1100);
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1., -1.}) {
            Scene s = hinged_bar({0.3, 0, 0}, Vector3d::UnitX(), 1);
            s.joints = {{"ball", Spherical{{0, {0, 0, 0}}, {ground, {0, 0, 0}}}}};
            auto& bushing = std::get<Bushing>(s.elastics[0].kind);
            const Quaterniond axes = random_turn(random);
            bushing.i.A_local = bushing.j.A_local = axes;
            stiffness_of(bushing).K.bottomRightCorner<3, 3>() = k_R.asDiagonal();
            const Vector3d about = sign * (axes * Vector3d::Unit(axis));
            s.branches = {twist(0, about)};
            const Model model = compile(s);
            std::vector<double> loads;
            for (int n = 1; n <= 20; ++n) loads.push_back(k_R[axis] * 0.5 * n / 20);
            const auto path = solve(model, model.branches[0], loads);
            ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
            for (const auto& state : path.points)
                worst.see(state.poses[0].p.angularDistance(
                              Quaterniond(Eigen::AngleAxisd(state.load / k_R[axis], about))),
                          fmt::format("axis {}, {} N·m", axis, state.load));
        }
    EXPECT_TRUE(within(worst, 1e-10));
}

// A pendulum without any element, held by its weight: tan θ = F / W. Its spin is idle.
TEST(EquilibriumClosedForm, WeightAloneHoldsAHangingPendulum) {
    Scene s;
    s.bodies = {{"bob", {{0, 0, -0.5}, Quaterniond::Identity()}}};
    s.joints = {{"pivot", Spherical{{0, {0, 0, 0.5}}, {ground, {0, 0, 0}}}}};
    s.static_loads = {{"weight", DeadForce{{0, {0, 0, 0}}, {0, 0, -20}}}};
    s.branches = {pull({0, {0, 0, 0}}, {0.6, 0.8, 0})};
    s.probes = {{"bob", {0, {0, 0, 0}}}};
    const Model model = compile(s);
    std::vector<double> loads;
    for (int n = 0; n <= 40; ++n) loads.push_back(n);
    const auto path = solve(model, model.branches[0], loads);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    Worst worst;
    for (const auto& state : path.points) {
        const double theta = std::atan(state.load / 20);
        const Vector3d expected =
            0.5 * Vector3d(0.6 * std::sin(theta), 0.8 * std::sin(theta), -std::cos(theta));
        worst.see((state.poses[0].r - expected).norm() / 0.5, fmt::format("{} N", state.load));
    }
    EXPECT_TRUE(within(worst, 1e-10));
}

// Static loads and preloads that are not in balance at the design pose are settled first: the plate
// of parallel_springs with a weight of 900 N instead of 600 N sinks by 300 N / 75 N/mm.
TEST(EquilibriumClosedForm, UnbalancedStaticLoadSettlesBeforeTheBranchBegins) {
    Scene s = scene("parallel_springs");
    std::get<DeadForce>(s.static_loads.at(0).kind).f = {0, 0, -900};
    const Model model = compile(s);
    const auto& branch = model.branches[0];
    const auto loads = every_load(branch);
    const auto path = solve(model, branch, loads);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    Worst worst;
    for (const auto& state : path.points)
        worst.see(std::abs(probe(model, state, 0)[2] - (0.4 + (state.load - 300) / 75e3)),
                  fmt::format("{} N", state.load));
    EXPECT_TRUE(within(worst, 1e-12));
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
