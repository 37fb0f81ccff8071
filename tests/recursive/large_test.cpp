// Models with hundreds of bodies: memory use, and agreement with closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/diagnosis/loops.hpp"
#include "recursive/series/path.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/cantilever.hpp"
#include "tests/support/scene_text.hpp"

namespace elastocheck::recursive {
namespace {

// A chain of n bodies along x, each on the one before by a bushing of rate k, the first on ground;
// the force F acts on the last.
constexpr double k = 1e6, F = 1e4, pitch = 0.1;
Scene springs_in_series(int n) {
    std::string points = "  p0: [0, 0, 0]\n", bodies, bushings;
    for (int i = 1; i <= n; ++i) {
        points += fmt::format("  p{}: [{}, 0, 0]\n", i, i * pitch);
        bodies += fmt::format("  b{}: {{origin: p{}}}\n", i, i);
        bushings += fmt::format(
            "  s{}: {{bodies: [b{}, {}], at: p{}, rates: [{}, 2e6, 3e6], rotational_rates: [100, "
            "200, "
            "300]}}\n",
            i, i, i == 1 ? std::string("ground") : fmt::format("b{}", i - 1), i - 1, k);
    }
    const std::string last = fmt::format("on: b{0}, at: p{0}", n);
    return support::filled_scene("recursive/scenes/springs_in_series",
                                 {{"POINTS", points},
                                  {"BODIES", bodies},
                                  {"BUSHINGS", bushings},
                                  {"LAST", last},
                                  {"TO", fmt::format("{}", F)},
                                  {"END", last}});
}

TEST(LargeModels, CompliancesOfSpringsInSeriesAddUpInEveryMethod) {
    for (const int n : {2, 30, 300}) {
        const Model model = compile(springs_in_series(n));
        ASSERT_EQ(model.bodies.size(), static_cast<std::size_t>(n));
        const Analysis analysis = analyse(model);
        for (const Method& method : methods) {
            const auto path =
                solve(model, model.branches[0], {.method = method, .steps = 5}, analysis);
            ASSERT_EQ(path.outcome, Outcome::converged) << method.name << " " << path.detail;
            for (const auto& point : path.points)
                for (int i = 1; i <= n; ++i) {
                    const Pose& pose = point.poses[static_cast<std::size_t>(i - 1)];
                    const Eigen::Vector3d there(i * pitch + i * point.load / k, 0, 0);
                    EXPECT_LE((pose.r - there).norm(), 1e-10 * i)
                        << method.name << " " << i << " of " << n;
                    EXPECT_LE(pose.p.vec().norm(), 1e-10) << method.name;
                }
        }
    }
}

// The rounded matrix solves to 1e-12 only. Without residual correction of the coefficients the
// expansions would become arbitrarily short.
TEST(LargeModels, LeafSpringOfAHundredSegmentsNeedsAtMostFortyExpansions) {
    using namespace support;
    const Model model = compile(parse_scene(
        "elastocheck: 1\nname: leaf\nunits: {length: m, angle: rad, force: N}\n" + leaf(100) +
            fmt::format(R"(loads: {{push: {{on: tip, at: tip, force: [0, 1, 0]}}}}
branches: {{push: {{load: push, to: {}, steps: 5}}}}
)",
                        10 * EI / (L * L)),
        "leaf"));
    const series::Path path = series::follow(model, model.branches[0], {}, analyse(model));
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    EXPECT_LE(path.expansions.size(), 40u);
}

TEST(LargeModels, FillOfTheFactorsIsLinearInTheLengthOfAChain) {
    const auto entries = [](int n) {
        const Analysis analysis = analyse(compile(springs_in_series(n)));
        const auto& system = analysis.system;
        EXPECT_EQ(system.M.values.size(), static_cast<std::size_t>(36 * (3 * n - 2)));
        return static_cast<double>(system.lu.LU.size());
    };
    const double few = entries(50), many = entries(200);
    EXPECT_LE(many, 4.2 * few);
    // of every body: its own block, the next one's twice, and the zero after each of its rows
    EXPECT_LE(many, 200 * (36 + 2 * 36 + 6));
}

// n carriers on bushings to ground, side by side along y, each connected to the next by a rod with
// two balls, which spins freely; a force on the first.
Scene carriers_and_rods(int n) {
    std::string points, bodies, bushings, joints;
    for (int i = 0; i < n; ++i) {
        points += fmt::format("  p{}: [0, {}, 0]\n", i, 0.3 * i);
        bodies += fmt::format("  c{}: {{origin: p{}}}\n", i, i);
        bushings += fmt::format(
            "  s{}: {{bodies: [c{}, ground], at: p{}, rates: [1e4, 2e4, 3e4], rotational_rates: "
            "[100, 200, "
            "300]}}\n",
            i, i, i);
        if (i == 0) continue;
        points += fmt::format("  m{}: [{}, {}, 0.02]\n", i, 0.01 * (i % 3), 0.3 * i - 0.1);
        points += fmt::format("  e{}: [{}, {}, 0.05]\n", i, 0.02 * (i % 3), 0.3 * i - 0.02);
        bodies += fmt::format("  rod{}: {{origin: m{}}}\n", i, i);
        joints += fmt::format("  a{}: {{type: spherical, bodies: [rod{}, c{}], at: p{}}}\n", i, i,
                              i - 1, i - 1);
        joints +=
            fmt::format("  b{}: {{type: spherical, bodies: [rod{}, c{}], at: e{}}}\n", i, i, i, i);
    }
    return support::filled_scene("recursive/scenes/carriers_and_rods",
                                 {{"POINTS", points},
                                  {"BODIES", bodies},
                                  {"JOINTS", joints},
                                  {"BUSHINGS", bushings},
                                  {"END", fmt::format("on: c{0}, at: p{0}", n - 1)}});
}

TEST(LargeModels, IdleSpinsOfRodsAreSparseAndRodsMoveAsTheDistancesThatReplaceThem) {
    const int n = 25;
    const Scene scene = carriers_and_rods(n);
    const Model rods = compile(scene, Detail::everything), distances = compile(scene);
    ASSERT_EQ(rods.bodies.size(), static_cast<std::size_t>(2 * n - 1));
    ASSERT_EQ(distances.bodies.size(), static_cast<std::size_t>(n));
    const Analysis analysis = analyse(rods);
    const auto& held = analysis.system.held;
    ASSERT_EQ(held.idle, n - 1);
    EXPECT_EQ(held.row.size(), static_cast<std::size_t>(6 * (n - 1)));
    for (const char* name : {"tangent", "adaptive", "series"}) {
        const Options options{.method = *find_method(name), .steps = 20};
        const auto one = solve(rods, rods.branches[0], options, analysis),
                   other = solve(distances, distances.branches[0], options);
        ASSERT_EQ(one.outcome, Outcome::converged) << name << " " << one.detail;
        ASSERT_EQ(other.outcome, Outcome::converged) << name << " " << other.detail;
        double worst = 0;
        for (std::size_t b = 0; b < rods.bodies.size(); ++b)
            for (std::size_t c = 0; c < distances.bodies.size(); ++c)
                if (rods.bodies[b].name == distances.bodies[c].name)
                    worst = std::max(
                        worst,
                        (one.points.back().poses[b].r - other.points.back().poses[c].r).norm());
        EXPECT_LE(worst, name == std::string("series") ? 1e-11 : 1e-4) << name;
    }
}

// A link on two collinear hinges: the five rows of the second are redundant.
std::string stiff_link(int at) {
    return fmt::format(
        R"(  l{}: {{type: revolute, bodies: [link{}, ground], at: q{}, axis: y}}
  r{}: {{type: revolute, bodies: [link{}, ground], at: r{}, axis: y}}
)",
        at, at, at, at, at, at);
}

TEST(LargeModels, RowsForRedundantJointsHaveEntriesOnlyInTheirLoop) {
    const int n = 12;
    std::string points, bodies, joints;
    for (int i = 0; i < n; ++i) {
        points += fmt::format("  q{}: [{}, 0, 0]\n  r{}: [{}, 0.2, 0]\n", i, i, i, i);
        bodies += fmt::format("  link{}: {{origin: q{}}}\n", i, i);
        joints += stiff_link(i);
    }
    const Model model =
        compile(support::filled_scene("recursive/scenes/repeated_hinges",
                                      {{"POINTS", points}, {"BODIES", bodies}, {"JOINTS", joints}}),
                Detail::everything);
    const std::vector<int> loop = loops(model);
    ASSERT_EQ(loop.size(), static_cast<std::size_t>(10 * n));
    for (std::size_t row = 0; row < loop.size(); ++row)
        for (std::size_t other = 0; other < loop.size(); ++other)
            EXPECT_EQ(loop[row] == loop[other], row / 10 == other / 10) << row << " " << other;
    const auto& held = analyse(model).system.held;
    EXPECT_EQ(held.size() - held.idle, 5 * n);
    for (int c = held.idle; c < held.size(); ++c) EXPECT_EQ(held.end(c) - held.begin(c), 10);
}

TEST(LargeModels, LoopsAreTheBiconnectedComponentsOfTheJointGraph) {
    const Model model = model_of("loops", {}, Detail::everything);
    const std::vector<int> loop = loops(model);
    ASSERT_EQ(model.joints.size(), 8u);
    ASSERT_EQ(loop.size(), 24u);
    const auto of = [&](const char* name) {
        for (std::size_t c = 0, row = 0; c < model.constraints.size(); row += 3, ++c)
            if (model.joints[static_cast<std::size_t>(model.constraints[c].joint)].name == name)
                return loop[row];
        return -1;
    };
    EXPECT_EQ(of("ga"), of("ab"));
    EXPECT_EQ(of("ga"), of("bg"));
    EXPECT_EQ(of("cd"), of("de"));
    EXPECT_EQ(of("cd"), of("ec"));
    for (const char* alone : {"bc", "fg"})
        for (const char* other : {"ga", "cd"})
            EXPECT_NE(of(alone), of(other)) << alone << " " << other;
    EXPECT_NE(of("ga"), of("cd"));
    EXPECT_NE(of("bc"), of("fg"));
    // a row without moving bodies forms a loop of its own
    for (const int row : loops(model_of("fixed_link"))) EXPECT_GE(row, 0);
}

}  // namespace
}  // namespace elastocheck::recursive
