// Where a number cannot be right every method says so: joints that nearly repeat or contradict each other, laws that end,
// points next to a limit point.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "models/compile.hpp"
#include "models/reader/scene_file.hpp"
#include "recursive/diagnosis.hpp"
#include "recursive/solve.hpp"

namespace elastocheck::recursive {
namespace {

// A door on two hinges whose axes meet at an angle.
Model door(double skew) {
    return compile(parse_scene(
        fmt::format(
            "elastocheck: 1\nname: door\nunits: {{length: m, angle: rad, force: N, moment: N·m}}\n"
            "points: {{lower: [0, 0, 0], upper: [0, 0, 1], skew: [{:.17g}, 0, 2], handle: [0, 0.8, 0.5]}}\n"
            "bodies: {{door: {{origin: handle}}}}\n"
            "joints:\n"
            "  lower: {{type: revolute, bodies: [door, ground], at: lower, axis: [lower, upper]}}\n"
            "  upper: {{type: revolute, bodies: [door, ground], at: upper, axis: [upper, skew]}}\n"
            "torsion_springs: {{closer: {{bodies: [door, ground], at: lower, axis: z, rate: 200}}}}\n"
            "loads: {{push: {{on: door, at: handle, force: [1, 0, 0]}}}}\n"
            "branches: {{open: {{load: push, to: 200, steps: 4}}}}\nprobes: {{handle: {{on: door, at: "
            "handle}}}}\n",
            skew),
        "door"));
}

TEST(Extremes, ARankThatCannotBeToldIsSaid) {
    for (const double skew : {0.0, 1e-15, 1e-12, 3e-10, 1e-6}) {
        const Model model = door(skew);
        for (const Method& method : methods) {
            const auto path = solve(model, model.branches[0], {.method = method, .account = true});
            const bool in_doubt = skew > 1e-13 && skew < 1e-9;
            EXPECT_EQ(path.outcome, in_doubt ? Outcome::singular : Outcome::converged)
                << method.name << " " << skew << path.detail;
            EXPECT_EQ(path.detail.find("joint 'upper' repeats what others hold cannot be told") !=
                          std::string::npos,
                      in_doubt)
                << path.detail;
            EXPECT_EQ(path.points.empty(), in_doubt) << method.name;
        }
    }
}

// A bob on a ball, and a link from its middle to the ground that is longer than the two are apart.
Model linked(double apart, const std::string& more = "") {
    return compile(parse_scene(
        fmt::format(
            "elastocheck: 1\nname: linked\nunits: {{length: m, angle: rad, force: N, moment: N·m}}\n"
            "points: {{ball: [0, 0, 0], wall: [0, 0.5, 0], tip: [0.4, 0, 0]}}\nbodies: {{bob: {{origin: "
            "tip}}}}\n"
            "joints:\n"
            "  ball: {{type: spherical, bodies: [bob, ground], at: ball}}\n"
            "  link: {{type: distance, bodies: [bob, ground], from: ball, to: wall, length: {:.17g}}}\n"
            "bushings: {{mount: {{bodies: [bob, ground], at: ball, rates: [0, 0, 0], rotational_rates: [600, "
            "600, "
            "600]}}}}\n"
            "loads: {{pull: {{on: bob, at: tip, force: [0, 0, 1]}}}}\n{}"
            "branches: {{up: {{load: pull, to: 500, steps: 4}}}}\nprobes: {{tip: {{on: bob, at: tip}}}}\n",
            0.5 + apart, more),
        "linked"));
}

TEST(Extremes, JointsThatContradictEachOtherAreRefusedFromNineDigitsOn) {
    for (const double apart : {0.0, 1e-13, -1e-8, 1e-8, 1e-6, 1e-3}) {
        const Model model = linked(apart);
        for (const Method& method : methods) {
            const auto path = solve(model, model.branches[0], {.method = method});
            EXPECT_EQ(path.outcome,
                      std::abs(apart) < 1e-9 ? Outcome::converged : Outcome::inconsistent_constraints)
                << method.name << " " << apart << path.detail;
        }
    }
}

// The lever of models/extremes/over_centre, whose limit point is at 63.3413 N: the expansions before it are short, and a
// rounding of the load is more than one of their reach.
TEST(Extremes, NoPointOfASeriesIsMissingNextToALimitPoint) {
    const auto lever = [](double to) {
        return compile(parse_scene(
            fmt::format("elastocheck: 1\nname: lever\nunits: {{length: mm, angle: rad, force: N}}\n"
                        "points: {{hinge: [0, 0, 0], tip: [-100, 0, 280], anchor: [0, 0, -300], behind: "
                        "[-500, 0, 280]}}\n"
                        "bodies: {{lever: {{origin: tip}}}}\n"
                        "joints: {{hinge: {{type: revolute, bodies: [lever, ground], at: hinge, axis: y}}}}\n"
                        "springs:\n"
                        "  coil: {{bodies: [lever, ground], from: tip, to: anchor, rate: 100}}\n"
                        "  back: {{bodies: [lever, ground], from: tip, to: behind, rate: 0.1}}\n"
                        "loads: {{pull: {{on: lever, at: tip, force: [1, 0, 0]}}}}\n"
                        "branches: {{pull: {{load: pull, to: {:.17g}, steps: 40}}}}\n"
                        "probes: {{tip: {{on: lever, at: tip}}}}\n",
                        to),
            "lever"));
    };
    int converged = 0;
    for (int k = 0; k < 40; ++k) {
        const Model model = lever(63.3 + 0.001 * k);
        const auto path = solve(model, model.branches[0], {.method = *find_method("series")});
        converged += path.outcome == Outcome::converged;
        EXPECT_EQ(path.points.size() == 41, path.outcome == Outcome::converged)
            << model.branches[0].to << " " << path.points.size() << " " << path.detail;
    }
    EXPECT_GT(converged, 30);
}

// A slider that its load pulls through the point where its spring ends: there the force turns over at once.
TEST(Extremes, ASpringIsNotFollowedThroughALengthOfNothing) {
    const Model model = compile(parse_scene(
        "elastocheck: 1\nname: slider\nunits: {length: m, angle: rad, force: N}\n"
        "points: {seat: [0, 0, 0], top: [0, 0, 0.3]}\nbodies: {slider: {origin: seat}}\n"
        "joints: {guide: {type: translational, bodies: [slider, ground], at: seat, axis: z}}\n"
        "springs: {coil: {bodies: [slider, ground], from: seat, to: top, rate: 20000}}\n"
        "loads: {lift: {on: slider, at: seat, force: [0, 0, 1]}}\n"
        "branches: {lift: {load: lift, to: 100000, steps: 40}}\nprobes: {seat: {on: slider, at: seat}}\n",
        "slider"));
    for (const Method& method : methods)
        EXPECT_NE(solve(model, model.branches[0], {.method = method}).outcome, Outcome::converged)
            << method.name;
}

// A bar on a torsion spring that a moment turns: θ = M / k, up to half a turn, where the law of a rotation ends.
TEST(Extremes, ABushingIsNotFollowedThroughHalfATurn) {
    for (const double to : {300., 320.}) {
        const Model model = compile(parse_scene(
            fmt::format("elastocheck: 1\nname: bar\nunits: {{length: m, angle: rad, force: N, moment: N·m}}\n"
                        "points: {{foot: [0, 0, 0], head: [0, 0, 0.5]}}\nbodies: {{bar: {{origin: head}}}}\n"
                        "joints: {{foot: {{type: revolute, bodies: [bar, ground], at: foot, axis: y}}}}\n"
                        "torsion_springs: {{foot: {{bodies: [bar, ground], at: foot, axis: y, rate: 100}}}}\n"
                        "loads: {{twist: {{on: bar, moment: [0, 1, 0]}}}}\n"
                        "branches: {{twist: {{load: twist, to: {}, steps: 20}}}}\nprobes: {{head: {{on: bar, "
                        "at: head}}}}\n",
                        to),
            "bar"));
        const auto path = solve(model, model.branches[0], {.method = *find_method("series")});
        EXPECT_EQ(path.outcome == Outcome::converged, to < 314) << to << path.detail;
    }
}

}  // namespace
}  // namespace elastocheck::recursive
