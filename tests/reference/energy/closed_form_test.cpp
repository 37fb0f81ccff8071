// Scenes with a closed-form solution, at every point of every branch. The scene files contain the
// derivations.
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;

// The root of an increasing function.
template <class F>
double root(F f, double low, double high) {
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (f(middle) < 0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

// `displacements(load, state)` returns {computed, expected} displacements of a point; they must
// agree to 1e-8 of the largest displacement of the branch.
template <class F>
void expect_closed_form(const std::string& name, F displacements) {
    const Scene scene = scene_named(name);
    for (std::size_t b = 0; b < scene.branches.size(); ++b) {
        const Branch& branch = scene.branches[b];
        const auto loads = sweep(branch);
        const EquilibriumPath path = solve(scene, b, loads);
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        ASSERT_EQ(path.points.size(), loads.size());
        double worst = 0, travel = 0, worst_load = 0;
        for (const auto& state : path.points) {
            const auto [computed, expected] = displacements(scene, state);
            travel = std::max(travel, expected.norm());
            if (!((computed - expected).norm() <= worst)) {
                worst = (computed - expected).norm();
                worst_load = state.load;
            }
        }
        EXPECT_GT(travel, 1e-3);
        EXPECT_LE(worst, 1e-8 * travel) << name << " " << branch.name << " at " << worst_load;
        testing::Test::RecordProperty(branch.name,
                                      fmt::format("{:.1e} m of {:.3f} m", worst, travel));
    }
}

using Pair = std::pair<Vector3d, Vector3d>;

TEST(ClosedForm, PinnedBar) {
    expect_closed_form("pinned_bar", [](const Scene& scene, const Equilibrium& s) -> Pair {
        const double k = 20e3, L = 0.5, theta = std::atan(s.load / (k * L));
        return {position(s, scene.probes[0].at) - Vector3d(L, 0, 0),
                L * Vector3d(std::cos(theta) - 1, 0, std::sin(theta))};
    });
}

TEST(ClosedForm, SingleBushing) {
    expect_closed_form("single_bushing", [](const Scene& scene, const Equilibrium& s) -> Pair {
        return {position(s, scene.probes[0].at) - Vector3d(0.1, 0.2, 0.3),
                s.load * Vector3d(0.6 / 2e5, 0.48 / 3e5, 0.64 / 5e5)};
    });
}

TEST(ClosedForm, ParallelSprings) {
    expect_closed_form("parallel_springs", [](const Scene& scene, const Equilibrium& s) -> Pair {
        return {position(s, scene.probes[0].at) - Vector3d(0, 0, 0.4),
                s.load / 75e3 * Vector3d::UnitZ()};
    });
}

TEST(ClosedForm, TwoSpringArch) {
    expect_closed_form("two_spring_arch", [](const Scene& scene, const Equilibrium& s) -> Pair {
        const double b = 0.3, h = 0.08, k = 1e5, l_0 = std::hypot(b, h);
        const auto excess = [&](double z) {
            return 2 * k * (1 - l_0 / std::hypot(b, z)) * z - s.load;
        };
        const double limit = std::sqrt(std::cbrt(l_0 * l_0 * b * b * b * b) - b * b);  // ℓ³ = ℓ₀ b²
        return {position(s, scene.probes[0].at) - Vector3d(0, 0, h),
                (root(excess, limit, 1) - h) * Vector3d::UnitZ()};
    });
}

TEST(ClosedForm, BushingPair) {
    expect_closed_form("bushing_pair", [](const Scene& scene, const Equilibrium& s) -> Pair {
        const double k = 2e5, k_R = 500, a = 0.15, e = 0.25;
        const double theta = root(
            [&](double t) {
                return 2 * k * a * a * std::sin(t) + 2 * k_R * t - s.load * e * std::cos(t);
            },
            -1.5, 1.5);
        return {position(s, scene.probes[0].at) - Vector3d(e, 0, 0),
                Vector3d(e * (std::cos(theta) - 1), 0, s.load / (2 * k) + e * std::sin(theta))};
    });
}

TEST(ClosedForm, Pendulum) {
    expect_closed_form("pendulum", [](const Scene& scene, const Equilibrium& s) -> Pair {
        const double k_R = 600, L = 0.4;
        const double theta =
            root([&](double t) { return k_R * t - s.load * L * std::cos(t); }, -1.5, 1.5);
        return {
            position(s, scene.probes[0].at) - Vector3d(0.32, 0.24, 0),
            L * (std::cos(theta) * Vector3d(0.8, 0.6, 0) + std::sin(theta) * Vector3d::UnitZ()) -
                Vector3d(0.32, 0.24, 0)};
    });
}

// Without its weight the plate settles at the displacement caused by the first spring's preload.
TEST(ClosedForm, PreloadSettlesBeforeTheBranchStarts) {
    Scene scene = scene_named("parallel_springs");
    scene.static_loads.clear();
    const auto path = solve(scene, 0, sweep(scene.branches[0]));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (const auto& state : path.points)
        EXPECT_NEAR(position(state, scene.probes[0].at).z() - 0.4, (600 + state.load) / 75e3,
                    1e-13);
}

// A dead moment m has no potential for finite rotations, but re-centred charts find its
// equilibrium: a body held by a rotational bushing K_R on ground (frame on the body) rotates by θ
// with J⁻ᵀ(-θ) K_R θ = Aᵀ m. The test chooses the rotation, computes the holding moment by
// differences of the energy, and solves for the rotation.
TEST(ClosedForm, DeadMomentTurnsABodyByTheExactFiniteRotation) {
    Random random;
    const Vector3d K_R(300, 600, 900);
    const auto U = [&](const Eigen::Quaterniond& p) {
        const Eigen::AngleAxisd turn(p);
        const Vector3d theta = turn.angle() * turn.axis();
        return 0.5 * theta.dot(K_R.asDiagonal() * theta);
    };
    double worst = 0;
    for (int repeat = 0; repeat < 50; ++repeat) {
        const Eigen::Quaterniond p = random.rotation(1.2);
        Vector3d
            m;  // m·n = dU for a small rotation about n, Richardson's extrapolation of central differences
        for (int i = 0; i < 3; ++i) {
            const auto slope = [&](double h) {
                const Eigen::Quaterniond turn(Eigen::AngleAxisd(h, Vector3d::Unit(i)));
                return (U(turn * p) - U(turn.conjugate() * p)) / (2 * h);
            };
            m[i] = (64 * slope(0.01) - 20 * slope(0.02) + slope(0.04)) / 45;
        }
        Model model;
        model.name = "held";
        model.bodies = {{"body", {}}};
        Bushing bushing{Marker{ground}, Marker{0}, LinearStiffness{}, Vector6::Zero()};
        stiffness_of(bushing).diagonal() << 1e5, 1e5, 1e5, K_R;
        model.elastics = {{"bushing", bushing}};
        const Branch branch = load_branch("turn", {{"moment", DeadMoment{0, m}}}, 1, 4);
        const EquilibriumPath path = solve(model, branch, sweep(branch));
        ASSERT_EQ(path.outcome, Outcome::converged)
            << path.detail << " angle " << Eigen::AngleAxisd(p).angle();
        worst = std::max(worst, path.points.back().poses[0].p.angularDistance(p));
        EXPECT_GT(path.counts.iterations, 4);  // more than one chart per point
    }
    EXPECT_LE(worst, 1e-8);
}

TEST(ClosedForm, DeadMomentOnEqualRatesTurnsAboutItsOwnAxis) {
    Scene scene = scene_named("pendulum");
    const Vector3d axis(0.6, 0, 0.8);
    scene.branches = {// up to 3 rad at 600 N·m/rad
                      load_branch("turn", {{"moment", DeadMoment{0, axis}}}, 1800, 60)};
    const auto path = solve(scene, 0, sweep(scene.branches[0]));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (const auto& state : path.points) {
        const Eigen::Quaterniond expected(Eigen::AngleAxisd(state.load / 600, axis));
        EXPECT_LE(state.poses[0].p.angularDistance(expected), 1e-8) << state.load;
    }
}

}  // namespace
}  // namespace elastocheck::reference::energy
