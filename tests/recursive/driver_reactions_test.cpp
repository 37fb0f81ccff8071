// Joint reactions on driven branches, against the equilibrium leg: every kind of driver with every
// method that converges to the true equilibrium. A driven length or angle changes the lines along
// which the multipliers act; an error in that term need not appear in the positions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "models/branch.hpp"

namespace elastocheck::recursive {
namespace {

struct Kind {
    const char* name;
    const char* branch;
    const char* hinge = "revolute";
    const char* rack = "fixed, bodies: [rack, ground], at: inner";
    const char* joint = "";
    const char* tyre = "";
};
constexpr Kind kinds[] = {
    {"force", "load: force, to: 1500"},
    {"moment", "load: moment, to: 300000"},
    {"force that follows", "load: thrust, to: 1500"},
    {"length of a distance", "drive: joints.rod, to: 15"},
    {.name = "offset of a plane",
     .branch = "drive: joints.plane, to: -25",
     .joint = "  plane: {type: in_plane, bodies: [knuckle, ground], at: centre, normal: [0.1, 0.2, "
              "1]}\n"},
    {"angle of a revolute", "drive: joints.hinge, to: 6"},
    {"angle of a cylindrical", "drive: joints.hinge, to: 6", "cylindrical"},
    {"travel of a rack", "drive: joints.rack, to: 20", "revolute",
     "translational, bodies: [rack, ground], at: inner, axis: y"},
    {"free length of a spring", "drive: springs.coil.free_length, to: 20"},
    {"preload of a spring", "drive: springs.coil.preload, to: 800"},
    {"preload of a bushing", "drive: bushings.mount.preload.y, to: 800"},
    {"moment in a bushing", "drive: bushings.mount.preload_moment.z, to: 80000"},
    {"moment in a torsion spring", "drive: torsion_springs.bar.preload_moment, to: 100000"},
    {"travel of the wheel", "drive: travel, to: 40"},
    {"travel of the contact patch", "drive: patch_travel, to: 40"},
    {"length and held travel, angle and load",
     "drive: joints.rod, to: 15, hold: {travel: 30, springs.coil.free_length: 8}"},
    {.name = "road under a tyre",
     .branch = "drive: tyres.t.road, to: 30",
     .tyre = "tyres: {t: {rate: 200, preload: 8000}}\n"},
};

// An arm, a knuckle and a rod to a rack, with weight and preload at the start of the branch;
// bushings resist the remaining motions.
Model driven(const Kind& kind) {
    const std::string text = fmt::format(
        R"(
elastocheck: 1
name: driven
units: {{length: mm, angle: deg, force: N}}
points:
  o: [0, 0, 0]
  ball: [20, 300, -20]
  inner: [-100, 60, 40]
  outer: [-90, 290, 60]
  low: [10, 150, -10]
  high: [30, 120, 320]
  top: [0, 240, 380]
  centre: [10, 340, 40]
  patch: [10, 350, -260]
bodies: {{arm: {{origin: o}}, knuckle: {{origin: ball}}, rack: {{origin: inner}}}}
joints:
  hinge: {{type: {}, bodies: [arm, ground], at: o, axis: [1, 0.1, 0.05]}}
  ball: {{type: spherical, bodies: [knuckle, arm], at: ball}}
  rod: {{type: distance, bodies: [knuckle, rack], from: outer, to: inner}}
  rack: {{type: {}}}
{}springs:
  coil: {{bodies: [arm, ground], from: low, to: high, rate: 40, preload: 2500}}
torsion_springs:
  bar: {{bodies: [arm, ground], at: o, axis: x, rate: 2000}}
bushings:
  front: {{bodies: [arm, ground], at: o, frame: {{z: [1, 0.1, 0.05]}}, rates: [0, 0, 800], rotational_rates: [0, 0, 0]}}
  mount: {{bodies: [ground, knuckle], at: top, rates: [60, 80, 10], rotational_rates: [4000, 3000, 2000]}}
{}static_loads: {{weight: {{on: knuckle, at: patch, force: [200, 400, 2000]}}}}
loads:
  force: {{on: knuckle, at: patch, force: [0.3, 0.5, 1]}}
  moment: {{on: knuckle, moment: [0.2, 0.1, 0.3]}}
  thrust: {{on: knuckle, at: patch, force: [0.3, 0.5, 1], follows: true}}
wheel: {{body: knuckle, centre: centre, contact_patch: patch, contact: carrier, spin_axis: y, side: left}}
branches: {{b: {{{}, steps: 4}}}}
)",
        kind.hinge, kind.rack, kind.joint, kind.tyre, kind.branch);
    return compile(parse_scene(text, "driven.yaml"));
}

// Largest difference of joint forces, and of moments over 0.3 m, and the largest such value [N].
struct Difference {
    double most = 0, of = 0;
};
Difference difference(const std::vector<Equilibrium>& found,
                      const std::vector<Equilibrium>& truth) {
    constexpr double lever = 0.3;
    Difference all;
    for (std::size_t k = 0; k < truth.size(); ++k)
        for (std::size_t j = 0; j < truth[k].reactions.size(); ++j) {
            const Wrench &one = found[k].reactions[j], &other = truth[k].reactions[j];
            all.most = std::max({all.most, (one.force - other.force).norm(),
                                 (one.moment - other.moment).norm() / lever});
            all.of = std::max({all.of, other.force.norm(), other.moment.norm() / lever});
        }
    return all;
}

// Tolerance of a method's reactions with `steps` steps, as a fraction of the largest reaction.
struct Rung {
    const char* name;
    int steps;
    double share;
};
constexpr Rung rungs[] = {{"tangent", 400, 2e-5},
                          {"chord", 400, 1e-7},
                          {"midpoint", 400, 1e-6},
                          {"adaptive", 4, 1e-6},
                          {"series", 4, 1e-10}};

TEST(Driver, ReactionsUnderEveryDriverEqualThoseOfTheEquilibriumLeg) {
    for (const Kind& kind : kinds) {
        const Model whole = driven(kind);
        const Branch& branch = whole.branches[0];
        const Model model = on_branch(whole, branch);
        std::vector<double> points;
        for (int k = 0; k <= 4; ++k) points.push_back(branch.to * k / 4);
        const auto truth = reference::equilibrium::solve(model, branch, points);
        ASSERT_EQ(truth.outcome, Outcome::converged) << kind.name << ": " << truth.detail;
        for (const Rung& rung : rungs) {
            Method method = find_method(rung.name).value();
            if (auto* adaptive = std::get_if<Adaptive>(&method.kind)) *adaptive = {1e-9, 1e-9};
            const auto path =
                solve(model, branch, {.method = method, .steps = rung.steps, .record = 4});
            ASSERT_EQ(path.outcome, Outcome::converged)
                << kind.name << ", " << rung.name << ": " << path.detail;
            const Difference off = difference(path.points, truth.points);
            EXPECT_GE(off.of, 1000) << kind.name;
            EXPECT_LE(off.most, rung.share * off.of) << kind.name << ", " << rung.name;
        }
    }
}

}  // namespace
}  // namespace elastocheck::recursive
