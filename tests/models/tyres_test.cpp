// Tyres: a vertical rate at the contact patch, and the road height as driver.
#include <gtest/gtest.h>

#include <algorithm>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "models/laws.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

// Two wheels, each on a suspension of one spring rate.
const std::string axle = fixture("tyres"), single = fixture("tyre");

const Bushing& tyre(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.elastics, name, &Elastic::name);
    EXPECT_NE(found, scene.elastics.end());
    EXPECT_TRUE(found->active_only_where_driven);
    return std::get<Bushing>(found->kind);
}

const Curve& law_of(const Bushing& b) {
    return std::get<Curve>(std::get<PerAxis>(b.law).axis.at(2));
}

// Upward force of the tyre for a rise z of the patch and h of the road, on a branch that
// drives the road.
double push(const Scene& scene, const Driver& driver, double z, double h) {
    const auto& road = std::get<FreeLength>(driver.what);
    const auto& b =
        std::get<Bushing>(scene.elastics.at(static_cast<std::size_t>(road.elastic)).kind);
    EXPECT_TRUE(b.preload.isZero(0));
    return -force(law_of(b), z - b.undeformed.z() - driver.rate * h);
}

TEST(Tyre, PushesTheWheelUpByItsPreloadAndItsRateTimesTheHeightOfTheRoad) {
    const Scene scene = parse_scene(axle, "scene.yaml");
    for (const Driver& driver : scene.branches.at(0).drivers) {
        EXPECT_DOUBLE_EQ(push(scene, driver, 0, 0), 3500);
        EXPECT_DOUBLE_EQ(push(scene, driver, 0, 0.01), 3500 + 200e3 * 0.01);
        EXPECT_DOUBLE_EQ(push(scene, driver, 0.01, 0), 3500 - 200e3 * 0.01);
        EXPECT_DOUBLE_EQ(push(scene, driver, 0.01, 0.01), 3500);
        EXPECT_DOUBLE_EQ(push(scene, driver, 0.02, 0), 0);
    }
    EXPECT_EQ(scene.branches.at(0).unit, ParameterUnit::metre);
    EXPECT_DOUBLE_EQ(scene.branches.at(0).to, 0.05);
}

TEST(Tyre, ActsAtTheContactPatchOfItsWheel) {
    const Scene scene = parse_scene(axle, "scene.yaml");
    for (const double side : {+1.0, -1.0}) {
        const Bushing& b = tyre(scene, side > 0 ? "tyre_left" : "tyre_right");
        EXPECT_EQ(b.i.body, ground);
        EXPECT_LE((b.i.s_local - Vector3d(0.005, side * 0.71, 0)).norm(), 1e-15);
        EXPECT_LE((b.j.s_local - Vector3d(0.005, side * 0.01, -0.3)).norm(), 1e-15);
        EXPECT_EQ(b.j.body, scene.wheels.at(side > 0 ? 0 : 1).body);
        EXPECT_EQ(scene.wheels.at(side > 0 ? 0 : 1).tyre_rate, 200e3);
    }
    const Scene one = parse_scene(single, "scene.yaml");
    EXPECT_EQ(one.wheels.at(0).tyre_rate, 200e3);
    EXPECT_EQ(tyre(one, "tyre").i.s_local, Vector3d(0, 0.7, 0.3));
}

TEST(Tyre, IsActiveOnlyOnBranchesThatMoveItsRoad) {
    const Model model = compile(parse_scene(axle, "scene.yaml"));
    for (const Branch& branch : model.branches) {
        const Model here = on_branch(model, branch);
        for (const Elastic& elastic : here.elastics)
            if (elastic.name.starts_with("tyre")) {
                const bool is_away = elastocheck::is_zero(std::get<Bushing>(elastic.kind).law);
                EXPECT_EQ(is_away, branch.name == "load") << branch.name;
            }
    }
}

TEST(Tyre, IsActiveOnABranchThatHoldsItsRoad) {
    const Scene scene = parse_scene(
        replaced(single, "branches: {bump: {drive: tyres.tyre.road, to: 0.05, steps: 5}}",
                 "loads: {push: {on: hub, at: hub, force: [0, 0, 1]}}\n"
                 "branches: {up: {load: push, to: 50, steps: 5, hold: {tyres.tyre.road: 0}}}"),
        "scene.yaml");
    for (const Detail detail : {Detail::required, Detail::everything}) {
        const Model model = compile(scene, detail);
        const Model here = on_branch(model, model.branches.at(0));
        const auto tyre = std::ranges::find(here.elastics, "tyre", &Elastic::name);
        ASSERT_NE(tyre, here.elastics.end());
        EXPECT_EQ(law_of(std::get<Bushing>(tyre->kind)).pieces.at(0)[1], 200e3);
    }
}

}  // namespace
}  // namespace elastocheck
