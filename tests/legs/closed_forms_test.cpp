// Scenes with a closed-form solution, at every point of every branch. The scene files
// contain the derivations.
#include "elastocheck/compile.hpp"
#include "tests/legs/legs.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::legs {
namespace {

struct ClosedForms : LegTest {
    // Every probe of the scene is at `expected(load)` within 1e-10 of the size of the scene.
    void expect(const Scene& scene, double size, int steps,
                const std::function<std::vector<Vector3d>(double)>& expected) const {
        const Model model = compile(scene);
        for (const auto& branch : model.branches)
            for (const auto& side : branch_sides(branch)) {
                Worst worst;
                for (const auto& state :
                     solved(leg(), {on_branch(model, side), side}, steps).points) {
                    const auto at = expected(state.load);
                    for (std::size_t p = 0; p < at.size(); ++p)
                        worst.add((position(state, model.probes[p].at) - at[p]).norm() / size,
                                  state.load);
                }
                EXPECT_TRUE(within(worst, 1e-10)) << branch.name;
            }
    }
    // The only body is turned from its drawn orientation by load · rate.
    void expect_turns(const Scene& scene, int steps, const Vector3d& rate,
                      double limit = 1e-10) const {
        const SideModel side = side_of(scene);
        Worst worst;
        for (const auto& state : solved(leg(), side, steps).points)
            worst.add(
                state.poses[0].p.angularDistance(
                    Quaterniond(Eigen::AngleAxisd(state.load * rate.norm(), rate.normalized())) *
                    scene.bodies[0].design.p),
                state.load);
        EXPECT_TRUE(within(worst, limit));
    }
};
ELASTOCHECK_FOR(accurate_legs, ClosedForms);

// The root of an increasing function.
template <class F>
double root(F f, double low, double high) {
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (f(middle) < 0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

// ---- The scenes of models/scenes.

TEST_P(ClosedForms, PinnedBarTurnsByTheArcTangentOfForceOverRate) {
    expect(support::scene("pinned_bar"), 0.5, 40, [](double F) -> std::vector<Vector3d> {
        const double k = 20e3, L = 0.5, theta = std::atan(F / (k * L));
        return {L * Vector3d(std::cos(theta), 0, std::sin(theta))};
    });
}

TEST_P(ClosedForms, SingleBushingMovesByForceOverStiffness) {
    expect(support::scene("single_bushing"), 0.012, 40, [](double F) -> std::vector<Vector3d> {
        return {Vector3d(0.1, 0.2, 0.3) + F * Vector3d(0.6 / 2e5, 0.48 / 3e5, 0.64 / 5e5)};
    });
}

// Static loads and preloads that are not in balance as drawn settle first.
TEST_P(ClosedForms, PlateOnParallelSpringsSettlesAndMovesByForceOverTheSumOfRates) {
    Scene scene = support::scene("parallel_springs");
    const auto plate = [](double more) {
        return [=](double F) { return std::vector{Vector3d(0, 0, 0.4 + (F + more) / 75e3)}; };
    };
    expect(scene, 0.4, 40, plate(0));
    std::get<DeadForce>(scene.static_loads.at(0).kind).f.z() = -900;
    expect(scene, 0.4, 40, plate(-300));
    scene.static_loads.clear();
    expect(scene, 0.4, 40, plate(600));
}

TEST_P(ClosedForms, ApexOfATwoSpringArchIsWhereTheSpringsBalanceTheLoad) {
    expect(support::scene("two_spring_arch"), 0.3, 40, [](double F) -> std::vector<Vector3d> {
        const double b = 0.3, h = 0.08, k = 1e5, l_0 = std::hypot(b, h);
        const double limit = std::sqrt(std::cbrt(l_0 * l_0 * b * b * b * b) - b * b);  // ℓ³ = ℓ₀ b²
        return {
            root([&](double z) { return 2 * k * (1 - l_0 / std::hypot(b, z)) * z - F; }, limit, 1) *
            Z};
    });
}

TEST_P(ClosedForms, BodyOnTwoBushingsIsAtTheRootOfItsMomentBalance) {
    expect(support::scene("bushing_pair"), 0.25, 40, [](double F) -> std::vector<Vector3d> {
        const double k = 2e5, k_R = 500, a = 0.15, e = 0.25;
        const double theta = root(
            [&](double t) {
                return 2 * k * a * a * std::sin(t) + 2 * k_R * t - F * e * std::cos(t);
            },
            -1.5, 1.5);
        return {Vector3d(e * std::cos(theta), 0, F / (2 * k) + e * std::sin(theta))};
    });
}

TEST_P(ClosedForms, PendulumOnATorsionSpringIsAtTheRootOfItsMomentBalance) {
    expect(support::scene("pendulum"), 0.4, 40, [](double F) -> std::vector<Vector3d> {
        const double k_R = 600, L = 0.4;
        const double theta =
            root([&](double t) { return k_R * t - F * L * std::cos(t); }, -1.5, 1.5);
        return {L * Vector3d(0.8 * std::cos(theta), 0.6 * std::cos(theta), std::sin(theta))};
    });
}

TEST_P(ClosedForms, SliderCrankFollowsItsTrigonometry) {
    expect(support::scene("slider_crank"), 0.21, 40, [](double a) -> std::vector<Vector3d> {
        const double r = 0.06, l = 0.15, height = r * std::sin(a);
        return {Vector3d(r * std::cos(a), 0, -height),
                (r * std::cos(a) + std::sqrt(l * l - height * height)) * X};
    });
}

TEST_P(ClosedForms, PinsOfAFourBarAreTheIntersectionsOfItsCircles) {
    expect(support::scene("four_bar"), 0.1, 40, [](double angle) -> std::vector<Vector3d> {
        const double b = std::hypot(0.1, 0.04), c = 0.08;
        const Vector3d B = 0.04 * Vector3d(std::sin(angle), 0, std::cos(angle)), f = 0.1 * X - B;
        const double d = f.norm(), u = (b * b - c * c + d * d) / (2 * d);
        return {B, B + u / d * f + std::sqrt(b * b - u * u) * Vector3d(-f.z(), 0, f.x()) / d};
    });
}

TEST_P(ClosedForms, ApexOfADrivenArchRisesByTheTravel) {
    expect(support::scene("arch_driven"), 0.3, 40,
           [](double travel) { return std::vector<Vector3d>{(0.08 + travel) * Z}; });
}

// A pendulum without any element, stabilised by its weight: tan θ = F / W. Its spin is idle.
TEST_P(ClosedForms, HangingPendulumIsStabilisedByItsWeight) {
    if (leg().kind == Leg::recursive) GTEST_SKIP() << "loads an idle mode as drawn";
    Scene s;
    s.bodies = {{"bob", {-0.5 * Z}}};
    s.joints = {{"pivot", Spherical{{0, 0.5 * Z}, {ground}}}};
    s.static_loads = {{"weight", DeadForce{{0}, -20 * Z}}};
    s.branches = {load_branch(DeadForce{{0}, {0.6, 0.8, 0}}, 40)};
    s.probes = {{"bob", {0}}};
    expect(s, 0.5, 40, [](double F) -> std::vector<Vector3d> {
        return {0.5 * Vector3d(0.6 * F, 0.8 * F, -20).normalized()};
    });
}

// ---- Moments and followers on a body in a ball joint with a rotational bushing.

Scene on_a_ball(const Vector3d& k_R, const Quaterniond& axes, bool swapped = false) {
    Scene s = hinged_bar(0.3 * X, X, 1);
    s.joints = {{"ball", Spherical{{0}, {ground}}}};
    Bushing b = bushing({0}, {ground}, Vector3d::Zero(), k_R);
    b.i.A_local = b.j.A_local = axes;
    if (swapped) std::swap(b.i, b.j);
    s.elastics = {{"bushing", b}};
    return s;
}

// k_R θ = M about a fixed axis: for equal rates about any axis up to nearly half a turn, with the frame on either body;
// for unequal rates about a principal axis.
TEST_P(ClosedForms, DeadMomentRotatesABushingByMomentOverRate) {
    Random random;
    for (int trial = 0; trial < 10; ++trial) {
        const Vector3d axis = random.unit();
        Scene s = on_a_ball(Vector3d::Constant(250), random.rotation(), trial % 2 == 1);
        s.branches = {load_branch(DeadMoment{0, axis}, 250 * 3.1)};
        expect_turns(s, 30, axis / 250);
    }
    const Vector3d k_R(300, 700, 1100);
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1., -1.}) {
            const Quaterniond axes = random.rotation();
            const Vector3d about = sign * (axes * Vector3d::Unit(axis));
            Scene s = on_a_ball(k_R, axes);
            s.branches = {load_branch(DeadMoment{0, about}, 0.5 * k_R[axis])};
            expect_turns(s, 20, about / k_R[axis]);
        }
}

// A dead moment on unequal rates turns a body by θ with J⁻ᵀ(-θ) K_R θ = Aᵀ m. The test chooses the
// rotation, computes the holding moment by differences of the energy, and solves for the rotation.
TEST_P(ClosedForms, DeadMomentGivesTheExactFiniteRotation) {
    Random random;
    const Vector3d K_R(300, 600, 900);
    const auto U = [&](const Quaterniond& p) {
        const Eigen::AngleAxisd turn(p);
        return 0.5 * turn.angle() * turn.angle() * turn.axis().dot(K_R.asDiagonal() * turn.axis());
    };
    for (int trial = 0; trial < 20; ++trial) {
        const Quaterniond p = random.rotation(1.2);
        Vector3d m;  // m·n = dU for a rotation about n: Richardson's extrapolation
        for (int i = 0; i < 3; ++i) {
            const auto slope = [&](double h) {
                const Quaterniond turn(Eigen::AngleAxisd(h, Vector3d::Unit(i)));
                return (U(turn * p) - U(turn.conjugate() * p)) / (2 * h);
            };
            m[i] = (64 * slope(0.01) - 20 * slope(0.02) + slope(0.04)) / 45;
        }
        Scene s = on_a_ball(K_R, Quaterniond::Identity());
        s.branches = {load_branch(DeadMoment{0, m}, 1)};
        const auto path = solved(leg(), side_of(s), 4);
        EXPECT_LE(path.points.back().poses[0].p.angularDistance(p), 1e-8);
    }
}

// A force that stays perpendicular to the bar turns it by θ = F L / k (a dead force: F L cos θ =
// k θ); a couple that turns with an isotropic bushing has a constant axis in the body and in ground.
TEST_P(ClosedForms, FollowerForceAndCoupleRotateByMomentOverRate) {
    if (leg().needs_energy()) GTEST_SKIP() << "a follower has no energy";
    const double k = 150, L = 0.4;
    Scene bar = hinged_bar(L * X, Y, k);
    bar.branches = {load_branch(FollowerForce{{0, L * X}, Z}, 1150)};  // to 3.07 rad
    for (const int steps : {1, 3, 30}) {
        expect_turns(bar, steps, -L / k * Y);
        for (const auto& state : solved(leg(), side_of(bar), steps).points) {
            const Quaterniond turned(Eigen::AngleAxisd(-state.load * L / k, Y));
            EXPECT_LE((state.reactions[0].force + state.load * (turned * Z)).norm(),
                      limit(1e-9 * 1150));
        }
    }
    Random random;
    for (int trial = 0; trial < 10; ++trial) {
        const Vector3d axis = random.unit();
        const Quaterniond drawn = random.rotation();
        Scene s = on_a_ball(Vector3d::Constant(250), Quaterniond::Identity());
        s.bodies[0].design.p = drawn;
        bushing_of(s.elastics[0]).i.A_local = drawn.conjugate();
        s.branches = {load_branch(FollowerMoment{0, drawn.conjugate() * axis}, 250 * 3)};
        expect_turns(s, 10, axis / 250);
    }
}

// Without rotational rates the rotation of a bushing is unlimited: with a soft pull of 10 N/m
// towards (2, 0, 0) and a lift F the tip at 0.3 (cos φ, 0, sin φ) balances -20 z + F x = 0.
TEST_P(ClosedForms, BushingWithoutRotationalRatesRotatesFreely) {
    Scene s = hinged_bar(0.3 * X, Y, 0);
    s.elastics = {
        {"pull", bushing({ground, 2 * X}, {0, 0.3 * X}, Vector3d::Constant(10), Vector3d::Zero())}};
    s.branches = {load_branch(DeadForce{{0, 0.3 * X}, Z}, 10)};
    for (const auto& state : solved(leg(), side_of(s), 10).points) {
        const Vector3d tip = position(state, s.probes[0].at);
        EXPECT_NEAR(-20 * tip.z() + state.load * tip.x(), 0, 1e-10);
    }
}

}  // namespace
}  // namespace elastocheck::legs
