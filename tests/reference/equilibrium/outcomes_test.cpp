// Outcomes of the equilibrium leg: every failure of a branch is reached and reported.
#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "tests/reference/equilibrium/scenes.hpp"

namespace elastocheck::reference::equilibrium::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// The points before a failure must be as accurate as others.
void expect_points_in_balance(const Model& model, const Branch& branch, const EquilibriumPath& path,
                              double limit = 1e-8) {
    if (path.points.empty()) return;
    Worst worst;
    for (const auto& state : path.points) {
        const auto r = residuals(model, branch, state);
        for (const double part : {r.length, r.direction, r.force, r.moment})
            worst.see(part, fmt::format("{}", state.load));
    }
    EXPECT_TRUE(within(worst, limit));
}

// ---- Nearly redundant joints

// Two hinges whose axes meet at 1e-6 rad allow no motion and are not redundant: the couple of the
// load about them, 200 N at 0.8 m, is carried through that angle. A thousandth of the angle is
// below the arithmetic's resolution, and reported.
TEST(EquilibriumOutcome, HingesWhoseAxesMeetAtAMillionthOfARadianHold) {
    const auto file =
        std::filesystem::path(ELASTOCHECK_SCENES).parent_path() / "extremes" / "two_hinges.yaml";
    const auto opened = [&](const char* skew) {  // [mm] in 1000
        const Model model = compile(read_scene(
            file.string(), std::array{parse_setting(std::string("points.skew.x=") + skew)}));
        const std::vector<double> loads = {0, 200};
        return solve(model, model.branches[0], loads);
    };
    const auto held = opened("1e-3");
    ASSERT_EQ(held.outcome, Outcome::converged) << held.detail;
    EXPECT_LE((held.points[1].poses[0].r - held.points[0].poses[0].r).norm(), 1e-12);
    EXPECT_LE(held.points[1].poses[0].p.angularDistance(held.points[0].poses[0].p), 1e-12);
    const auto beyond = opened("1e-6");
    EXPECT_EQ(beyond.outcome, Outcome::iteration_limit);
    EXPECT_NE(beyond.detail.find("so nearly repeat each other"), std::string::npos)
        << beyond.detail;
}

// ---- Soft motions beside stiff ones

// A bushing with an axis along (1, 2, 3), many decades softer than its other axes, is pulled along
// it: the displacement is load / rate. Where K in ground axes has lost the soft rate to rounding,
// the leg reports a failure.
TEST(EquilibriumOutcome, AMotionThirteenDecadesSofterIsNotIdle) {
    const Vector3d along = Vector3d(1, 2, 3).normalized();
    const auto pulled = [&](double stiff) {
        const Model model = compile(parse_scene(fmt::format(R"(
elastocheck: 1
name: soft
units: {{length: m, angle: rad, force: N}}
points: {{o: [0, 0, 0]}}
bodies: {{b: {{origin: o}}}}
bushings: {{k: {{bodies: [ground, b], at: o, frame: {{z: [1, 2, 3], x: [3, 0, -1]}}, rates: [{0}, {0}, 1e-4], rotational_rates: [50, 50, 50]}}}}
loads: {{f: {{on: b, at: o, force: [{1:.17g}, {2:.17g}, {3:.17g}]}}}}
branches: {{pull: {{load: f, to: 1e-6, steps: 10}}}}
probes: {{tip: {{on: b, at: o}}}}
)",
                                                            stiff, along.x(), along.y(), along.z()),
                                                "soft.yaml"));
        return solve(model, model.branches[0], every_load(model.branches[0]));
    };
    for (const double stiff : {1e2, 1e5, 1e7, 1e9, 1e10}) {
        const auto path = pulled(stiff);
        ASSERT_EQ(path.outcome, Outcome::converged) << stiff << ": " << path.detail;
        Worst worst;
        for (const auto& state : path.points)
            worst.see((state.poses[0].r - state.load / 1e-4 * along).norm(),
                      fmt::format("{}", state.load));
        EXPECT_TRUE(within(worst, 1e-11)) << stiff;
    }
    for (const double stiff : {1e12, 1e14}) {
        const auto path = pulled(stiff);
        EXPECT_EQ(path.outcome, Outcome::iteration_limit) << stiff << ": " << path.detail;
        EXPECT_NE(path.detail.find("so much softer"), std::string::npos) << path.detail;
    }
}

// ---- Settling

// A pendulum settles hanging down from every design position, also from above its hinge, where the
// homotopy with dead forces leads to the unstable upright equilibrium.
TEST(EquilibriumOutcome, APendulumSettlesWhereverItIsDrawn) {
    for (const double angle : {-1.4, -0.5, 0.0, 0.6, 1.5, 1.9}) {  // [rad] from straight down
        const Model model = compile(parse_scene(fmt::format(R"(
elastocheck: 1
name: pendulum
units: {{length: m, angle: rad, force: N}}
points: {{o: [0, 0, 0], c: [{:.17g}, 0, {:.17g}]}}
bodies: {{b: {{origin: c}}}}
joints: {{hinge: {{type: revolute, bodies: [b, ground], at: o, axis: y}}}}
static_loads: {{weight: {{on: b, at: c, force: [0, 0, -10]}}}}
loads: {{f: {{on: b, at: c, force: [1, 0, 0]}}}}
branches: {{push: {{load: f, to: 10, steps: 2}}}}
probes: {{tip: {{on: b, at: c}}}}
)",
                                                            std::sin(angle), -std::cos(angle)),
                                                "pendulum.yaml"));
        const auto path = solve(model, model.branches[0], every_load(model.branches[0]));
        ASSERT_EQ(path.outcome, Outcome::converged) << angle << ": " << path.detail;
        for (const auto& state : path.points)
            EXPECT_LE((state.poses[0].r - Vector3d(state.load, 0, -10).normalized()).norm(), 1e-10)
                << angle << ", " << state.load;
    }
}

// ---- Branches that end

constexpr double arch_limit = 211.5166;  // [N], see two_spring_arch.yaml

double arch_force(double z) {
    const double l = std::hypot(0.3, z), l_0 = std::hypot(0.3, 0.08);
    return 2 * 100e3 * (l - l_0) * z / l;
}

TEST(EquilibriumOutcome, ArchEndsAtItsLimitForAnySteps) {
    const Model model = compile(scene("two_spring_arch"));
    const auto& branch = model.branches[0];
    for (const int steps : {1, 2, 3, 5, 10, 50, 1000})
        for (const double to :
             {-212., -215., -250., -400., -2000., -20000., -3072. * 100e3 / 9e4}) {
            std::vector<double> loads;
            for (int n = 0; n <= steps; ++n) loads.push_back(to * n / steps);
            const auto path = solve(model, branch, loads);
            const auto where = fmt::format("to {} N in {} steps: {}", to, steps, path.detail);
            EXPECT_EQ(path.outcome, Outcome::limit_point) << where;
            EXPECT_NE(path.detail.find("'down'"), std::string::npos) << where;
            ASSERT_FALSE(path.points.empty()) << where;
            const std::size_t reachable = static_cast<std::size_t>(std::count_if(
                loads.begin(), loads.end(), [](double load) { return load > -arch_limit; }));
            EXPECT_EQ(path.points.size(), reachable) << where;
            for (const auto& state : path.points) {
                EXPECT_GT(state.poses[0].r[2], 0.0457) << where;  // √(ℓ² - b²) at ℓ³ = ℓ₀ b²
                EXPECT_NEAR(arch_force(state.poses[0].r[2]), state.load, 1e-8) << where;
            }
        }
}

TEST(EquilibriumOutcome, ArchIsFollowedToWithinAHairOfItsLimit) {
    const Model model = compile(scene("two_spring_arch"));
    const std::vector<double> loads = {-200, -211, -211.5, -211.516, -211.6};
    const auto path = solve(model, model.branches[0], loads);
    EXPECT_EQ(path.outcome, Outcome::limit_point) << path.detail;
    EXPECT_EQ(path.points.size(), 4u);
    expect_points_in_balance(model, model.branches[0], path);
}

// Forward, back, and to the other side, in one list.
TEST(EquilibriumOutcome, ABranchMayBeVisitedInAnyOrder) {
    const Model model = compile(scene("chrono_mcpherson"));
    const std::vector<double> loads = {0, 1000, 1000, 3000, 0, -3000, 500};
    const auto path = solve(model, model.branches[0], loads);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    ASSERT_EQ(path.points.size(), loads.size());
    Worst worst;
    for (const double load : loads) {
        const std::vector<double> alone = {load};
        const auto direct = solve(model, model.branches[0], alone);
        ASSERT_EQ(direct.outcome, Outcome::converged) << direct.detail;
        for (const auto& state : path.points)
            if (state.load == load)
                for (const std::size_t b : {0u, 1u}) {
                    worst.see((state.poses[b].r - direct.points[0].poses[b].r).norm(),
                              fmt::format("{} N", load));
                    worst.see(state.poses[b].p.angularDistance(direct.points[0].poses[b].p),
                              fmt::format("{} N", load));
                }
    }
    EXPECT_TRUE(within(worst, 1e-11));
}

// An upright bar on a torsion spring under its weight loses stability at P = k_R / L; the upright
// equilibrium exists beyond, but another curve crosses it there.
TEST(EquilibriumOutcome, BucklingIsADividingPoint) {
    Scene s = hinged_bar({0, 0, 0.5}, {0, 1, 0}, 100);
    s.branches = {pull({0, {0, 0, 0.5}}, {0, 0, -1})};
    const Model model = compile(s);
    std::vector<double> loads;
    for (int n = 0; n <= 30; ++n) loads.push_back(10.5 * n);
    const auto path = solve(model, model.branches[0], loads);
    EXPECT_EQ(path.outcome, Outcome::bifurcation_point) << path.detail;
    EXPECT_EQ(path.points.size(), 20u);  // 199.5 N is stable, 210 N is not
    expect_points_in_balance(model, model.branches[0], path);
}

// θ = M / k ends at half a turn, where the logarithm is undefined: the branch ends there too and
// never continues as -θ.
TEST(EquilibriumOutcome, ABushingAtHalfATurnEndsTheBranch) {
    Scene s = hinged_bar({0.3, 0, 0}, {0, 1, 0}, 100);
    s.branches = {twist(0, {0, 1, 0})};
    const Model model = compile(s);
    std::vector<double> loads;
    for (int n = 0; n <= 100; ++n) loads.push_back(4 * n);
    const auto path = solve(model, model.branches[0], loads);
    EXPECT_EQ(path.outcome, Outcome::branch_lost) << path.detail;
    EXPECT_NE(path.detail.find("'torsion'"), std::string::npos) << path.detail;
    ASSERT_EQ(path.points.size(), 79u);  // up to 312 N·m < 100 π
    for (const auto& state : path.points)
        EXPECT_NEAR(state.poses[0].p.angularDistance(Quaterniond::Identity()), state.load / 100,
                    1e-10);
}

// Without rotational rates the rotation of a bushing is unlimited: a bar whose tip is pulled
// through a full turn.
TEST(EquilibriumOutcome, ABushingWithoutRotationalRatesMayTurnFurther) {
    Scene s = hinged_bar({0.3, 0, 0}, {0, 1, 0}, 0);
    auto& bushing = std::get<Bushing>(s.elastics[0].kind);
    bushing.j.s_local = {2, 0, 0};  // a soft pull towards +x ...
    bushing.i.s_local = {0.3, 0, 0};
    stiffness_of(bushing).K.setZero();
    stiffness_of(bushing).K.topLeftCorner<3, 3>() = 10 * Matrix3d::Identity();
    std::swap(bushing.i, bushing.j);
    s.branches = {pull({0, {0.3, 0, 0}}, {0, 0, 1})};  // ... against which the tip is lifted
    const Model model = compile(s);
    std::vector<double> loads;
    for (int n = 0; n <= 10; ++n) loads.push_back(n);
    const auto path = solve(model, model.branches[0], loads);
    // tip at 0.3 (cos φ, 0, sin φ), pulled by 10 N/m towards (2, 0, 0): moment -10·2·0.3 sin
    // φ + 0.3 F cos φ = 0
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (const auto& state : path.points) {
        const Vector3d tip = position(state, {0, {0.3, 0, 0}});
        EXPECT_NEAR(-20 * tip[2] + state.load * tip[0], 0, 1e-10);
    }
}

// ---- Idle modes

TEST(EquilibriumOutcome, AnIdleStrutIsNoObstacle) {
    const Model model = compile(scene("chrono_mcpherson"));
    for (const auto& branch : model.branches) {
        const auto path = solve(model, branch, every_load(branch));
        EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    }
}

TEST(EquilibriumOutcome, ALoadedIdleStrutIsNamed) {
    Scene s = scene("chrono_mcpherson");
    for (const double moment : {1., 1e-3, 1e-6}) {
        s.branches[0].drivers = {driven_by({"spin", DeadMoment{2, {0, 0, moment}}})};
        const Model model = compile(s);
        const auto path = solve(model, model.branches[0], every_load(model.branches[0]));
        EXPECT_EQ(path.outcome, Outcome::loaded_idle_mode) << path.detail;
        EXPECT_NE(path.detail.find("'strut'"), std::string::npos) << path.detail;
        EXPECT_LE(path.points.size(), 1u);
    }
}

// A moment about a free hinge has no equilibrium anywhere (a weight would have one, hanging down).
TEST(EquilibriumOutcome, AStaticLoadOnAnIdleModeFailsBeforeTheFirstPoint) {
    Scene s = hinged_bar({0.3, 0, 0}, {0, 1, 0}, 0);
    s.elastics.clear();
    s.static_loads = {{"couple", DeadMoment{0, {0, 3, 0}}}};
    s.branches = {pull({0, {0.3, 0, 0}}, {1, 0, 0})};
    const Model model = compile(s);
    const std::vector<double> loads = {0, 1};
    const auto path = solve(model, model.branches[0], loads);
    EXPECT_EQ(path.outcome, Outcome::loaded_idle_mode) << path.detail;
    EXPECT_NE(path.detail.find("'bar'"), std::string::npos) << path.detail;
    EXPECT_TRUE(path.points.empty());
}

// ---- Redundant and inconsistent joints

TEST(EquilibriumOutcome, RedundantJointsThatAgreeAreSolved) {
    Scene s = scene("pinned_bar");
    Joint again = s.joints[0];
    again.name = "second pin";
    auto& revolute = std::get<Revolute>(again.kind);
    revolute.i.s_local += Vector3d(0, 0.1, 0);
    revolute.j.s_local += Vector3d(0, 0.1, 0);
    s.joints.push_back(again);
    const Model model = compile(s);
    for (const auto& branch : model.branches) {
        const auto path = solve(model, branch, every_load(branch));
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        for (const auto& state : path.points) {
            const double theta = std::atan(state.load / 10e3);
            EXPECT_NEAR((position(state, model.probes[0].at) -
                         0.5 * Vector3d(std::cos(theta), 0, std::sin(theta)))
                            .norm(),
                        0, 5e-11);
        }
        expect_points_in_balance(model, branch, path);
    }
}

Scene two_bars(double second_length) {
    Scene s = scene("parallel_springs");
    s.joints.push_back({"first bar", Distance{{0, {0, 0.1, 0}}, {ground, {0, 0.4, 0.4}}, 0.3}});
    s.joints.push_back(
        {"second bar", Distance{{0, {0, 0.1, 0}}, {ground, {0, 0.4, 0.4}}, second_length}});
    s.static_loads.clear();
    std::get<AxialSpring>(s.elastics[0].kind).free_length = 0.4;
    return s;
}

TEST(EquilibriumOutcome, BarsOfDifferentLengthBetweenTheSamePointsAreInconsistent) {
    for (const double error : {0.1, 1e-3, 1e-6}) {
        const Model model = compile(two_bars(0.3 + error));
        const std::vector<double> loads = {0, 1};
        const auto path = solve(model, model.branches[0], loads);
        EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
        EXPECT_NE(path.detail.find("'second bar'"), std::string::npos) << path.detail;
        EXPECT_TRUE(path.points.empty());
    }
}

// A bar of 1 m between a point on a circle of 0.5 m about the origin and an anchor at 3 m.
TEST(EquilibriumOutcome, ABarThatCannotReachIsInconsistent) {
    Scene s = hinged_bar({0.5, 0, 0}, {0, 1, 0}, 100);
    s.joints.push_back({"bar", Distance{{0, {0, 0, 0.5}}, {ground, {3, 0, 0}}, 1}});
    s.branches = {pull({0, {0.5, 0, 0}}, {0, 0, 1})};
    const Model model = compile(s);
    const std::vector<double> loads = {0, 1};
    const auto path = solve(model, model.branches[0], loads);
    EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
    EXPECT_TRUE(path.points.empty());
}

// A design pose that violates its joints is assembled first: one bar, 10 mm too short.
TEST(EquilibriumOutcome, ADesignPoseThatMissesItsJointsIsAssembled) {
    Scene s = hinged_bar({0.5, 0, 0}, {0, 1, 0}, 100);
    s.joints.push_back({"bar", Distance{{0, {0.5, 0, 0}}, {ground, {0.5, 0, 0.3}}, 0.29}});
    s.branches = {pull({0, {0.5, 0, 0}}, {0, 0, 1})};
    const Model model = compile(s);
    const std::vector<double> loads = {0, 100};
    const auto path = solve(model, model.branches[0], loads);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    EXPECT_NEAR((position(path.points[1], {0, {0.5, 0, 0}}) - Vector3d(0.5, 0, 0.3)).norm(), 0.29,
                1e-14);
    expect_points_in_balance(model, model.branches[0], path);
}

// ---- Values that are not finite, and iteration limits

TEST(EquilibriumOutcome, ANumberThatIsNotFiniteNeverConverges) {
    for (const double bad : {nan, infinity, -infinity}) {
        const std::vector<std::pair<const char*, std::function<void(Scene&)>>> places = {
            {"load direction",
             [&](Scene& s) {
                 std::get<DeadForce>(std::get<Load>(s.branches[0].drivers[0].what).kind).f[1] = bad;
             }},
            {"load moment",
             [&](Scene& s) {
                 s.branches[0].drivers.push_back(driven_by({"m", DeadMoment{1, {0, bad, 0}}}));
             }},
            {"static load",
             [&](Scene& s) {
                 s.static_loads.push_back({"f", DeadForce{{0, {0, 0, 0}}, {bad, 0, 0}}});
             }},
            {"load point",
             [&](Scene& s) {
                 std::get<DeadForce>(std::get<Load>(s.branches[0].drivers[0].what).kind)
                     .at.s_local[0] = bad;
             }},
            {"position", [&](Scene& s) { s.bodies[1].design.r[2] = bad; }},
            {"orientation", [&](Scene& s) { s.bodies[1].design.p.x() = bad; }},
            {"rate", [&](Scene& s) { rate_of(std::get<AxialSpring>(s.elastics[0].kind)).k = bad; }},
            {"free length",
             [&](Scene& s) { std::get<AxialSpring>(s.elastics[0].kind).free_length = bad; }},
            {"stiffness",
             [&](Scene& s) { stiffness_of(std::get<Bushing>(s.elastics[1].kind)).K(4, 4) = bad; }},
            {"preload", [&](Scene& s) { std::get<Bushing>(s.elastics[1].kind).preload[4] = bad; }},
            {"bar", [&](Scene& s) { std::get<Distance>(s.joints[2].kind).length = bad; }},
        };
        for (const auto& [place, spoil] : places) {
            Scene s = scene("chrono_mcpherson");
            spoil(s);
            const Model model = compile(s);
            const std::vector<double> loads = {0, 100, 200};
            const auto path = solve(model, model.branches[0], loads);
            EXPECT_EQ(path.outcome, Outcome::not_finite)
                << place << " = " << bad << ": " << path.detail;
            EXPECT_TRUE(path.points.empty()) << place;
            EXPECT_FALSE(path.detail.empty()) << place;
        }
        const Model model = compile(scene("chrono_mcpherson"));
        const std::vector<double> loads = {0, bad, 200};
        const auto path = solve(model, model.branches[0], loads);
        EXPECT_EQ(path.outcome, Outcome::not_finite) << path.detail;
    }
}

TEST(EquilibriumOutcome, ASpringOfNoLengthIsNotFinite) {
    Scene s = scene("two_spring_arch");
    std::get<AxialSpring>(s.elastics[0].kind).j.s_local = {0, 0, 0.08};
    const Model model = compile(s);
    const std::vector<double> loads = {0, 1};
    EXPECT_EQ(solve(model, model.branches[0], loads).outcome, Outcome::not_finite);
}

TEST(EquilibriumOutcome, TooFewIterationsAreReportedAsSuch) {
    Options options;
    options.iteration_limit = 1;
    options.halvings = 2;
    const Model model = compile(scene("chrono_mcpherson"));
    const std::vector<double> loads = {0, 500, 1000};
    const auto path = solve(model, model.branches[0], loads, options);
    EXPECT_EQ(path.outcome, Outcome::iteration_limit) << path.detail;
    expect_points_in_balance(model, model.branches[0], path);
}

TEST(EquilibriumOutcome, AToleranceBelowRoundOffIsNotMetQuietly) {
    Options options;
    options.tolerance = 1e-19;
    options.halvings = 3;
    const Model model = compile(scene("chrono_mcpherson"));
    const std::vector<double> loads = {0, 500, 1000};
    const auto path = solve(model, model.branches[0], loads, options);
    EXPECT_EQ(path.outcome, Outcome::iteration_limit) << path.detail;
}

// Every rate of the suspension in turn from nearly zero to rigid: converged and in balance, or a
// reported failure.
TEST(EquilibriumOutcome, ExtremeRatesGiveAnEquilibriumOrAnHonestOutcome) {
    const Scene original = scene("chrono_mcpherson");
    int converged = 0, compared = 0;
    for (std::size_t e = 0; e < original.elastics.size(); ++e)
        for (double factor = 1e-9; factor < 1e10; factor *= 10) {
            Scene s = original;
            if (auto* spring = std::get_if<AxialSpring>(&s.elastics[e].kind))
                rate_of(*spring).k *= factor;
            else
                stiffness_of(std::get<Bushing>(s.elastics[e].kind)).K *= factor;
            const Model model = compile(s);
            const std::vector<double> loads = {0, 300, 1000};
            const auto path = solve(model, model.branches[0], loads);
            const auto where = fmt::format("{} times {:.0e}: {} {}", s.elastics[e].name, factor,
                                           name(path.outcome), path.detail);
            // [N]: ε times the stiffest element's force per metre
            const double round_off = 1e-15 * std::max(1e6, 1e7 * factor);
            expect_points_in_balance(model, model.branches[0], path, 1e-8 + 10 * round_off);
            EXPECT_EQ(path.outcome == Outcome::converged, path.points.size() == loads.size())
                << where;
            EXPECT_EQ(path.detail.empty(), path.outcome == Outcome::converged) << where;
            converged += path.outcome == Outcome::converged;
            ++compared;
            if (factor > 1e-3 && factor < 1e6) {
                EXPECT_EQ(path.outcome, Outcome::converged) << where;
            }
        }
    ::testing::Test::RecordProperty("converged", fmt::format("{} of {}", converged, compared));
}

// The road moves the wheel up through the seat of its spring, where the spring has zero length and
// the branch ends, for any range.
TEST(EquilibriumOutcome, AStraightWayEndsWhereASpringLosesItsLength) {
    const Model all = compile(scene("tyre_on_road"));
    const Branch way = ways(all.branches[0]).back();
    const Model model = on_branch(all, way);
    for (const double to : {0.6, 60., 1e6}) {
        const std::vector<double> points = {0, to};
        const auto path = solve(model, way, points);
        EXPECT_NE(path.outcome, Outcome::converged) << to;
        EXPECT_EQ(path.points.size(), 1u) << path.detail;
    }
    const Branch down = ways(all.branches[0]).front();
    const std::vector<double> points = {0, -1e3};
    EXPECT_EQ(solve(on_branch(all, down), down, points).outcome, Outcome::converged);
}

TEST(EquilibriumOutcome, NothingToSolveIsSolved) {
    Model model;
    const Branch branch = branch_of("none", {}, 1, 1);
    const std::vector<double> loads = {0, 1};
    const auto path = solve(model, branch, loads);
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    EXPECT_EQ(path.points.size(), 2u);
    EXPECT_TRUE(solve(model, branch, {}).points.empty());
}

}  // namespace
}  // namespace elastocheck::reference::equilibrium::test
