// Outcomes: a correct result or a reported failure, never a wrong number.
#include <filesystem>
#include <limits>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/legs/legs.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::legs {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

struct Outcomes : LegTest {};               // of the legs that reach equilibria to rounding
struct OutcomesOfEveryMethod : LegTest {};  // of the references and every method of the recursion
ELASTOCHECK_FOR(accurate_legs, Outcomes);
ELASTOCHECK_FOR(legs_by_every_method, OutcomesOfEveryMethod);

SideModel to(SideModel side, double end) {
    side.branch.to = end;
    side.model.branches = {side.branch};
    return side;
}

// ---- Limit points.

// The von Mises truss of the scene with the height h [m]; its limit load [N] from ℓ³ = ℓ₀ b².
struct Arch {
    double h = 0.08, b = 0.3, k = 1e5;
    double l_0() const { return std::hypot(b, h); }
    double limit_length() const { return std::cbrt(l_0() * b * b); }
    double load(double z) const { return 2 * k * (1 - l_0() / std::hypot(b, z)) * z; }
    double limit() const { return load(std::sqrt(limit_length() * limit_length() - b * b)); }
    Scene scene() const {
        Scene s = support::scene("two_spring_arch");
        s.bodies[0].design.r.z() = h;
        for (auto& joint : s.joints) std::get<Translational>(joint.kind).j.s_local.z() = h;
        for (auto& spring : s.elastics) std::get<AxialSpring>(spring.kind).free_length = l_0();
        return s;
    }
};

TEST_P(Outcomes, ArchEndsAtItsLimitPointInAnyNumberOfSteps) {
    EXPECT_NEAR(Arch{}.limit(), -211.5166, 1e-4);
    for (const double h : {0.08, 0.005}) {
        const Arch arch{.h = h};
        const SideModel down = side_of(arch.scene());
        for (const double beyond : {1.0001, 1.2, 20.3, 1e4})
            for (const int steps : {1, 10, 57}) {
                const auto path = solve(leg(), to(down, beyond * arch.limit()), steps);
                const auto where = fmt::format("h {}, {} limit loads in {} steps: {}", h, beyond,
                                               steps, path.detail);
                // A limit and a bifurcation point are not distinguished on the flat arch by the
                // equilibrium leg, nor at 1e-4 of the branch by adaptive steps, whose shortest is
                // a share of the branch.
                const bool too_near = leg().kind == Leg::equilibrium
                                          ? h < 0.08
                                          : leg().method.name == "adaptive" && beyond == 1e4;
                EXPECT_TRUE(path.outcome == Outcome::limit_point ||
                            (too_near && path.outcome == Outcome::bifurcation_point))
                    << where << elastocheck::name(path.outcome);
                EXPECT_TRUE(contains(path.detail, "'down'")) << where;
                // The recursion also returns where it ended.
                if (leg().kind != Leg::recursive) {
                    EXPECT_EQ(path.points.size(), std::ceil(steps / beyond)) << where;
                }
                for (const auto& state : path.points) {
                    EXPECT_LE(std::abs(state.load), std::abs(arch.limit())) << where;
                    EXPECT_NEAR(arch.load(state.poses[0].r.z()), state.load, 1e-6) << where;
                }
            }
    }
}

TEST_P(Outcomes, ArchIsFollowedToAMillionthBeforeItsLimitLoad) {
    for (const double share : {0.9, 0.99, 0.9999, 0.999999}) {
        if (share > 0.9999 && leg().kind == Leg::recursive) continue;
        const auto path = solved(leg(), to(side_of(Arch{}.scene()), share * Arch{}.limit()), 1);
        const double z = path.points.back().poses[0].r.z();
        EXPECT_NEAR(Arch{}.load(z), path.points.back().load, 1e-8) << share;
        EXPECT_GT(std::hypot(0.3, z), Arch{}.limit_length()) << share;
    }
}

// A long soft spring pulls the apex down by 150 or 300 N before the branch starts.
TEST_P(Outcomes, PreloadBeyondTheLimitPointDoesNotSettle) {
    for (const double pull : {150.0, 300.0}) {
        Scene scene = Arch{}.scene();
        scene.elastics.push_back(
            {"pull", AxialSpring{{0}, {ground, -5 * Z}, LinearRate{100}, 5.08 - pull / 100}});
        const auto path = solve(leg(), to(side_of(scene), -1), 1);
        if (pull > 211.6) {
            EXPECT_NE(path.outcome, Outcome::converged);
            EXPECT_TRUE(path.points.empty());
            continue;
        }
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        const double z = path.points[0].poses[0].r.z();
        EXPECT_NEAR(Arch{}.load(z), -pull + 100 * (0.08 - z), 1e-8);
    }
}

// ---- Settling.

// A pendulum settles hanging down from every design position, also from above its hinge.
TEST_P(Outcomes, PendulumSettlesFromAnyDesignAngle) {
    if (leg().kind == Leg::recursive) GTEST_SKIP() << "the recursion starts where it is drawn";
    for (const double angle : {-1.4, -0.5, 0.0, 0.6, 1.5, 1.9}) {  // [rad] from straight down
        Scene s;
        const Vector3d c(std::sin(angle), 0, -std::cos(angle));
        s.bodies = {{"bob", {c}}};
        s.joints = {{"hinge", Revolute{{0, -c}, {ground}, {0, Y}, ground_y}}};
        s.static_loads = {{"weight", DeadForce{{0}, -10 * Z}}};
        s.branches = {load_branch(DeadForce{{0}, X}, 10)};
        s.probes = {{"bob", {0}}};
        for (const auto& state : solved(leg(), side_of(s), 2).points)
            EXPECT_LE((state.poses[0].r - Vector3d(state.load, 0, -10).normalized()).norm(), 1e-10)
                << angle;
    }
}

// Forward, back and to the other side, in one list.
TEST_P(Outcomes, PointsOfABranchMayBeRequestedInAnyOrder) {
    if (leg().kind == Leg::recursive) GTEST_SKIP() << "the recursion has no list of points";
    const SideModel side = side_of(support::scene("chrono_mcpherson"));
    const double loads[] = {0, 1000, 1000, 3000, 0, -3000, 500, 2000};
    const auto path = solve(leg(), side, loads);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (std::size_t k = 0; k < std::size(loads); ++k) {
        const auto direct = solve(leg(), side, std::span(loads).subspan(k, 1));
        ASSERT_EQ(direct.outcome, Outcome::converged) << direct.detail;
        EXPECT_LE(distance(path.points[k], direct.points[0], 2), 1e-10) << loads[k];
    }
}

// ---- Elements at the end of their law.

// θ = M / k ends at half a turn, where the rotation vector is undefined; Cardan angles end at a
// quarter turn. The branch ends there and never continues with the opposite angle.
TEST_P(Outcomes, BranchEndsWhereBushingAnglesAreUndefined) {
    const double k = 100;
    for (const auto& [angles, end] : {std::pair{Formulation::Angles::rotation_vector, M_PI},
                                      {Formulation::Angles::cardan, M_PI / 2}}) {
        Scene s = hinged_bar(0.3 * X, Y, k);
        bushing_of(s.elastics[0]).formulation.angles = angles;
        s.branches = {load_branch(DeadMoment{0, Y}, 400)};
        for (const int steps : {1, 8, 100}) {
            const auto path = solve(leg(), side_of(s), steps);
            EXPECT_NE(path.outcome, Outcome::converged) << path.detail;
            for (const auto& state : path.points) {
                EXPECT_LT(state.load, k * end);
                EXPECT_NEAR(state.poses[0].p.angularDistance(Quaterniond::Identity()),
                            state.load / k, 1e-8);
            }
            if (leg().kind == Leg::recursive) continue;
            EXPECT_EQ(path.outcome, Outcome::branch_lost) << path.detail;
            EXPECT_TRUE(contains(path.detail, leg().kind == Leg::energy ? "bushing" : "'torsion'"))
                << path.detail;
            EXPECT_EQ(path.points.size(),
                      1 + static_cast<std::size_t>(std::floor(k * end / (400. / steps))));
        }
    }
}

TEST_P(Outcomes, BushingRotatedByHalfATurnInTheDesignPositionIsRejected) {
    if (!leg().exact()) GTEST_SKIP() << "adaptive steps follow it from 1e-9 rad on";
    for (const double short_of : {0.0, 1e-15, 1e-9}) {
        Scene s = support::scene("pendulum");
        bushing_of(s.elastics[0]).j.A_local =
            Eigen::AngleAxisd(M_PI - short_of, Vector3d(0.6, 0, 0.8));
        const SideModel side = side_of(s);
        const auto path = solve(leg(), side, 1);
        EXPECT_NE(path.outcome, Outcome::converged) << path.detail;
        EXPECT_TRUE(path.points.empty());
    }
}

// A spring of no length has no direction; a branch through that point ends for any range.
TEST_P(OutcomesOfEveryMethod, SpringOfZeroLengthEndsTheBranch) {
    Scene s = support::scene("two_spring_arch");
    std::get<AxialSpring>(s.elastics[0].kind).j.s_local = 0.08 * Z;
    EXPECT_NE(solve(leg(), side_of(s), 40).outcome, Outcome::converged);
    const SideModel up = side_of(support::scene("tyre_on_road"));
    for (const double end : {0.6, 60., 1e6})
        EXPECT_NE(solve(leg(), to(up, end), 40).outcome, Outcome::converged) << end;
}

// ---- Idle modes.

TEST_P(OutcomesOfEveryMethod, LoadOnAnIdleModeIsReported) {
    Scene strut = support::scene("chrono_mcpherson");
    for (const double moment : {1., 1e-3}) {
        strut.branches = {load_branch(DeadMoment{2, {0.04 * moment, 0.07 * moment, -moment}}, 10)};
        const auto path = solve(leg(), side_of(strut), 2);
        EXPECT_EQ(path.outcome, Outcome::loaded_idle_mode) << path.detail;
        EXPECT_TRUE(leg().needs_energy() || contains(path.detail, "strut")) << path.detail;
        EXPECT_LE(path.points.size(), 1u);
    }
    // A moment about a free hinge, by a branch or from the start, and a free body.
    Scene free = hinged_bar(0.3 * X, Y, 0);
    free.elastics.clear();
    free.branches = {load_branch(DeadMoment{0, Y}, 10)};
    EXPECT_EQ(solve(leg(), side_of(free), 2).outcome, Outcome::loaded_idle_mode);
    free.joints.clear();
    EXPECT_EQ(solve(leg(), side_of(free), 2).outcome, Outcome::loaded_idle_mode);
    free = hinged_bar(0.3 * X, Y, 0);
    free.elastics.clear();
    free.static_loads = {{"couple", DeadMoment{0, 3 * Y}}};
    free.branches = {load_branch(DeadForce{{0, 0.3 * X}, X}, 1)};
    const auto path = solve(leg(), side_of(free), 1);
    EXPECT_EQ(path.outcome, Outcome::loaded_idle_mode) << path.detail;
    EXPECT_TRUE(path.points.empty());
}

// A bar on a cylindrical guide and a bushing without a rate about it: a preload about the guide,
// as drawn or driven, has no equilibrium; about another axis the guide carries it.
TEST_P(OutcomesOfEveryMethod, PreloadOnAnIdleModeIsReported) {
    Scene s = hinged_bar(X, X, 0);
    s.joints = {{"guide", Cylindrical{{0}, {ground}, {0, X}, ground_x}}};
    s.elastics = {{"k", bushing({0}, {ground}, Vector3d::Constant(1000), {0, 10, 10})}};
    s.branches = {load_branch(DeadForce{{0, X}, X}, 100)};
    const SideModel plain = side_of(s);
    bushing_of(s.elastics[0]).preload[3] = 5;
    EXPECT_EQ(solve(leg(), side_of(s), 10).outcome, Outcome::loaded_idle_mode);
    for (const int axis : {3, 4}) {
        SideModel side = plain;
        side.branch.drivers.push_back({Preload{0, Vector6::Unit(axis)}, 0, 0.01});
        side.model.branches = {side.branch};
        const auto path = solve(leg(), side, 10);
        EXPECT_EQ(path.outcome, axis == 3 ? Outcome::loaded_idle_mode : Outcome::converged)
            << path.detail;
    }
}

// The same bar on a spring, with its free spin.
TEST_P(OutcomesOfEveryMethod, UnloadedIdleModeDoesNotChangeTheResult) {
    Scene s = hinged_bar(X, X, 0);
    s.elastics = {{"spring", AxialSpring{{0}, {ground, X}, LinearRate{1000}, 1}}};
    s.branches = {load_branch(DeadForce{{0, X}, X}, 100)};
    s.joints = {{"guide", Cylindrical{{0}, {ground}, {0, X}, ground_x}}};
    const auto idle = solved(leg(), side_of(s), 10);
    s.joints = {{"guide", Translational{{0}, {ground}, {0, X}, ground_x}}};
    const auto held = solved(leg(), side_of(s), 10);
    EXPECT_LE(distance(idle.points.back(), held.points.back()), 1e-13);
    EXPECT_NEAR(held.points.back().poses[0].r.x(), 0.1, 1e-12);
    const SideModel strut = side_of(support::scene("chrono_mcpherson"));
    EXPECT_EQ(solve(leg(), strut, 300).outcome, Outcome::converged);
}

// ---- Redundant and inconsistent joints.

TEST_P(OutcomesOfEveryMethod, ConsistentRedundantJointsDoNotChangeTheResult) {
    Scene once = support::scene("pinned_bar"), twice = once;
    twice.joints.push_back(
        {"second hinge", Revolute{{0, 0.7 * Y}, {ground, 0.7 * Y}, {0, Y}, ground_y}});
    const auto a = solved(leg(), side_of(once), 100), b = solved(leg(), side_of(twice), 100);
    EXPECT_LE(distance(a.points.back(), b.points.back()), 1e-11);
    EXPECT_GT(b.points.back().poses[0].p.angularDistance(Quaterniond::Identity()), 1e-3);
}

// Every joint of the strut twice: reactions of minimum norm share the load equally.
TEST_P(Outcomes, DuplicatedJointsShareTheReactions) {
    const Scene plain = support::scene("chrono_mcpherson");
    Scene doubled = plain;
    for (const auto& joint : plain.joints)
        doubled.joints.push_back({joint.name + "_again", joint.kind});
    const auto one = solved(leg(), side_of(plain), 10),
               two = solved(leg(), side_of(compile(doubled, Detail::everything)), 10);
    const std::size_t n = plain.joints.size();
    for (std::size_t k = 0; k < one.points.size(); ++k) {
        EXPECT_LE(distance(one.points[k], two.points[k], 2), 1e-10);
        for (std::size_t j = 0; j < n; ++j) {
            const auto &whole = one.points[k].reactions[j], &half = two.points[k].reactions[j],
                       &other = two.points[k].reactions[n + j];
            EXPECT_LE((whole.force - half.force - other.force).norm(), 1e-6);
            EXPECT_LE((half.force - other.force).norm(), 1e-6);
        }
    }
}

// Two bars of different length between the same points, and a bar that cannot reach.
TEST_P(OutcomesOfEveryMethod, InconsistentJointsAreReported) {
    for (const double error : {0.1, 1e-3, 1e-6}) {
        Scene s = support::scene("parallel_springs");
        for (const double length : {0.3, 0.3 + error})
            s.joints.push_back(
                {"bar", Distance{{0, {0, 0.1, 0}}, {ground, {0, 0.4, 0.4}}, length}});
        s.joints.back().name = "second bar";
        s.static_loads.clear();
        std::get<AxialSpring>(s.elastics[0].kind).free_length = 0.4;
        const auto path = solve(leg(), side_of(compile(s, Detail::everything)), 1);
        EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << error << path.detail;
        EXPECT_TRUE(contains(path.detail, "bar") ||
                    contains(path.detail, "redundant joints are inconsistent"))
            << path.detail;
        EXPECT_TRUE(path.points.empty());
    }
    Scene far = support::scene("pinned_bar");
    far.joints.push_back({"far", Distance{{0, 0.5 * X}, {ground, 2 * Z}, 0.5}});
    const auto path = solve(leg(), side_of(far), 1);
    EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
    EXPECT_TRUE(path.points.empty());
}

// ---- Values that are not finite.

TEST_P(OutcomesOfEveryMethod, NonFiniteInputNeverConverges) {
    using Spoil = std::function<void(Scene&, double)>;
    const auto load_of = [](Scene& s) -> DeadForce& {
        return std::get<DeadForce>(std::get<Load>(s.branches[0].drivers[0].what).kind);
    };
    const Spoil places[] = {
        [&](Scene& s, double bad) { load_of(s).f[1] = bad; },
        [&](Scene& s, double bad) { load_of(s).at.s_local[0] = bad; },
        [](Scene& s, double bad) {
            s.branches[0].drivers.push_back({Load{"m", DeadMoment{1, {0, bad, 0}}}, 0, 1});
        },
        [](Scene& s, double bad) {
            s.static_loads.push_back({"f", DeadForce{{0}, {bad, 0, 0}}});
        },
        [](Scene& s, double bad) { s.bodies[1].design.r[2] = bad; },
        [](Scene& s, double bad) { s.bodies[1].design.p.x() = bad; },
        [](Scene& s, double bad) { rate_of(s.elastics[0]) = bad; },
        [](Scene& s, double bad) { std::get<AxialSpring>(s.elastics[0].kind).free_length = bad; },
        [](Scene& s, double bad) { stiffness_of(bushing_of(s.elastics[1]))(4, 4) = bad; },
        [](Scene& s, double bad) { bushing_of(s.elastics[1]).preload[4] = bad; },
        [](Scene& s, double bad) { std::get<Distance>(s.joints[2].kind).length = bad; },
        [](Scene& s, double bad) { s.branches[0].to = bad; }};
    for (const double bad : {nan, inf, -inf})
        for (std::size_t k = 0; k < std::size(places); ++k) {
            Scene s = support::scene("chrono_mcpherson");
            places[k](s, bad);
            const auto path = solve(leg(), side_of(s), 2);
            EXPECT_NE(path.outcome, Outcome::converged) << k << " = " << bad;
            EXPECT_FALSE(path.detail.empty()) << k;
            EXPECT_LE(path.points.size(), 1u) << k;
        }
}

// ---- Extremes.

// Every rate of the suspension in turn from nearly zero to rigid.
TEST_P(Outcomes, ExtremeRatesGiveAnEquilibriumOrAReportedFailure) {
    const Scene original = support::scene("chrono_mcpherson");
    for (std::size_t e = 0; e < original.elastics.size(); ++e)
        for (const double factor : {1e-9, 1e-6, 1e-3, 1e-2, 1e2, 1e5, 1e7, 1e9}) {
            Scene s = original;
            if (std::holds_alternative<AxialSpring>(s.elastics[e].kind))
                rate_of(s.elastics[e]) *= factor;
            else
                stiffness_of(bushing_of(s.elastics[e])) *= factor;
            const SideModel side = to(side_of(s), 1000);
            const auto path = solve(leg(), side, 3);
            const auto where =
                fmt::format("{} times {:.0e}: {}", s.elastics[e].name, factor, path.detail);
            EXPECT_EQ(path.outcome == Outcome::converged, path.points.size() == 4) << where;
            EXPECT_EQ(path.outcome == Outcome::converged, path.detail.empty()) << where;
            if (factor > 1e-3 && factor < 1e6) {
                EXPECT_EQ(path.outcome, Outcome::converged) << where;
            }
            if (!leg().exact()) continue;
            for (const auto& state : path.points) {  // rounding of a position times the rate
                const Residuals left = residuals(leg(), side, state);
                EXPECT_LE(std::fmax(left.force, left.moment),
                          leg().wider(1e-7 + 1e-14 * 1e7 * (1 + factor)))
                    << where;
            }
        }
}

// Two hinges whose axes meet at 1e-6 rad allow no motion and are not redundant.
TEST_P(Outcomes, HingesWithAxesAMillionthOfARadianApartConstrainTheBody) {
    const auto file =
        std::filesystem::path(ELASTOCHECK_SCENES).parent_path() / "extremes" / "two_hinges.yaml";
    const auto opened = [&](const char* skew) {  // [mm] in 1000
        return side_of(read_scene(file.string(),
                                  std::array{parse_setting(std::string("points.skew.x=") + skew)}));
    };
    const auto held = solve(leg(), to(opened("1e-3"), 200), 1);
    if (held.outcome == Outcome::converged) {
        EXPECT_LE(distance(held.points[1], held.points[0]), 1e-12);
    } else {
        EXPECT_NE(leg().kind, Leg::equilibrium) << held.detail;
        EXPECT_FALSE(held.detail.empty());
    }
    // A thousandth of the angle is below the resolution of the arithmetic.
    const auto beyond = solve(leg(), to(opened("1e-6"), 200), 1);
    EXPECT_NE(beyond.outcome, Outcome::converged);
    EXPECT_FALSE(beyond.detail.empty());
}

TEST_P(OutcomesOfEveryMethod, SceneWithoutUnknownsConverges) {
    if (leg().kind != Leg::recursive) {
        Model model;
        EXPECT_EQ(solved(leg(), {model, branch_of({}, 1)}, 1).points.size(), 2u);
        model.bodies = {{"stone", {}}};
        EXPECT_EQ(solved(leg(), {model, branch_of({}, 1)}, 1).points.size(), 2u);
    }
    // A block that is welded to ground stays where it is.
    Scene weld;
    const Vector3d at(1, 2, 3);
    weld.bodies = {{"block", {at}}};
    weld.joints = {{"weld", Fixed{{0}, {ground, at}, {0, X}, {0, Y}, ground_x, ground_y}}};
    weld.branches = {load_branch(DeadForce{{0, 0.1 * X}, Z}, 1000)};
    weld.probes = {{"block", {0}}};
    const SideModel side = side_of(compile(weld, Detail::everything));
    for (const auto& state : solved(leg(), side, 10).points)
        EXPECT_LE((state.poses[0].r - at).norm(), 1e-12);
}

// ---- Scenes that were answered wrongly, or declined though another leg was right.

SideModel found(const std::string& name) {
    return side_of(support::scene_of("legs/found/" + name));
}

// A rod between a block on springs and the ground, shortened from 102 mm on; the reader refuses it.
SideModel shortened_rod(double by) {
    Scene s;
    s.bodies = {{"block", {0.4 * X}}};
    s.joints = {{"rod", Distance{{0}, {ground, Vector3d(0.4, 0.02, 0.1)}, std::hypot(0.02, 0.1)}}};
    s.elastics = {{"k", bushing({ground, 0.4 * X}, {0}, {5e4, 5e4, 5e4}, {1, 1, 1})}};
    s.branches = {motion_branch(0, -by)};
    s.probes = {{"end", {0}}};
    return side_of(s);
}

// Φ of a length is also zero where the length is negative: on the mirrored side.
TEST_P(OutcomesOfEveryMethod, DrivenLengthThatVanishesEndsTheBranch) {
    for (const double by : {0.11, 0.15, 0.21, 0.5})
        for (const int steps : {1, 10, 20}) {
            const auto path = solve(leg(), shortened_rod(by), steps);
            EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << by << " " << path.detail;
            EXPECT_TRUE(contains(path.detail, "rod")) << path.detail;
            for (const auto& point : path.points)
                EXPECT_LT(std::abs(point.load), std::hypot(0.02, 0.1)) << by << " " << steps;
        }
    EXPECT_EQ(solve(leg(), shortened_rod(0.09), 60).outcome, Outcome::converged);
}

TEST_P(OutcomesOfEveryMethod, StateOfTheMirroredAssemblyHasAConstraintResidual) {
    const SideModel side = shortened_rod(0.15);
    Equilibrium mirrored = solve({Leg::equilibrium}, shortened_rod(0.05), 1).points.back();
    mirrored.load = -0.15;
    const Vector3d base(0.4, 0.02, 0.1), d = mirrored.poses[0].r - base;
    mirrored.poses[0].r = base + (0.15 - std::hypot(0.02, 0.1)) * d.normalized();
    EXPECT_GT(residuals(leg(), side, mirrored).length, 0.04);
}

// The force of a spring jumps where its length is zero: 500 N at the end.
TEST_P(Outcomes, SpringDrivenThroughZeroLengthPushesOnBothSides) {
    const SideModel side = found("spring-through-zero-length");
    for (const int steps : {1, 2, 7, 40}) {
        const auto path = solve(leg(), side, steps);
        for (const auto& point : path.points) {
            const double x = point.poses[0].r.x();
            EXPECT_NEAR(std::abs(point.reactions.back().force.x()), 1e4 * (0.1 - std::abs(x)), 2e-2)
                << steps << " at " << point.load;
            if (x < 0) {
                EXPECT_GT(point.reactions.back().force.x(), 0);
            }
        }
    }
}

}  // namespace
}  // namespace elastocheck::legs
