// Ill-posed scenes give an outcome instead of a wrong number.
// Nearly redundant or inconsistent joints, limits of the laws, points next to a limit point.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/diagnosis/loops.hpp"

namespace elastocheck::recursive {
namespace {

// A door on two hinges whose axes meet at an angle.
Model door(double skew) {
    return compile(parse_scene(
        fmt::format(
            "elastocheck: 1\nname: door\nunits: {{length: m, angle: rad, force: N, moment: N·m}}\n"
            "points: {{lower: [0, 0, 0], upper: [0, 0, 1], skew: [{:.17g}, 0, 2], handle: [0, 0.8, "
            "0.5]}}\n"
            "bodies: {{door: {{origin: handle}}}}\n"
            "joints:\n"
            "  lower: {{type: revolute, bodies: [door, ground], at: lower, axis: [lower, upper]}}\n"
            "  upper: {{type: revolute, bodies: [door, ground], at: upper, axis: [upper, skew]}}\n"
            "torsion_springs: {{closer: {{bodies: [door, ground], at: lower, axis: z, rate: "
            "200}}}}\n"
            "loads: {{push: {{on: door, at: handle, force: [1, 0, 0]}}}}\n"
            "branches: {{open: {{load: push, to: 200, steps: 4}}}}\nprobes: {{handle: {{on: door, "
            "at: "
            "handle}}}}\n",
            skew),
        "door"));
}

TEST(Extremes, ARankThatCannotBeToldIsSaid) {
    for (const double skew : {0.0, 1e-15, 1e-12, 3e-10, 1e-6}) {
        const Model model = door(skew);
        for (const Method& method : methods) {
            const auto path =
                solve(model, model.branches[0], {.method = method, .error_bound = true});
            const bool in_doubt = skew > 1e-13 && skew < 1e-9;
            EXPECT_EQ(path.outcome, in_doubt ? Outcome::singular : Outcome::converged)
                << method.name << " " << skew << path.detail;
            EXPECT_EQ(
                path.detail.find("joint 'upper' is redundant is undecidable") != std::string::npos,
                in_doubt)
                << path.detail;
            EXPECT_EQ(path.points.empty(), in_doubt) << method.name;
        }
    }
}

// A bob on a ball joint, and a link from its middle to ground that is longer than their distance.
Model linked(double apart, const std::string& more = "") {
    return compile(
        parse_scene(fmt::format("elastocheck: 1\nname: linked\nunits: {{length: m, angle: rad, "
                                "force: N, moment: N·m}}\n"
                                "points: {{ball: [0, 0, 0], wall: [0, 0.5, 0], tip: [0.4, 0, "
                                "0]}}\nbodies: {{bob: {{origin: "
                                "tip}}}}\n"
                                "joints:\n"
                                "  ball: {{type: spherical, bodies: [bob, ground], at: ball}}\n"
                                "  link: {{type: distance, bodies: [bob, ground], from: ball, to: "
                                "wall, length: {:.17g}}}\n"
                                "bushings: {{mount: {{bodies: [bob, ground], at: ball, rates: [0, "
                                "0, 0], rotational_rates: [600, "
                                "600, "
                                "600]}}}}\n"
                                "loads: {{pull: {{on: bob, at: tip, force: [0, 0, 1]}}}}\n{}"
                                "branches: {{up: {{load: pull, to: 500, steps: 4}}}}\nprobes: "
                                "{{tip: {{on: bob, at: tip}}}}\n",
                                0.5 + apart, more),
                    "linked"));
}

TEST(Extremes, JointsThatContradictEachOtherAreRefusedFromNineDigitsOn) {
    for (const double apart : {0.0, 1e-13, -1e-8, 1e-8, 1e-6, 1e-3}) {
        const Model model = linked(apart);
        for (const Method& method : methods) {
            const auto path = solve(model, model.branches[0], {.method = method});
            EXPECT_EQ(path.outcome, std::abs(apart) < 1e-9 ? Outcome::converged
                                                           : Outcome::inconsistent_constraints)
                << method.name << " " << apart << path.detail;
        }
    }
}

// The lever of models/extremes/over_centre has its limit point at 63.3413 N. The expansions before
// it are short, and rounding of the load exceeds the range of some.
TEST(Extremes, NoPointOfASeriesIsMissingNextToALimitPoint) {
    const auto lever = [](double to) {
        return compile(parse_scene(
            fmt::format(
                "elastocheck: 1\nname: lever\nunits: {{length: mm, angle: rad, force: N}}\n"
                "points: {{hinge: [0, 0, 0], tip: [-100, 0, 280], anchor: [0, 0, -300], behind: "
                "[-500, 0, 280]}}\n"
                "bodies: {{lever: {{origin: tip}}}}\n"
                "joints: {{hinge: {{type: revolute, bodies: [lever, ground], at: hinge, axis: "
                "y}}}}\n"
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

// A load pulls a slider through the point where its spring has zero length: the force reverses at
// once.
TEST(Extremes, ASpringIsNotFollowedThroughALengthOfNothing) {
    const Model model = compile(parse_scene(
        "elastocheck: 1\nname: slider\nunits: {length: m, angle: rad, force: N}\n"
        "points: {seat: [0, 0, 0], top: [0, 0, 0.3]}\nbodies: {slider: {origin: seat}}\n"
        "joints: {guide: {type: translational, bodies: [slider, ground], at: seat, axis: z}}\n"
        "springs: {coil: {bodies: [slider, ground], from: seat, to: top, rate: 20000}}\n"
        "loads: {lift: {on: slider, at: seat, force: [0, 0, 1]}}\n"
        "branches: {lift: {load: lift, to: 100000, steps: 40}}\nprobes: {seat: {on: slider, at: "
        "seat}}\n",
        "slider"));
    for (const Method& method : methods)
        EXPECT_NE(solve(model, model.branches[0], {.method = method}).outcome, Outcome::converged)
            << method.name;
}

// A row without moving bodies forms a loop of its own.
TEST(Extremes, ALinkBetweenWhatIsFixedIsHeldAtItsLengthAndAtNoOther) {
    const Model model = compile(parse_scene(R"(
elastocheck: 1
name: a link between what is fixed
units: {length: mm, angle: rad, force: N, moment: N·m}
points: {ball: [0, 0, 0], wall: [0, 500, 0], tip: [400, 0, 0]}
bodies: {block: {origin: wall}, bob: {origin: tip}}
joints:
  weld: {type: fixed, bodies: [block, ground], at: wall}
  link: {type: distance, bodies: [block, ground], from: wall, to: ball}
  ball: {type: spherical, bodies: [bob, ground], at: ball}
bushings: {ball: {bodies: [bob, ground], at: ball, rates: [0, 0, 0], rotational_rates: [600, 600, 600]}}
loads: {pull: {on: bob, at: tip, force: [0, 0, 1]}}
branches:
  kept: {load: pull, to: 500, steps: 4, hold: {joints.link: 0}}
  stretched: {drive: {joints.link: 1}, to: 5, steps: 4}
probes: {tip: {on: bob, at: tip}}
)",
                                            "link.yaml"));
    ASSERT_EQ(model.bodies.size(), 1u);  // the block is ground
    for (const int row : loops(model)) EXPECT_GE(row, 0);
    for (const Method& method : methods) {
        EXPECT_EQ(solve(model, model.branches[0], {.method = method}).outcome, Outcome::converged)
            << method.name;
        EXPECT_EQ(solve(model, model.branches[1], {.method = method}).outcome,
                  Outcome::inconsistent_constraints)
            << method.name;
    }
}

// A rod on a ball joint at the end of a mount, loaded along its axis: nothing resists its rotation
// as drawn.
Model rod(const std::string& held, double to) {
    return compile(parse_scene(fmt::format(R"(
elastocheck: 1
name: rod
units: {{length: mm, angle: rad, force: N, moment: N·m}}
points: {{ball: [0, 0, 0], tip: [400, 0, 0]}}
bodies: {{mount: {{origin: ball}}, rod: {{origin: tip}}}}
joints: {{ball: {{type: spherical, bodies: [rod, mount], at: ball}}}}
bushings: {{seat: {{bodies: [mount, ground], at: ball, rates: [1000, 1000, 1000], rotational_rates: [600, 600, 600]}}}}
{}
loads: {{along: {{on: rod, at: tip, force: [1, 0, 0]}}}}
branches: {{along: {{load: along, to: {}, steps: 8}}}}
probes: {{tip: {{on: rod, at: tip}}}}
)",
                                           held, to),
                               "rod"));
}

TEST(Extremes, ARodThatIsPushedAlongItselfDoesNotStayAndOneThatIsPulledDoes) {
    for (const Method& method : methods) {
        const Model pulled = rod("", 500), pushed = rod("", -500);
        EXPECT_EQ(solve(pulled, pulled.branches[0], {.method = method}).outcome, Outcome::converged)
            << method.name;
        const auto falls =
            solve(pushed, pushed.branches[0], {.method = method, .error_bound = true});
        EXPECT_EQ(falls.outcome, Outcome::bifurcation_point) << method.name << falls.detail;
        EXPECT_LE(falls.points.size(), 1u) << method.name;  // at most the first point
    }
}

TEST(Extremes, WhatStandsOnABallUnderItsWeightBeginsUnstable) {
    const char* const pull = "static_loads: {weight: {on: rod, at: tip, force: [50, 0, 0]}}";
    const char* const push = "static_loads: {weight: {on: rod, at: tip, force: [-50, 0, 0]}}";
    for (const Method& method : methods) {
        const Model hangs = rod(pull, 100), stands = rod(push, 10), falls = rod(pull, -100);
        const auto path = solve(hangs, hangs.branches[0], {.method = method, .error_bound = true});
        EXPECT_EQ(path.outcome, Outcome::converged) << method.name << path.detail;
        const auto none = solve(stands, stands.branches[0], {.method = method});
        EXPECT_EQ(none.outcome, Outcome::singular) << method.name;
        EXPECT_NE(none.detail.find("that settles at 0"), none.detail.npos)
            << method.name << none.detail;
        // Hangs until the load exceeds its weight, at 50 N.
        const auto over = solve(falls, falls.branches[0], {.method = method});
        EXPECT_EQ(over.outcome, Outcome::bifurcation_point) << method.name << over.detail;
        ASSERT_FALSE(over.points.empty());
        EXPECT_NEAR(over.points.back().load, -50, 13) << method.name;
        EXPECT_GE(over.points.back().load, -50 * (1 + 1e-5)) << method.name;
    }
}

}  // namespace
}  // namespace elastocheck::recursive
