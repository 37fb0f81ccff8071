// A-posteriori error bounds of path points hold and are tight.
// The remaining stiffness vanishes at the end of the branch.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "models/branch.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

// Worst result over the error bounds of one leg or method.
struct Judged {
    int points = 0, unbounded = 0;
    double tightest = 0;  // error over bound: 1 at most
    double loosest = 0;   // bound over the larger of the error and 1e-11 m, 1e-11 rad
    std::string where;
};

// Bodies that no idle mode moves; the bound does not cover idle modes.
std::vector<bool> resisted(const Diagnosis& diagnosis, std::size_t bodies) {
    std::vector<bool> still(bodies, true);
    for (std::size_t b = 0; b < bodies; ++b)
        for (const auto& mode : diagnosis.idle)
            for (Eigen::SparseVector<double>::InnerIterator at(mode.dq); at; ++at)
                if (at.index() / 6 == static_cast<Eigen::Index>(b) && std::abs(at.value()) > 1e-6)
                    still[b] = false;
    return still;
}

void judge(Judged& judged, const std::vector<bool>& still, const Equilibrium& point,
           const Equilibrium& truth, const std::string& what) {
    ++judged.points;
    if (!std::isfinite(point.bound.length) || !std::isfinite(point.bound.angle)) {
        ++judged.unbounded;
        judged.where += "\nno bound: " + what;
        return;
    }
    double length = 0, angle = 0;
    for (std::size_t b = 0; b < still.size(); ++b) {
        if (!still[b]) continue;
        length = std::max(length, (point.poses[b].r - truth.poses[b].r).norm());
        const auto between =
            point.poses[b].p.normalized().conjugate() * truth.poses[b].p.normalized();
        angle = std::max(angle, 2 * std::atan2(between.vec().norm(), std::abs(between.w())));
    }
    const double allowed_length = point.bound.length + truth.bound.length,
                 allowed_angle = point.bound.angle + truth.bound.angle;
    EXPECT_TRUE(length <= allowed_length && angle <= allowed_angle)
        << what << ": " << length << " m, " << angle << " rad off, the bound is " << allowed_length
        << " and " << allowed_angle;
    judged.tightest = std::max({judged.tightest, length / allowed_length, angle / allowed_angle});
    judged.loosest = std::max({judged.loosest, point.bound.length / std::max(length, 1e-11),
                               point.bound.angle / std::max(angle, 1e-11)});
}

std::vector<double> every_point(const Branch& branch) {
    std::vector<double> a;
    for (int k = 0; k <= branch.steps; ++k) a.push_back(branch.to * k / branch.steps);
    return a;
}

void judge_branch(std::map<std::string, Judged>& all, const Model& model, const Branch& branch,
                  bool conservative, const std::string& what) {
    const Analysis analysis = analyse(model);
    const auto still = resisted(analysis.diagnosis, model.bodies.size());
    const auto truth =
        reference::equilibrium::solve(model, branch, every_point(branch), {.error_bound = true});
    if (truth.outcome != Outcome::converged) return;
    const auto of = [&](const std::string& who, const EquilibriumPath& path) {
        if (path.outcome != Outcome::converged) return;
        ASSERT_EQ(path.points.size(), truth.points.size()) << what << " " << who;
        for (std::size_t k = 0; k < path.points.size(); ++k)
            judge(all[who], still, path.points[k], truth.points[k],
                  fmt::format("{} {} at {:.6g}", what, who, path.points[k].load));
    };
    of("equilibrium", truth);
    if (conservative)
        of("energy",
           reference::energy::solve(model, branch, every_point(branch), {.error_bound = true}));
    for (const Method& method : methods)
        of(std::string(method.name),
           solve(model, branch, {.method = method, .error_bound = true}, analysis));
}

void print(const std::map<std::string, Judged>& all) {
    for (const auto& [who, judged] : all)
        fmt::print(
            "{:12} {:6} points, {:4} without a bound, error at most {:.3g} of the bound, bound at "
            "most "
            "{:.3g} "
            "times the error{}\n",
            who, judged.points, judged.unbounded, judged.tightest, judged.loosest,
            judged.where.substr(0, 400));
}

TEST(Account, BoundsHoldOnEverySmallScene) {
    std::map<std::string, Judged> all;
    for (const std::string& name : support::small_scene_names()) {
        const Scene scene = support::scene(name);
        const Model model = compile(scene);
        for (const Branch& whole : model.branches)
            for (Branch way : ways(whole)) {
                way.steps = std::min(way.steps, 12);
                judge_branch(all, on_branch(model, way), way, support::has_potential(scene),
                             name + " " + way.name);
            }
    }
    print(all);
}

TEST(Account, BoundsHoldOnRandomScenes) {
    std::map<std::string, Judged> all;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const auto scene = compare::small_random_scene(seed);
        if (!scene) continue;
        const Model whole = compile(*scene);
        Branch side = ways(whole.branches[0]).back();
        side.steps = 5;
        judge_branch(all, on_branch(whole, side), side, support::has_potential(*scene),
                     fmt::format("seed {}", seed));
    }
    print(all);
}

// ---- Remaining stiffness.

// The arch of two springs, which moves only vertically: F'(z) over F'(z₀).
double arch_stiffness(double z) {
    const double l = std::hypot(0.3, z), l_0 = std::hypot(0.3, 0.08);
    return 2e5 * (1 - l_0 / l + l_0 * z * z / (l * l * l));
}

TEST(Account, TellsTheStiffnessThatIsLeftOfAnArch) {
    const Model model = compile(support::scene("two_spring_arch"));
    Branch branch = model.branches[0];
    branch.to = -211.5;  // the limit is at -211.5166 N
    branch.steps = 20;
    const auto judge = [&](const char* who, const EquilibriumPath& path) {
        ASSERT_EQ(path.outcome, Outcome::converged) << who << path.detail;
        for (const auto& point : path.points)
            EXPECT_NEAR(point.stiffness_left,
                        arch_stiffness(point.poses[0].r.z()) / arch_stiffness(0.08), 1e-6)
                << who << " at " << point.load;
        EXPECT_LT(path.points.back().stiffness_left, 0.02) << who;
    };
    judge("equilibrium",
          reference::equilibrium::solve(model, branch, every_point(branch), {.error_bound = true}));
    judge("energy",
          reference::energy::solve(model, branch, every_point(branch), {.error_bound = true}));
    judge("series", solve(model, branch, {.method = *find_method("series"), .error_bound = true}));
}

// A path by arc length continues past the limit point; there the stiffness is negative.
TEST(Account, StiffnessIsNegativePastALimitPoint) {
    Model model = compile(support::scene("two_spring_arch"));
    Branch& branch = model.branches[0];
    branch.to = -400;
    const Method arc{"series", 0, Series{.arc_length = true}};
    const auto path = solve(model, branch, {.method = arc, .steps = 60, .error_bound = true});
    ASSERT_FALSE(path.points.empty());
    int negative = 0;
    for (const auto& point : path.points) {
        const double exact = arch_stiffness(point.poses[0].r.z()) / arch_stiffness(0.08);
        EXPECT_NEAR(point.stiffness_left, exact, 1e-6) << point.load;
        negative += point.stiffness_left < 0;
        EXPECT_LE(point.bound.length, 1e-9) << point.load;
    }
    EXPECT_GT(negative, 5);
}

// Two modes that become unstable at once leave the sign of the determinant unchanged: a bar on a
// ball joint, with the same torsional rate in both directions.
TEST(Account, AColumnThatMayFallAnyWayIsNotFollowedPastItsLoad) {
    const Model model = compile(
        parse_scene("elastocheck: 1\nname: any way\nunits: {length: m, angle: rad, force: N}\n"
                    "points: {foot: [0, 0, 0], head: [0, 0, 0.5]}\nbodies: {bar: {origin: foot}}\n"
                    "joints: {foot: {type: spherical, bodies: [bar, ground], at: foot}}\n"
                    "bushings: {torsion: {bodies: [bar, ground], at: foot, rates: [0, 0, 0], "
                    "rotational_rates: [100, "
                    "100, 100]}}\n"
                    "loads: {weight: {on: bar, at: head, force: [0, 0, -1]}}\n"
                    "branches: {press: {load: weight, to: 350, steps: 20}}\nprobes: {head: {on: "
                    "bar, at: head}}\n",
                    "any way"));
    const Branch& branch = model.branches[0];
    for (const Method& method : methods) {
        const auto path = solve(model, branch, {.method = method, .error_bound = true});
        EXPECT_EQ(path.outcome, Outcome::bifurcation_point)
            << method.name << " " << path.detail;  // at 100 / 0.5
        ASSERT_FALSE(path.points.empty()) << method.name;
        EXPECT_NEAR(path.points.back().load, 192.5, 1e-9) << method.name;
        for (const auto& point : path.points)
            EXPECT_NEAR(point.stiffness_left, 1 - point.load / 200, 1e-6)
                << method.name << " " << point.load;
    }
    EXPECT_EQ(reference::equilibrium::solve(model, branch, every_point(branch)).outcome,
              Outcome::bifurcation_point);
    EXPECT_EQ(reference::energy::solve(model, branch, every_point(branch)).outcome,
              Outcome::bifurcation_point);
}

// Newton's method may converge between two inconsistent links that stay open: no equilibrium, on no
// branch.
TEST(Account, WhereTheFirstPointHasNoBoundNothingIsPromised) {
    const Model model = compile(parse_scene(R"(
elastocheck: 1
name: two links that contradict each other
units: {length: mm, angle: rad, force: N, moment: N·m}
points: {ball: [0, 0, 0], wall: [0, 500, 0], tip: [400, 0, 0]}
bodies: {bob: {origin: tip}}
joints:
  ball: {type: spherical, bodies: [bob, ground], at: ball}
  link: {type: distance, bodies: [bob, ground], from: ball, to: wall, length: 500.00001}
bushings: {ball: {bodies: [bob, ground], at: ball, rates: [0, 0, 0], rotational_rates: [600, 600, 600]}}
loads: {pull: {on: bob, at: tip, force: [0, 0, 1]}}
branches: {up: {load: pull, to: 500, steps: 4}}
probes: {tip: {on: bob, at: tip}}
)",
                                            "links.yaml"));
    for (const auto& method : methods) {
        const auto path = solve(model, model.branches[0], {.method = method, .error_bound = true});
        for (const auto& point : path.points)
            EXPECT_EQ(point.bound.length, std::numeric_limits<double>::infinity())
                << method.name << " at " << point.load;
    }
}

// Error bounds are computed only on request.
TEST(Account, IsGivenWhereItIsAsked) {
    const Model model = compile(support::scene("two_spring_arch"));
    Branch branch = model.branches[0];
    branch.to = -100;
    for (const bool asked : {false, true}) {
        for (const Method& method : methods)
            for (const auto& point :
                 solve(model, branch, {.method = method, .error_bound = asked}).points) {
                EXPECT_EQ(std::isfinite(point.bound.length), asked) << method.name;
                EXPECT_EQ(std::isnan(point.stiffness_left), !asked) << method.name;
            }
        const double loads[] = {0, -50, -100};
        for (const auto& path :
             {reference::equilibrium::solve(model, branch, loads, {.error_bound = asked}),
              reference::energy::solve(model, branch, loads, {.error_bound = asked})})
            for (const auto& point : path.points) {
                EXPECT_EQ(std::isfinite(point.bound.length), asked);
                EXPECT_EQ(std::isnan(point.stiffness_left), !asked);
            }
    }
}

}  // namespace
}  // namespace elastocheck::recursive
