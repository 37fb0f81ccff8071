// Gravity as static loads.
#include <gtest/gtest.h>

#include <algorithm>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/models/mistakes.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

const std::string scene_text = R"(elastocheck: 1
name: weights
units: {length: mm, angle: deg, force: kN}
mirror: left -> right
gravity: [1, 0, -9.81]
points: {arm_left: [0, 500, 0], cg_left: [10, 600, 20], middle: [0, 0, 100], off: [5, 7, 9]}
bodies:
  arm_left: {origin: arm_left, mass: 4, centre_of_gravity: cg_left}
  beam: {origin: middle, mass: 20}
  rack: {origin: middle, mass: 2, centre_of_gravity: off}
  light: {origin: middle}
bushings:
  mount_left: {bodies: [arm_left, beam], at: arm_left, rates: [1, 1, 1], rotational_rates: [1, 1, 1]}
  mount: {bodies: [beam, ground], at: middle, rates: [1, 1, 1], rotational_rates: [1, 1, 1]}
  glue: {bodies: [rack, beam], at: middle, rates: [1, 1, 1], rotational_rates: [1, 1, 1]}
  tape: {bodies: [light, beam], at: middle, rates: [1, 1, 1], rotational_rates: [1, 1, 1]}
loads: {push: {on: beam, at: middle, force: [0, 0, 1]}}
branches: {up: {load: push, to: 1, steps: 1}}
probes: {tip: {on: beam, at: middle}}
)";

TEST(Gravity, EveryBodyWithAMassHangsOnItsCentreOfGravity) {
    const Scene scene = parse_scene(scene_text, "scene.yaml");
    struct Weight {
        const char *name, *body;
        double mass;
        Vector3d at;
    };
    const Weight weights[] = {{"gravity.arm_left", "arm_left", 4, {0.01, 0.6, 0.02}},
                              {"gravity.arm_right", "arm_right", 4, {0.01, -0.6, 0.02}},
                              {"gravity.beam", "beam", 20, {0, 0, 0.1}},
                              {"gravity.rack", "rack", 2, {0.005, 0.007, 0.009}}};
    ASSERT_EQ(scene.static_loads.size(), std::size(weights));
    for (std::size_t k = 0; k < std::size(weights); ++k) {
        const Load& load = scene.static_loads[k];
        EXPECT_EQ(load.name, weights[k].name);
        const auto& force = std::get<DeadForce>(load.kind);
        const Body& body = scene.bodies.at(static_cast<std::size_t>(force.at.body));
        EXPECT_EQ(body.name, weights[k].body);
        EXPECT_LE((body.design.r + force.at.s_local - weights[k].at).norm(), 1e-15) << load.name;
        EXPECT_LE((force.f - weights[k].mass * Vector3d(1, 0, -9.81)).norm(), 1e-13) << load.name;
    }
    EXPECT_EQ(compile(scene).static_loads.size(), std::size(weights));
}

TEST(Gravity, AMassWithoutGravityIsNamed) {
    const Scene scene =
        parse_scene(replaced(scene_text, "gravity: [1, 0, -9.81]\n", ""), "scene.yaml");
    EXPECT_TRUE(scene.static_loads.empty());
    ASSERT_EQ(scene.omitted.size(), 3U);
    EXPECT_EQ(scene.omitted[0].what, "mass of body 'arm_left'");
    EXPECT_EQ(scene.omitted[0].why, "the scene has no gravity");
}

TEST(Gravity, IsInMetresPerSecondSquaredWhateverTheUnits) {
    const Scene scene = parse_scene(scene_text, "scene.yaml");
    const auto number = [&](const std::string& path) {
        return std::ranges::find(scene.numbers, path, &Number::path)->unit;
    };
    EXPECT_EQ(number("gravity.z"), "m/s²");
    EXPECT_EQ(number("bodies.beam.mass"), "kg");
}

TEST(Gravity, SaysWhatIsWrong) {
    expect_complaints(
        scene_text,
        {{"[1, 0, -9.81]", "[1, 0.1, -9.81]",
          "gravity: has a y component, which is not symmetric; allowed in a scene with a mirror: "
          "[x, 0, z]"},
         {"[1, 0, -9.81]", "-9.81", "gravity: expected a list of 3 numbers, found '-9.81'"},
         {"mass: 20", "mass: -20", "bodies.beam.mass: negative mass '-20'; allowed: zero or more"},
         {"mass: 2, ", "",
          "bodies.rack.centre_of_gravity: centre of gravity of a body without mass; give its mass "
          "or remove this field"},
         {"loads:",
          "static_loads: {gravity.beam: {on: beam, at: middle, force: [0, 0, 1]}}\nloads:",
          "bodies.beam: the load name 'gravity.beam' is reserved for its weight, but already in "
          "use; rename the other load"}});
    std::string text = scene_text;
    for (const char* mass :
         {"mass: 4, centre_of_gravity: cg_left", "mass: 20", "mass: 2, centre_of_gravity: off"})
        text = replaced(text, std::string(", ") + mass, "");
    EXPECT_EQ(complaint_of(text), "gravity: has no effect: no body has a mass");
}

}  // namespace
}  // namespace elastocheck
