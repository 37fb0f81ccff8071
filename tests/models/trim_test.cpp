// The trim of a scene file: adjustments, conditions, loads.
#include <gtest/gtest.h>

#include <numbers>

#include "elastocheck/read_scene.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

const std::string scene_text = fixture("trimmed");

Scene with(const std::string& right, const std::string& wrong) {
    return parse_scene(replaced(scene_text, right, wrong), "scene.yaml");
}

TEST(Trim, AdjustmentsAreTheQuantitiesThatBranchesDrive) {
    const Scene scene = parse_scene(scene_text, "scene.yaml");
    ASSERT_TRUE(scene.trim.has_value());
    const Trim& trim = *scene.trim;
    EXPECT_EQ(trim.line, 19);
    ASSERT_EQ(trim.adjust.size(), 2U);
    EXPECT_EQ(trim.adjust[0].name, "springs.coil.preload");
    EXPECT_EQ(std::get<FreeLength>(trim.adjust[0].what).elastic, 0);
    EXPECT_EQ(trim.adjust[0].unit, ParameterUnit::newton);
    EXPECT_DOUBLE_EQ(trim.adjust[0].per_unit, 1 / 40e6);  // ΔP = k Δℓ₀
    EXPECT_EQ(std::get<Motion>(trim.adjust[1].what).joint, 2);
    EXPECT_EQ(trim.adjust[1].unit, ParameterUnit::metre);
    EXPECT_EQ(trim.adjust[1].per_unit, 1);
    const Scene held =
        with("[springs.coil.preload, joints.rod]", "[joints.slide, bushings.mount.preload.y]");
    const auto& drive = std::get<Motion>(held.trim->adjust.at(0).what);
    EXPECT_EQ(held.joints.at(static_cast<std::size_t>(drive.joint)).name, "slide.drive");
    EXPECT_EQ(std::get<Preload>(held.trim->adjust.at(1).what).direction, Vector6(Vector6::Unit(1)));
}

TEST(Trim, ConditionsAreInTheUnitsOfTheScene) {
    const Scene scene = parse_scene(scene_text, "scene.yaml");
    const auto& until = scene.trim->until;
    ASSERT_EQ(until.size(), 2U);
    EXPECT_EQ(until[0].name, "travel");
    EXPECT_EQ(std::get<WheelTravel>(until[0].what).wheel, 0);
    EXPECT_EQ(until[0].value, 0.005);
    EXPECT_EQ(std::get<ProbeCoordinate>(until[1].what).axis, 1);
    EXPECT_EQ(until[1].value, -0.007);
    const Scene angles = with("{travel: 5, tip.y: -7}", "{toe: 0.1, camber: -1}");
    EXPECT_TRUE(std::holds_alternative<WheelToe>(angles.trim->until.at(0).what));
    EXPECT_DOUBLE_EQ(angles.trim->until.at(0).value.value(), 0.1 * std::numbers::pi / 180);
    EXPECT_TRUE(std::holds_alternative<WheelCamber>(angles.trim->until.at(1).what));
}

TEST(Trim, ListedConditionsKeepTheDesignValues) {
    for (const char* list : {"[travel, toe]", "[toe, tip.x]"}) {
        const Scene scene = with("{travel: 5, tip.y: -7}", list);
        for (const auto& condition : scene.trim->until)
            EXPECT_FALSE(condition.value.has_value()) << list;
    }
}

TEST(Trim, ItsLoadsAreHeldOnEveryBranch) {
    const Scene scene = parse_scene(scene_text, "scene.yaml");
    ASSERT_EQ(scene.static_loads.size(), 2U);
    EXPECT_EQ(scene.static_loads[0].name, "push");
    EXPECT_EQ(std::get<DeadForce>(scene.static_loads[0].kind).f, Vector3d(0, 0, 3500));
    EXPECT_EQ(std::get<DeadMoment>(scene.static_loads[1].kind).m, Vector3d(0, 2, 0));  // kN·mm
    EXPECT_TRUE(scene.omitted.empty()) << scene.omitted[0].what;
    EXPECT_TRUE(with("  under: {push: 3.5, twist: 2}\n", "").static_loads.empty());
    EXPECT_EQ(
        std::get<DeadForce>(with("{push: 3.5, twist: 2}", "[push]").static_loads.at(0).kind).f,
        Vector3d(0, 0, 1000));
}

TEST(Trim, ConditionNamesOneOfSeveralWheels) {
    std::string text = replaced(scene_text, "wheel: {body: hub,", "wheels:\n  front: {body: hub,");
    text = replaced(replaced(text, "{travel: 5, tip.y: -7}", "[front.travel, front.toe]"),
                    "{tyre: {rate", "{tyre: {wheel: front, rate");
    EXPECT_EQ(parse_scene(text, "scene.yaml").trim->until.at(1).name, "front.toe");
}

}  // namespace
}  // namespace elastocheck
