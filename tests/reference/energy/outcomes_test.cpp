// Outcomes of the energy leg: a correct result or a reported failure, never a wrong number.
#include <numbers>

#include "models/lowering.hpp"
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

// The von Mises truss of the scene with height h [m]; its limit load [N] from ℓ³ = ℓ₀ b².
Scene arch(double h) {
    Scene scene = scene_named("two_spring_arch");
    scene.bodies[0].design.r.z() = h;
    for (auto& joint : scene.joints) std::get<Translational>(joint.kind).j.s_local.z() = h;
    for (auto& spring : scene.elastics)
        std::get<AxialSpring>(spring.kind).free_length = std::hypot(0.3, h);
    return scene;
}

double limit_load(double h) {
    const double b = 0.3, l_0 = std::hypot(b, h), l = std::cbrt(l_0 * b * b);
    return 2e5 * (l_0 - l) * std::sqrt(l * l - b * b) / l;
}

TEST(Outcomes, SnapThroughIsNeverJumpedOver) {
    EXPECT_NEAR(limit_load(0.08), 211.5166, 1e-4);
    for (const double h : {0.08, 0.04, 0.02, 0.01, 0.005}) {
        Scene scene = arch(h);
        for (const double beyond : {1.0001, 1.01, 1.2, 2.1, 5.3, 13.0, 20.3, 101.0, 1e4}) {
            const double to = -beyond * limit_load(h);
            scene.branches[0].to = to;
            for (const int steps : {1, 3, 10, 57}) {
                std::vector<double> loads;
                for (int i = 0; i <= steps; ++i) loads.push_back(to * i / steps);
                const EquilibriumPath path = solve(scene, 0, loads);
                const std::string what =
                    fmt::format("h {} to {} in {}: {}", h, to, steps, path.detail);
                EXPECT_EQ(path.outcome, Outcome::limit_point) << what;
                EXPECT_EQ(path.points.size(), std::ceil(steps / beyond)) << what;
                EXPECT_NE(path.detail.find("branch 'down'"), std::string::npos) << what;
            }
        }
    }
}

TEST(Outcomes, SolvesUpToTheLimitPoint) {
    for (const double share : {0.9, 0.99, 0.9999, 0.999999}) {
        const double loads[] = {-share * limit_load(0.08)};
        const EquilibriumPath path = solve(arch(0.08), 0, loads);
        ASSERT_EQ(path.outcome, Outcome::converged) << share << path.detail;
        const double z = path.points[0].poses[0].r.z(), l = std::hypot(0.3, z);
        EXPECT_NEAR(2e5 * (1 - std::hypot(0.3, 0.08) / l) * z, loads[0], 1e-8) << share;
        EXPECT_GT(l, std::cbrt(std::hypot(0.3, 0.08) * 0.09)) << share;
    }
}

// Only the weight resists a pendulum, so the homotopy with a growing weight starts without
// resistance, in every design position.
TEST(Outcomes, APendulumSettlesWhereverItIsDrawn) {
    // angle from straight down, in quarter turns
    for (const double drawn : {-0.9, -0.3, 0.0, 0.4, 1.2}) {
        const double angle = drawn * std::numbers::pi / 2;
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
        const EquilibriumPath path = solve(model, model.branches[0], sweep(model.branches[0]));
        ASSERT_EQ(path.outcome, Outcome::converged) << drawn << ": " << path.detail;
        for (const auto& state : path.points) {
            const Vector3d expected = Vector3d(state.load, 0, -10).normalized();
            EXPECT_LE((state.poses[0].r - expected).norm(), 1e-10) << drawn << ", " << state.load;
        }
    }
}

// Column on a ball joint and one bushing, loaded beyond its buckling load: the lever of 1e-7 m
// alone determines the direction of buckling and the stiffness across it.
TEST(Outcomes, WhatIsSoftIsAsNearAsWhatIsStiff) {
    const Model model = compile(parse_scene(R"(
elastocheck: 1
name: column
units: {length: m, angle: rad, force: N}
points: {c: [0, 0, 0.25], o: [0, 0, 0], top: [1e-7, 0, 0.5]}
bodies: {b: {origin: c}}
joints: {ball: {type: spherical, bodies: [b, ground], at: o}}
bushings: {k: {bodies: [b, ground], at: o, rates: [0, 0, 0], rotational_rates: [1000, 1000, 1000]}}
loads: {f: {on: b, at: top, force: [0, 0, -1]}}
branches: {push: {load: f, to: 6100, steps: 20}}
probes: {tip: {on: b, at: c}}
)",
                                            "column.yaml"));
    const EquilibriumPath path = solve(model, model.branches[0], sweep(model.branches[0]));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (const auto& state : path.points)
        EXPECT_LE(std::abs(state.poses[0].r.y()), 1e-9) << state.load;
}

// The same when it is not a load but a preload that pushes: a long soft spring pulls the apex down
// by 150 or by 300 N before the branch starts.
TEST(Outcomes, PreloadBeyondTheLimitPointIsNotSettled) {
    for (const double pull : {150.0, 300.0}) {
        Scene scene = arch(0.08);
        scene.elastics.push_back(
            {"pull",
             AxialSpring{
                 {0, Vector3d::Zero()}, {ground, {0, 0, -5}}, LinearRate{100}, 5.08 - pull / 100}});
        const double loads[] = {0};
        const auto path = solve(scene, 0, loads);
        if (pull > limit_load(0.08)) {
            EXPECT_EQ(path.outcome, Outcome::limit_point) << path.detail;
            EXPECT_TRUE(path.points.empty());
        } else {
            ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
            const double z = path.points[0].poses[0].r.z();
            EXPECT_NEAR(2e5 * (1 - std::hypot(0.3, 0.08) / std::hypot(0.3, z)) * z,
                        -pull + 100 * (0.08 - z), 1e-8);
        }
    }
}

// A column of one spring and a lateral one: straight up to P = k L, where the straight position
// ceases to be a minimum.
TEST(Outcomes, BucklingIsNotPassedOver) {
    Model model;
    model.name = "column";
    model.bodies = {{"rod", {}}};
    model.joints = {{"foot", 0, ground, {0, {0, 0, 0}}}};
    const Revolute foot{
        Point{0}, Point{ground}, {0, Vector3d::UnitY()}, {ground, Vector3d::UnitY()}};
    for (const auto& kind : lower(foot, model.bodies)) model.constraints.push_back({0, kind});
    Bushing side;
    side.i = {0, {0, 0, 0.5}};
    side.j = {ground, {0, 0, 0.5}};
    stiffness_of(side)(0, 0) = 2e4;
    stiffness_of(side)(2, 2) = 1e3;
    model.elastics = {{"side", side}};
    const Branch branch =
        load_branch("press", {{"down", DeadForce{{0, {0, 0, 0.5}}, {0, 0, -1}}}}, 2e4, 40);
    const auto path = solve(model, branch, sweep(branch));
    EXPECT_EQ(path.outcome, Outcome::bifurcation_point) << path.detail;
    EXPECT_NE(path.detail.find("stops being a minimum"), std::string::npos) << path.detail;
    // Upright, the frame rotates with the rod: lateral rate k at height L, so P_crit = k L (load
    // [N]).
    ASSERT_FALSE(path.points.empty());
    EXPECT_LE(path.points.back().load, 2e4 * 0.5);
    EXPECT_GE(path.points.back().load, 2e4 * 0.5 - 500 - 1);
}

TEST(Outcomes, LoadsThatAreNoNumbersNeverConverge) {
    for (const char* name : {"pinned_bar", "chrono_mcpherson"}) {
        const Scene scene = scene_named(name);
        for (const double bad : {nan, inf, -inf}) {
            const double loads[] = {0, 10, bad, 20};
            const auto path = solve(scene, 0, loads);
            EXPECT_EQ(path.outcome, Outcome::not_finite) << name;
            EXPECT_EQ(path.points.size(), 2u) << name;
            EXPECT_FALSE(path.detail.empty());
        }
    }
}

TEST(Outcomes, ModelsThatAreNoNumbersNeverConverge) {
    const Model good = compile(scene_named("chrono_mcpherson"));
    const double loads[] = {0, 10};
    const auto expect_not_finite = [&](const char* what, Model model) {
        const auto path = solve(model, model.branches[0], loads);
        EXPECT_NE(path.outcome, Outcome::converged) << what;
        EXPECT_TRUE(path.points.empty()) << what;
    };
    for (const double bad : {nan, inf}) {
        Model model = good;
        std::get<AxialSpring>(model.elastics[0].kind).law = LinearRate{bad};
        expect_not_finite("rate", model);
        model = good;
        std::get<AxialSpring>(model.elastics[0].kind).free_length = bad;
        expect_not_finite("free length", model);
        model = good;
        stiffness_of(std::get<Bushing>(model.elastics[1].kind))(1, 1) = bad;
        expect_not_finite("stiffness", model);
        model = good;
        std::get<Bushing>(model.elastics[1].kind).preload[2] = bad;
        expect_not_finite("preload", model);
        model = good;
        model.bodies[1].design.r.x() = bad;
        expect_not_finite("pose", model);
        model = good;
        model.static_loads = {{"bad", DeadForce{{1, Vector3d::Zero()}, Vector3d(0, bad, 0)}}};
        expect_not_finite("static load", model);
        model = good;
        std::get<DeadForce>(std::get<Load>(model.branches[0].drivers[0].what).kind).f.z() = bad;
        const auto path = solve(model, model.branches[0], loads);
        EXPECT_NE(path.outcome, Outcome::converged) << "branch load";
    }
}

TEST(Outcomes, LoadedIdleModesAreNamedAsSuch) {
    // A load on the strut's idle spin.
    Scene scene = scene_named("chrono_mcpherson");
    const auto strut = static_cast<BodyId>(2);
    scene.branches[0] =
        load_branch("spin", {{"spin", DeadMoment{strut, Vector3d(0.04, 0.07, -0.33)}}}, 10, 1);
    const double loads[] = {0, 1, 10};
    auto path = solve(scene, 0, loads);
    EXPECT_EQ(path.outcome, Outcome::loaded_idle_mode) << path.detail;
    EXPECT_EQ(path.points.size(), 1u);

    // A free body, loaded by a branch or by a static load.
    Model free;
    free.bodies = {{"stone", {}}};
    const std::vector<Load> push{{"push", DeadForce{{0, Vector3d(0.1, 0, 0)}, Vector3d::UnitX()}}};
    const Branch throws = load_branch("throw", push, 10, 1);
    path = solve(free, throws, loads);
    EXPECT_EQ(path.outcome, Outcome::loaded_idle_mode) << path.detail;
    EXPECT_EQ(path.points.size(), 1u);
    free.static_loads = push;
    path = solve(free, throws, loads);
    EXPECT_EQ(path.outcome, Outcome::loaded_idle_mode) << path.detail;
    EXPECT_TRUE(path.points.empty());
}

TEST(Outcomes, ContradictingJointsAreNamed) {
    Scene scene = scene_named("chrono_mcpherson");
    // A second tie rod beside the first, 5 mm too short; and one beyond reach.
    auto rod = std::get<Distance>(scene.joints[2].kind);
    rod.length -= 0.005;
    scene.joints.push_back({"second_rod", rod});
    const double loads[] = {0, 10};
    auto path = solve(scene, 0, loads);
    EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
    EXPECT_TRUE(path.points.empty());
    EXPECT_NE(path.detail.find("rod"), std::string::npos) << path.detail;

    scene = scene_named("pinned_bar");
    scene.joints.push_back({"far", Distance{{0, {0.5, 0, 0}}, {ground, {0, 0, 2}}, 0.5}});
    path = solve(scene, 0, loads);
    EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
    EXPECT_TRUE(path.points.empty());
}

TEST(Outcomes, ConsistentRedundantJointsChangeNothing) {
    const Scene plain = scene_named("chrono_mcpherson");
    Scene doubled = plain;
    for (const auto& joint : plain.joints)
        doubled.joints.push_back({joint.name + "_again", joint.kind});
    const auto loads = sweep(plain.branches[0], 30);
    const Model whole = compile(doubled, Detail::everything);  // pruning would remove the duplicate
    const Branch& walked = whole.branches[0];
    const auto one = solve(plain, 0, loads), two = solve(on_branch(whole, walked), walked, loads);
    ASSERT_EQ(one.outcome, Outcome::converged) << one.detail;
    ASSERT_EQ(two.outcome, Outcome::converged) << two.detail;
    double worst = 0, worst_force = 0;
    for (std::size_t k = 0; k < loads.size(); ++k) {
        for (std::size_t b = 0; b < 2; ++b) {
            worst = std::max(worst, (one.points[k].poses[b].r - two.points[k].poses[b].r).norm());
            worst =
                std::max(worst, one.points[k].poses[b].p.angularDistance(two.points[k].poses[b].p));
        }
        // Minimum-norm multipliers share the load equally.
        const std::size_t n = plain.joints.size();
        for (std::size_t j = 0; j < n; ++j) {
            worst_force = std::max(
                worst_force,
                (one.points[k].reactions[j].force - 2 * two.points[k].reactions[j].force).norm());
            worst_force = std::max(
                worst_force,
                (two.points[k].reactions[n + j].force - two.points[k].reactions[j].force).norm());
        }
    }
    EXPECT_LE(worst, 1e-10);
    EXPECT_LE(worst_force, 1e-6);
}

// A door on two hinges of one axis: 10 rows, 5 of them independent, with the door's rotation on a
// spring.
TEST(Outcomes, TwoHingesOfOneDoorAreConsistent) {
    Scene scene = scene_named("pinned_bar");
    scene.joints.push_back({"second_hinge", Revolute{{0, {0, 0.7, 0}},
                                                     {ground, {0, 0.7, 0}},
                                                     {0, Vector3d::UnitY()},
                                                     {ground, Vector3d::UnitY()}}});
    const auto path = solve(scene, 0, sweep(scene.branches[0]));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    const auto& last = path.points.back();
    EXPECT_NEAR(position(last, scene.probes[0].at).z(), 0.5 * std::sin(std::atan(0.5)), 1e-12);
}

TEST(Outcomes, FullyConstrainedBodiesStayWhereTheyAre) {
    Model model;
    model.bodies = {{"block", {Vector3d(1, 2, 3), Eigen::Quaterniond::Identity()}}};
    model.joints = {{"weld", 0, ground, {0, Vector3d::Zero()}}};
    const Fixed weld{{0, Vector3d::Zero()},       {ground, Vector3d(1, 2, 3)},
                     {0, Vector3d::UnitX()},      {0, Vector3d::UnitY()},
                     {ground, Vector3d::UnitX()}, {ground, Vector3d::UnitY()}};
    for (const auto& kind : lower(weld, model.bodies)) model.constraints.push_back({0, kind});
    const Branch branch = load_branch(
        "push", {{"push", DeadForce{{0, Vector3d(0.1, 0, 0)}, Vector3d::UnitZ()}}}, 1000, 10);
    const auto path = solve(model, branch, sweep(branch));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (const auto& state : path.points)
        EXPECT_LE((state.poses[0].r - Vector3d(1, 2, 3)).norm(), 1e-12);
}

TEST(Outcomes, NothingToSolveIsSolved) {
    const Branch branch = load_branch("idle", {}, 1, 1);
    const double loads[] = {0, 1};
    EXPECT_EQ(solve(Model{}, branch, loads).points.size(), 2u);
    Model free;
    free.bodies = {{"stone", {}}};
    const auto path = solve(free, branch, loads);
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    EXPECT_EQ(path.points.size(), 2u);
    EXPECT_TRUE(solve(free, branch, {}).points.empty());
}

// A rotational bushing can carry a moment up to K_R π; beyond there is no equilibrium.
TEST(Outcomes, HalfATurnOfABushingEndsTheBranch) {
    Scene scene = scene_named("pendulum");
    scene.branches = {
        load_branch("turn", {{"moment", DeadMoment{0, Vector3d(0.6, 0, 0.8)}}}, 2400, 8)};
    for (const int steps : {1, 8, 100}) {
        const auto path = solve(scene, 0, sweep(scene.branches[0], steps));
        EXPECT_EQ(path.outcome, Outcome::branch_lost) << path.detail;
        EXPECT_NE(path.detail.find("half a turn"), std::string::npos) << path.detail;
        for (const auto& state : path.points) EXPECT_LE(state.load, 600 * 3.1416);
    }
}

TEST(Outcomes, BushingMountedHalfATurnRoundIsDeclined) {
    Scene scene = scene_named("pendulum");
    auto& bushing = std::get<Bushing>(scene.elastics[0].kind);
    for (const double short_of : {0.0, 1e-15, 1e-9, 1e-4}) {
        bushing.j.A_local = Eigen::AngleAxisd(std::numbers::pi - short_of, Vector3d(0.6, 0, 0.8));
        const double loads[] = {0, 1};
        const Model model = compile(scene);
        const auto path = solve(model, model.branches[0], loads);
        EXPECT_EQ(path.outcome, Outcome::branch_lost) << path.detail;
        EXPECT_TRUE(path.points.empty());
        const Equilibrium design{0, {model.bodies[0].design}, {}, 0};
        EXPECT_TRUE(std::isnan(residuals(model, model.branches[0], design).moment)) << short_of;
    }
}

TEST(Outcomes, TooFewEvaluationsAreReported) {
    const Model model = compile(scene_named("chrono_mcpherson"));
    Options options;
    options.evaluation_limit = 1;
    options.recentre_limit = 1;
    options.tolerance = 1e-17;
    const double loads[] = {0, 1000};
    const auto path = solve(model, model.branches[0], loads, options);
    EXPECT_EQ(path.outcome, Outcome::iteration_limit) << path.detail;
    EXPECT_LT(path.points.size(), 2u);
}

// Rates from almost zero to almost rigid: solved, or a reported failure.
TEST(Outcomes, ExtremeRatesAreSolvedOrDeclined) {
    for (const double factor : {1e-9, 1e-6, 1e-3, 1e3, 1e5, 1e7, 1e9, 1e12}) {
        Scene scene = scene_named("chrono_mcpherson");
        for (auto& elastic : scene.elastics) {
            if (auto* bushing = std::get_if<Bushing>(&elastic.kind))
                stiffness_of(*bushing).topLeftCorner<3, 3>() *= factor;
        }
        const Model model = compile(scene);
        const auto loads = sweep(model.branches[0], 10);
        const auto path = solve(model, model.branches[0], loads);
        EXPECT_EQ(path.outcome == Outcome::converged, path.points.size() == loads.size()) << factor;
        if (factor >= 1e-6 && factor <= 1e5) {
            EXPECT_EQ(path.outcome, Outcome::converged) << factor << path.detail;
        }
        // Force of a rate of 12e6 N/m on the rounding of a position.
        const double roundoff = 1e-7 + 12e6 * factor * 1e-15;
        for (const auto& state : path.points)
            EXPECT_LE(largest(residuals(model, model.branches[0], state)), roundoff)
                << factor << " at " << state.load;
    }
}

}  // namespace
}  // namespace elastocheck::reference::energy
