// Gravity as static loads.
#include <gtest/gtest.h>

#include <algorithm>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

const std::string scene_text = fixture("weights");

TEST(Gravity, WeightActsAtTheCentreOfGravityOfEachBody) {
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

TEST(Gravity, MassWithoutGravityIsReported) {
    const Scene scene =
        parse_scene(replaced(scene_text, "gravity: [1, 0, -9.81]\n", ""), "scene.yaml");
    EXPECT_TRUE(scene.static_loads.empty());
    ASSERT_EQ(scene.omitted.size(), 3U);
    EXPECT_EQ(scene.omitted[0].what, "mass of body 'arm_left'");
    EXPECT_EQ(scene.omitted[0].why, "the scene has no gravity");
}

TEST(Gravity, AccelerationIsInMetresPerSecondSquaredInAllUnits) {
    const Scene scene = parse_scene(scene_text, "scene.yaml");
    const auto number = [&](const std::string& path) {
        return std::ranges::find(scene.numbers, path, &Number::path)->unit;
    };
    EXPECT_EQ(number("gravity.z"), "m/s²");
    EXPECT_EQ(number("bodies.beam.mass"), "kg");
}

}  // namespace
}  // namespace elastocheck
