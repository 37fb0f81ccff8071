// Pruning and condensation by compile() change no result: a scene as from a CAD model, solved as
// written and as condensed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"

namespace elastocheck {
namespace {

// Five rods as bodies with a ball at each end, one ball duplicated; the knuckle of two welded
// bodies with a redundant joint; a subframe of two bodies on bushings; a bracket welded to ground
// with the spring and an idle appendage; a spring within the subframe.
const std::string as_built = R"(elastocheck: 1
name: as built
units: {length: m, angle: deg, force: N}
points:
  hub: [0, 0.8, 0]
  contact: [0, 0.8, -0.3]
  in_1: [0.15, 0.4, 0.15]
  out_1: [0.02, 0.75, 0.16]
  in_2: [-0.2, 0.4, 0.14]
  out_2: [-0.03, 0.74, 0.15]
  in_3: [0.2, 0.35, -0.12]
  out_3: [0.03, 0.76, -0.15]
  in_4: [-0.25, 0.35, -0.1]
  out_4: [-0.04, 0.76, -0.14]
  in_5: [-0.2, 0.4, -0.02]
  out_5: [-0.15, 0.78, -0.01]
  top: [0, 0.7, 0.5]
  mount: [0.3, 0.3, 0]
  rear_mount: [-0.3, 0.2, 0.1]
bodies:
  wheel: {origin: hub}
  knuckle: {origin: out_2}
  rod_1: {origin: in_1}
  rod_2: {origin: out_2}
  rod_3: {origin: in_3}
  rod_4: {origin: in_4}
  rod_5: {origin: in_5}
  subframe: {origin: mount}
  subframe_rear: {origin: rear_mount}
  bracket: {origin: top}
  cable: {origin: top}
joints:
  inner_1: {type: spherical, bodies: [rod_1, subframe], at: in_1}
  outer_1: {type: spherical, bodies: [rod_1, knuckle], at: out_1}
  inner_2: {type: spherical, bodies: [subframe_rear, rod_2], at: in_2}
  outer_2: {type: spherical, bodies: [knuckle, rod_2], at: out_2}
  inner_3: {type: spherical, bodies: [rod_3, subframe], at: in_3}
  outer_3: {type: spherical, bodies: [wheel, rod_3], at: out_3}
  inner_4: {type: spherical, bodies: [rod_4, subframe_rear], at: in_4}
  again_4: {type: spherical, bodies: [wheel, rod_4], at: out_4}
  outer_4: {type: spherical, bodies: [rod_4, wheel], at: out_4}
  inner_5: {type: spherical, bodies: [rod_5, ground], at: in_5}
  outer_5: {type: spherical, bodies: [rod_5, wheel], at: out_5}
  knuckle: {type: fixed, bodies: [knuckle, wheel], at: out_1}
  once_more: {type: spherical, bodies: [wheel, knuckle], at: contact}
  subframe: {type: fixed, bodies: [subframe_rear, subframe], at: rear_mount}
  foot: {type: fixed, bodies: [bracket, ground], at: top}
  hook: {type: revolute, bodies: [cable, bracket], at: top, axis: x}
springs:
  coil: {bodies: [knuckle, bracket], from: out_2, to: top, rate: 30e3, preload: 2000}
  brace: {bodies: [subframe, subframe_rear], from: mount, to: rear_mount, rate: 30e3, preload: 2000}
bushings:
  mount: {bodies: [subframe, ground], at: mount, rates: [3e6, 2e6, 1e6], rotational_rates: [500, 400, 300]}
  rear_mount:
    {bodies: [bracket, subframe_rear], at: rear_mount, frame: {x: [1, 2, 3], y: [0, 1, 1]},
     rates: [3e6, 2e6, 1e6], rotational_rates: [500, 400, 300], preload: [100, 20, 30]}
static_loads:
  weight: {on: subframe_rear, at: rear_mount, force: [0, 0, -300]}
  torque: {on: knuckle, moment: [10, 20, 5]}
loads:
  up: {on: knuckle, at: contact, force: [0, 0, 1]}
  side: {on: wheel, at: contact, force: [0.3, 1, 0]}
  on_the_bracket: {on: bracket, at: top, force: [0, 0, 1]}
branches:
  up: {load: {up: 1, on_the_bracket: 1}, from: -1500, to: 2500, steps: 40}
  side: {load: side, to: 2000, steps: 20, hold: {travel: 0.02}}
  travel: {drive: travel, to: 0.06, steps: 20, static_loads: {side: 500}}
wheel: {body: wheel, centre: hub, contact_patch: contact, contact: carrier, spin_axis: y, side: left}
probes: {tip: {on: knuckle, at: out_1}}
)";

struct Side {
    const Model& model;
    EquilibriumPath path;

    const Pose& pose(std::size_t point, const std::string& body) const {
        const auto found = std::ranges::find(model.bodies, body, &Body::name);
        return path.points.at(point).poses.at(
            static_cast<std::size_t>(found - model.bodies.begin()));
    }
    double force(std::size_t point, const std::string& joint) const {
        const auto found = std::ranges::find(model.joints, joint, &ModelJoint::name);
        return path.points.at(point)
            .reactions.at(static_cast<std::size_t>(found - model.joints.begin()))
            .force.norm();
    }
};

TEST(Condensed, CompiledModelEqualsTheSceneAsWritten) {
    const Scene scene = parse_scene(as_built, "as_built.yaml");
    const Model small = compile(scene), whole = compile(scene, Detail::everything);
    EXPECT_EQ(small.as_written, (Size{11, 17, 4, 60}));  // with the jack
    EXPECT_EQ(small.as_solved, (Size{2, 6, 3, 6}));
    ASSERT_EQ(small.bodies.at(0).name, "wheel");
    ASSERT_EQ(small.bodies.at(1).name, "subframe");
    double worst = 0, worst_force = 0;
    int compared = 0;
    for (std::size_t b = 0; b < small.branches.size(); ++b)
        for (std::size_t w = 0; w < branch_sides(small.branches[b]).size(); ++w) {
            const Branch way = branch_sides(small.branches[b])[w],
                         whole_way = branch_sides(whole.branches[b])[w];
            std::vector<double> loads;
            for (int k = 0; k <= 6; ++k) loads.push_back(way.to * k / 6);
            const Side s{small, reference::equilibrium::solve(on_branch(small, way), way, loads)};
            const Side l{whole, reference::equilibrium::solve(on_branch(whole, whole_way),
                                                              whole_way, loads)};
            ASSERT_EQ(s.path.outcome, Outcome::converged) << way.name << ": " << s.path.detail;
            ASSERT_EQ(l.path.outcome, Outcome::converged) << way.name << ": " << l.path.detail;
            for (std::size_t k = 0; k < loads.size(); ++k) {
                for (const char* body : {"wheel", "subframe"}) {
                    const Pose &a = s.pose(k, body), &c = l.pose(k, body);
                    const double apart = std::max((a.r - c.r).norm(), a.p.angularDistance(c.p));
                    EXPECT_TRUE(std::isfinite(apart) && apart <= 1e-12)
                        << way.name << " " << k << " " << body;
                    worst = std::max(worst, apart);
                }
                // A rod exerts at both ends the force of its distance constraint.
                for (const int rod : {1, 2, 3, 5})
                    for (const char* end : {"inner", "outer"}) {
                        const double apart = std::abs(s.force(k, fmt::format("rod_{}", rod)) -
                                                      l.force(k, fmt::format("{}_{}", end, rod)));
                        EXPECT_TRUE(std::isfinite(apart) && apart <= 1e-7)
                            << way.name << " " << k << " " << rod;
                        worst_force = std::max(worst_force, apart);
                        ++compared;
                    }
            }
        }
    EXPECT_EQ(compared, 4 * 7 * 8);
    RecordProperty("worst", fmt::format("{:.2g} m or rad, {:.2g} N", worst, worst_force));
}

}  // namespace
}  // namespace elastocheck
