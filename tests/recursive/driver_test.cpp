// Driven branches and loss of stability, by every method of the recursion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "models/branch.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/singularity/branch_events.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;

Body body(const char* name, const Vector3d& r) {
    return {name, {r, Eigen::Quaterniond::Identity()}};
}
Point on_ground(const Vector3d& p) { return {ground, p}; }

// A branch with one driver, and the model active on it.
struct Driven1 {
    Model model;
    Branch branch;
};
Driven1 driven(Scene scene, Driver driver, double to, int steps) {
    Branch branch{"driven", 0, to, steps, ParameterUnit::none, {std::move(driver)}};
    scene.branches = {branch};
    const Model model = compile(scene);
    return {on_branch(model, model.branches[0]), model.branches[0]};
}
EquilibriumPath run(const Driven1& d, const Method& method, int steps = 0, int record = 0) {
    auto path = solve(d.model, d.branch, {.method = method, .steps = steps, .record = record});
    EXPECT_EQ(path.outcome, Outcome::converged) << method.name << ": " << path.detail;
    return path;
}
Method rung(const char* name) { return *find_method(name); }
Method adaptive(double tolerance) { return {"adaptive", 3, Adaptive{tolerance, tolerance}}; }
bool steps_or_adapts(const Method& method) { return !std::holds_alternative<Series>(method.kind); }

// ---- Mechanisms without elasticity: a crank about y, driven through a full turn by its angle, x
// towards -z.

constexpr double crank_length = 0.1, full_turn = 2 * 3.14159265358979323846;
const Direction y_axis{ground, Vector3d::UnitY()};
Direction own_y(BodyId b) { return {b, Vector3d::UnitY()}; }
Angle crank_angle() {
    return {{0, Vector3d::UnitX()}, {ground, Vector3d::UnitX()}, {ground, -Vector3d::UnitZ()}, 0};
}

// The rod's far end stays in the plane z = 0.
constexpr double rod_length = 0.3;
Driven1 slider_crank(int steps) {
    Scene scene;
    scene.bodies = {body("crank", Vector3d::Zero()), body("rod", {crank_length, 0, 0})};
    const Vector3d pin(crank_length, 0, 0), end(rod_length, 0, 0);
    scene.joints = {
        {"hinge", Revolute{{0, Vector3d::Zero()}, on_ground({0, 0, 0}), own_y(0), y_axis}},
        {"pin", Revolute{{1, Vector3d::Zero()}, {0, pin}, own_y(1), own_y(0)}},
        {"slide", InPlane{{1, end}, on_ground({0, 0, 0}), {ground, Vector3d::UnitZ()}}},
        {"motor", crank_angle(), true}};
    scene.probes = {{"slider", {1, end}}};
    return driven(scene, {Motion{3}, 0, 1}, full_turn, steps);
}
double slider(const Equilibrium& state) {
    return (state.poses[1].r + state.poses[1].p * Vector3d(rod_length, 0, 0)).x();
}
double exact_slider(double angle) {
    const double height = crank_length * std::sin(angle);
    return crank_length * std::cos(angle) + std::sqrt(rod_length * rod_length - height * height);
}
double worst_slider(const EquilibriumPath& path) {
    double worst = 0;
    for (const auto& point : path.points)
        worst = std::max(worst, std::abs(slider(point) - exact_slider(point.load)));
    return worst;
}

TEST(Driver, MethodsFollowASliderCrankWithTheOrderOfOneStep) {
    const Driven1 d = slider_crank(360);
    EXPECT_LE(worst_slider(run(d, adaptive(1e-12), 36)), 1e-12 * 0.4);
    // The error at a point is that of the method's last step: the order of one step.
    for (const auto& [name, order] :
         {std::pair{"closed", 2.0}, {"tangent", 2.0}, {"chord", 3.0}, {"midpoint", 3.0}}) {
        const double coarse = worst_slider(run(d, rung(name), 360, 36)),
                     fine = worst_slider(run(d, rung(name), 720, 36));
        if (fine > 1e-13) {
            EXPECT_GE(std::log2(coarse / fine), order - 0.2)
                << name << " " << coarse << " " << fine;
        }
    }
}

TEST(Driver, AStepOfHalfATurnOrAWholeOneIsNotTakenForNone) {
    for (const double to : {full_turn / 2, full_turn, -full_turn / 2}) {
        Driven1 d = slider_crank(1);
        d.branch.to = to;
        for (const auto& method : methods)
            if (has_steps(method)) {
                const auto path = solve(d.model, d.branch, {.method = method, .steps = 1});
                EXPECT_EQ(path.outcome, Outcome::diverged) << method.name << " " << to;
            }
    }
}

TEST(Driver, PublishedFollowsTheSliderCrankAtFirstOrderInItsConstraintError) {
    const Driven1 d = slider_crank(360);
    // Over a whole turn the leading term vanishes, so the worst point of the branch is tested.
    const auto error = [&](int steps) {
        double worst = 0;
        for (const auto& point : run(d, rung("published"), steps, 8).points)
            worst = std::max(worst, point.constraint_error);
        return worst;
    };
    const double coarse = error(720), fine = error(1440);
    EXPECT_NEAR(std::log2(coarse / fine), 1, 0.1) << coarse << " " << fine;
}

// ---- Elastic scenes on a jack.

Driven1 jacked(const Scene& scene, const Point& at, const Vector3d& drawn, double to, int steps) {
    Scene with = scene;
    with.joints.push_back(
        {"jack", InPlane{at, on_ground(drawn), {ground, Vector3d::UnitZ()}}, true});
    return driven(with, {Motion{static_cast<int>(with.joints.size()) - 1}, 0, 1}, to, steps);
}

TEST(Driver, ADrivenArchPassesBothItsLimitPointsAndItsWorkIsItsEnergy) {
    const Scene scene = support::scene("two_spring_arch");
    constexpr double k = 1e5, half_span = 0.3, height = 0.08;
    const double free = std::hypot(half_span, height);
    const auto force = [&](double z) {
        return 2 * k * (std::hypot(half_span, z) - free) * z / std::hypot(half_span, z);
    };
    // Limit of the published sum: ∫ 2k ζ²/(b² + ζ²) dζ, with the spring axes of each step.
    const auto turned_nothing = [&](double z) {
        return 2 * k *
               (z - height -
                half_span * (std::atan(z / half_span) - std::atan(height / half_span)));
    };
    const Driven1 d = jacked(scene, scene.probes[0].at, {0, 0, height}, -2 * height - 0.02, 400);
    for (Method method : methods) {
        if (!steps_or_adapts(method)) continue;
        if (method.name == "adaptive") method = adaptive(1e-9);
        const auto path = run(d, method, 400);
        double work = 0, worst = 0;
        for (std::size_t n = 0; n < path.points.size(); ++n) {
            const double jack = path.points[n].reactions.back().force.z(),
                         z = height + path.points[n].load;
            worst = std::max(
                worst, std::abs(jack - (method.formal_order > 0 ? force(z) : turned_nothing(z))));
            work += jack * (n == 0 || n + 1 == path.points.size() ? 1 : n % 2 == 1 ? 4 : 2);
        }
        work *= d.branch.to / 400 / 3;
        const double stretch = std::hypot(half_span, height + d.branch.to) - free;
        // In newtons of 2.6 kN; the lag of a method's λ has the method's order.
        const bool exact = method.name == "chord" || method.name == "adaptive";
        EXPECT_LE(worst, exact ? 1e-5 : method.formal_order > 1 ? 0.1 : 5) << method.name;
        if (exact) {
            EXPECT_NEAR(work / (k * stretch * stretch), 1, 1e-8) << method.name;
        }
    }
}

TEST(Driver, WhatIsHeldAtTheStartIsSettledBeforeTheBranch) {
    // A pinned bar whose rod is drawn too short, and a jack with its start at 30 mm: every method
    // starts there.
    const Scene scene = support::scene("chrono_mcpherson");
    const Wheel& wheel = scene.wheels[0];
    const Vector3d drawn =
        scene.bodies[static_cast<std::size_t>(wheel.body)].design.r +
        scene.bodies[static_cast<std::size_t>(wheel.body)].design.p * wheel.centre_local;
    Driven1 d = jacked(scene, {wheel.body, wheel.centre_local}, drawn, 0.02, 100);
    d.branch.drivers[0].start = 0.03;
    for (auto& constraint : d.model.constraints)
        if (auto* rod = std::get_if<DistanceBetween>(&constraint.kind)) rod->length += 1e-3;
    for (const auto& method : methods) {
        if (!steps_or_adapts(method)) continue;
        const auto path = run(d, method, 100);
        const Equilibrium& first = path.points.front();
        const Pose& pose = first.poses[static_cast<std::size_t>(d.model.wheels[0].body)];
        const bool follows = method.formal_order > 0, closes = method.name != "published";
        EXPECT_NEAR((pose.r + pose.p * wheel.centre_local).z(), drawn.z() + 0.03,
                    closes ? 1e-6 : 1e-3)
            << method.name;
        const auto left = residuals(d.model, d.branch, first);
        EXPECT_LE(left.length, closes ? 1e-6 : 1e-3) << method.name;
        if (follows) {
            EXPECT_LE(std::max(left.force, left.moment), 1e-5) << method.name;
        }
    }
}

// ---- Regression scenes.

TEST(Found, WhatEndsOrLosesItsStabilityIsSaidSoWhateverTheSteps) {
    for (const char* name :
         {"adaptive-segfault-arch", "adaptive-segfault-five-links", "arch-past-its-limit",
          "straight-column-one-body", "straight-column-two-bodies"}) {
        const Model model = found(name);
        for (const char* method : {"tangent", "chord", "midpoint", "adaptive"})
            for (const int steps : {5, 20, 200}) {
                const auto path =
                    solve(model, model.branches[0], {.method = rung(method), .steps = steps});
                EXPECT_NE(path.outcome, Outcome::converged)
                    << name << " " << method << " " << steps;
            }
        (void)solve(model, model.branches[0]);
    }
}

// ---- Stability lost inside a branch and regained before its end.

// `copies` of a body between two springs, which are compressed as it moves through the line between
// their ends; all copies have the same load. The body is unstable sideways while the springs are
// shorter than ℓ = ℓ_d / (1 + k_y / 2k), and stable before and after.
Model bubbles(double k_y, double to, int copies = 1) {
    std::string bodies, joints, springs, bushings, loads, load;
    for (int k = 0; k < copies; ++k) {
        bodies += fmt::format("  a{0}: {{origin: apex}}\n", k);
        joints += fmt::format(
            "  o{0}: {{type: parallel, bodies: [a{0}, ground], axis: x}}\n"
            "  p{0}: {{type: in_plane, bodies: [a{0}, ground], at: apex, normal: x}}\n",
            k);
        springs += fmt::format(
            "  l{0}: {{bodies: [a{0}, ground], from: apex, to: l, rate: 100}}\n"
            "  r{0}: {{bodies: [a{0}, ground], from: apex, to: r, rate: 100}}\n",
            k);
        bushings += fmt::format(
            "  k{0}: {{bodies: [ground, a{0}], at: apex, rates: [0, {1}, 20], rotational_rates: "
            "[10, 10, "
            "10]}}\n",
            k, k_y);
        loads += fmt::format("  v{0}: {{on: a{0}, at: apex, force: [0, 0, 1]}}\n", k);
        load += fmt::format("{}v{}: 1", k == 0 ? "" : ", ", k);
    }
    return compile(parse_scene(
        fmt::format("elastocheck: 1\nname: bubble\nunits: {{length: mm, angle: deg, force: N}}\n"
                    "points: {{l: [-300, 0, 0], r: [300, 0, 0], apex: [0, 0, 80]}}\n"
                    "bodies:\n{}joints:\n{}springs:\n{}bushings:\n{}loads:\n{}"
                    "branches: {{d: {{load: {{{}}}, to: {}, steps: 20}}}}\n"
                    "probes: {{apex: {{on: a0, at: apex}}}}\n",
                    bodies, joints, springs, bushings, loads, load, to),
        "bubble.yaml"));
}

// Load [N] at which the body of bubbles() becomes unstable; NaN if k_y keeps it stable.
double bubble_begins(double k_y) {
    const double drawn = std::hypot(300, 80), length = drawn / (1 + k_y / 200),
                 z = std::sqrt(length * length - 300 * 300);
    return 20 * (z - 80) + 200 * (1 - drawn / length) * z;
}

TEST(Watch, AStretchOfInstabilityEndsEveryMethodWithStepsWhereItBegins) {
    for (const double k_y : {6.5, 6.8, 6.9, 6.95, 6.97, 6.98, 6.985, 6.988})
        for (const double to : {-3200., -2500., -2100., -4100., -8000.})
            for (const int copies : {1, 2}) {
                const Model model = bubbles(k_y, to, copies);
                const auto event = watch(model, model.branches[0], analyse(model));
                ASSERT_TRUE(event) << k_y << " " << to << " " << copies;
                EXPECT_NEAR(event->load, bubble_begins(k_y), 1e-4 * std::abs(to))
                    << k_y << " " << to << " " << copies;
            }
    const Model model = found("bubble");
    for (const auto& method : methods) {
        if (!has_steps(method)) continue;
        const auto path = solve(model, model.branches[0], {.method = method, .steps = 20});
        EXPECT_NE(path.outcome, Outcome::converged) << method.name;
        EXPECT_GE(path.points.back().load, bubble_begins(6.95)) << method.name;
    }
}

TEST(Watch, AStretchThatStaysStableIsNoEvent) {
    for (const double k_y : {6.99, 7.0, 7.1, 7.5})
        for (const double to : {-3200., -2500., -8000.})
            for (const int copies : {1, 2}) {
                const Model model = bubbles(k_y, to, copies);
                EXPECT_FALSE(watch(model, model.branches[0], analyse(model))) << k_y << " " << to;
            }
}

// Six upright bars on ball joints with rotational bushings. A dead weight on the first buckles it
// in both planes at once, so that the sign of the determinant does not show the instability. The
// other bars are much softer and stable, and inverse iteration converges to their modes.
std::string upright_bars(double weight) {
    std::string points, bodies, joints, bushings, loads;
    for (int k = 0; k < 6; ++k) {
        const double rate = k == 0 ? 1000 : 1e-3 * (k + 1);
        points += fmt::format("  foot{0}: [{0}, 0, 0]\n  head{0}: [{0}, 0, 0.5]\n", k);
        bodies += fmt::format("  bar{0}: {{origin: foot{0}}}\n", k);
        joints += fmt::format(
            "  foot{0}: {{type: spherical, bodies: [bar{0}, ground], at: foot{0}}}\n", k);
        bushings += fmt::format(
            "  b{0}: {{bodies: [bar{0}, ground], at: foot{0}, rates: [0, 0, 0], rotational_rates: "
            "[{1}, {1}, "
            "{1}]}}\n",
            k, rate);
    }
    return "elastocheck: 1\nname: upright bars\nunits: {length: m, angle: rad, force: "
           "N}\npoints:\n" +
           points + "bodies:\n" + bodies + "joints:\n" + joints + "bushings:\n" + bushings +
           fmt::format("static_loads: {{weight: {{on: bar0, at: head0, force: [0, 0, {}]}}}}\n",
                       -weight) +
           "loads: {push: {on: bar1, at: head1, force: [1, 0, 0]}}\n"
           "branches: {push: {load: push, to: 1e-3, steps: 4}}\n"
           "probes: {head0: {on: bar0, at: head0}, head1: {on: bar1, at: head1}}\n";
}

// A block between two compressed springs: an equilibrium as drawn without any reaction. Across the
// springs, in both directions at once, their geometric stiffness is twice the preload over 1 m.
std::string squeezed_block(double preload) {
    return fmt::format(R"(
elastocheck: 1
name: squeezed block
units: {{length: m, angle: rad, force: N}}
points: {{block: [0, 0, 0], left: [-1, 0, 0], right: [1, 0, 0]}}
bodies: {{block: {{origin: block}}}}
springs:
  left: {{bodies: [block, ground], from: block, to: left, rate: 1000, preload: {0}}}
  right: {{bodies: [block, ground], from: block, to: right, rate: 1000, preload: {0}}}
bushings: {{hold: {{bodies: [block, ground], at: block, rates: [100, 100, 100], rotational_rates: [9, 9, 9]}}}}
loads: {{push: {{on: block, at: block, force: [1, 0, 0]}}}}
branches: {{push: {{load: push, to: 1e-3, steps: 4}}}}
probes: {{block: {{on: block, at: block}}}}
)",
                       preload);
}

TEST(Start, ThatIsUnstableIsNamedByEveryMethod) {
    for (const auto& [scene, at_rest, unstable] : {std::tuple{upright_bars(1900), false, false},
                                                   {upright_bars(2100), false, true},
                                                   {squeezed_block(45), true, false},
                                                   {squeezed_block(55), true, true}}) {
        const Model model = compile(parse_scene(scene, "scene.yaml"));
        const Branch& branch = model.branches[0];
        // at rest the start is judged with the model, once for all branches
        EXPECT_EQ(analyse(model).at_rest, at_rest) << scene;
        EXPECT_EQ(analyse(model).start.unstable, at_rest && unstable) << scene;
        for (const Method& method : methods) {
            const auto path = solve(model, branch, {.method = method});
            EXPECT_EQ(path.outcome, unstable ? Outcome::singular : Outcome::converged)
                << method.name << ": " << path.detail;
            EXPECT_EQ(path.points.empty(), unstable) << method.name;
            EXPECT_EQ(path.detail.find("the equilibrium that settles at 0") != std::string::npos,
                      unstable)
                << method.name << ": " << path.detail;
        }
    }
}

void expect_followed(const std::string& scene) {
    const Model model = compile(parse_scene(scene, "scene.yaml"));
    for (const Method& method : methods) {
        const auto path = solve(model, model.branches[0], {.method = method});
        EXPECT_EQ(path.outcome, Outcome::converged) << method.name << ": " << path.detail;
    }
}

// Rounding of stiff elements and joints exceeds the springs of a chain that is free as drawn, and
// stable.
TEST(Start, ThatIsSoftBesideStiffElementsIsNotCalledUnstable) {
    expect_followed(R"(
elastocheck: 1
name: soft beside stiff
units: {length: mm, angle: deg, force: N}
points:
  h0: [194.171, 34.763, -441.838]
  o0: [-173.993, 190.107, 145.064]
  h1: [311.954, 391.509, -184.634]
  o1: [-6.269, -169.958, -372.078]
  h2: [-359.883, -243.531, -411.971]
  o2: [38.826, 202.922, 63.073]
  h3: [184.767, -273.752, -300.596]
  o3: [67.575, 384.286, -77.735]
  h4: [-495.763, -479.948, -194.695]
  o4: [115.374, -415.435, -275.49]
  f0: [-256.172, -322.927, -630.327]
  f1: [-656.362, -505.351, -140.942]
  f2: [607.188, 193.729, -361.115]
  f3: [251.502, -316.914, 21.333]
  f4: [-249.441, 628.139, -206.692]
  far: [1000, 0, 400]
bodies:
  b0: {origin: o0}
  b1: {origin: o1}
  b2: {origin: o2}
  b3: {origin: o3}
  b4: {origin: o4}
  block: {origin: far}
joints:
  j0: {type: revolute, bodies: [b0, ground], at: h0, axis: [0.361, 0.97, -0.318]}
  j1: {type: revolute, bodies: [b1, b0], at: h1, axis: [0.202, 0.037, -0.954]}
  j2: {type: revolute, bodies: [b2, b1], at: h2, axis: [-0.34, -0.721, -0.498]}
  j3: {type: revolute, bodies: [b3, b2], at: h3, axis: [0.54, 0.362, -0.918]}
  j4: {type: revolute, bodies: [b4, b3], at: h4, axis: [-0.845, 0.45, -0.794]}
springs:
  t0: {bodies: [b0, ground], from: o0, to: f0, rate: 1e-1}
  t1: {bodies: [b1, b0], from: o1, to: f1, rate: 1e-1}
  t2: {bodies: [b2, b1], from: o2, to: f2, rate: 1e-1}
  t3: {bodies: [b3, b2], from: o3, to: f3, rate: 1e-1}
  t4: {bodies: [b4, b3], from: o4, to: f4, rate: 1e-1}
bushings:
  b: {bodies: [block, ground], at: far, rates: [1e11, 1e11, 1e11], rotational_rates: [1e11,1e11,1e11]}
loads:
  other: {on: block, at: far, force: [1, 0, 0]}
branches:
  up: {load: other, to: 1, steps: 2}
probes:
  far: {on: block, at: far}
  tip: {on: b4, at: o4}
)");
}

// A follower thrust above the buckling load of a dead force and below the flutter load of the links
// (Ziegler). The symmetric part of its K is negative but does not decide stability, however small
// the other part is.
TEST(Start, UnderAThrustThatFollowsIsNotJudgedAsIfItHadAnEnergy) {
    expect_followed(R"(
elastocheck: 1
name: Ziegler beside a stiff bushing
units: {length: m, angle: rad, force: N}
points:
  A: [0, 0, 0]
  B: [0, 0, 1]
  C: [0, 0, 2]
  far: [1, 0, 0]
bodies:
  one: {origin: A}
  two: {origin: B}
  block: {origin: far}
joints:
  a: {type: revolute, bodies: [one, ground], at: A, axis: y}
  b: {type: revolute, bodies: [two, one], at: B, axis: y}
torsion_springs:
  ka: {bodies: [one, ground], at: A, axis: y, rate: 100}
  kb: {bodies: [two, one], at: B, axis: y, rate: 100}
bushings:
  s: {bodies: [block, ground], at: far, rates: [3e8, 3e8, 3e8], rotational_rates: [3e8, 3e8, 3e8]}
static_loads:
  thrust: {on: two, at: C, force: [0, 0, -240], follows: true}
loads:
  push: {on: block, at: far, force: [1, 0, 0]}
branches:
  up: {load: push, to: 1, steps: 4}
probes:
  tip: {on: two, at: C}
  far: {on: block, at: far}
)");
}

}  // namespace
}  // namespace elastocheck::recursive
