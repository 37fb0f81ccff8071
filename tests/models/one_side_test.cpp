// Numbers of one side alone under a mirror: that side follows its own, the other and what both share
// stay, and both together are the number of both.
#include <gtest/gtest.h>

#include <algorithm>

#include "elastocheck/read_scene.hpp"
#include "models/kinds.hpp"
#include "models/reader/document/text_file.hpp"
#include "models/reader/parsed_scene.hpp"

namespace elastocheck {
namespace {

const std::string file = std::string(ELASTOCHECK_SCENES) + "/front_axle.yaml";

Scene axle(const std::vector<Setting>& settings) { return read_scene(file, settings); }

Vector3 point(const Scene& scene, const std::string& name) {
    return std::ranges::find(scene.hardpoints, name, &Hardpoint::name)->position;
}
const Elastic& element(const Scene& scene, const std::string& name) {
    return *std::ranges::find(scene.elastics, name, &Elastic::name);
}
double rate(const Scene& scene, const std::string& spring) {
    return std::get<LinearRate>(std::get<AxialSpring>(element(scene, spring).kind).law).k;
}
double free_length(const Scene& scene, const std::string& spring) {
    return std::get<AxialSpring>(element(scene, spring).kind).free_length;
}
// Positions, levers and lengths of the scene.
std::vector<double> as_drawn(const Scene& scene) {
    std::vector<double> all;
    const auto add = [&](const Vector3& v) { all.insert(all.end(), v.begin(), v.end()); };
    for (const Hardpoint& one : scene.hardpoints) add(one.position);
    for (const Body& one : scene.bodies) add(one.design.r);
    for (const Wheel& one : scene.wheels) add(one.centre_local), add(one.contact.s_local);
    for (const Elastic& one : scene.elastics) {
        for (const Point& end : points_of(one.kind)) add(end.s_local);
        if (const auto* spring = std::get_if<AxialSpring>(&one.kind))
            all.push_back(spring->free_length);
    }
    for (const Joint& joint : scene.joints)
        if (const auto* rod = std::get_if<Distance>(&joint.kind)) all.push_back(rod->length);
    return all;
}

TEST(OneSide, HardpointOfOneSideMovesOnlyThatSide) {
    const Scene drawn = axle({}), right = axle({{"points.tie_rod_inner_left.z@right", "0.011"}});
    EXPECT_EQ(point(right, "tie_rod_inner_left").z(), 0.001);
    EXPECT_EQ(point(right, "tie_rod_inner_right").z(), 0.011);
    EXPECT_EQ(point(right, "tie_rod_inner_right").y(), -0.596);
    const auto length = [](const Scene& scene, const std::string& rod) {
        return std::get<Distance>(std::ranges::find(scene.joints, rod, &Joint::name)->kind).length;
    };
    EXPECT_EQ(length(right, "tie_rod_left"), length(drawn, "tie_rod_left"));
    EXPECT_NE(length(right, "tie_rod_right"), length(drawn, "tie_rod_right"));
    const Scene left = axle({{"points.tie_rod_inner_left.z@left", "0.011"}});
    EXPECT_EQ(length(right, "tie_rod_right"), length(left, "tie_rod_left")) << "the mirror image";
}

TEST(OneSide, ChangingBothSidesEqualsChangingTheSharedNumber) {
    for (const auto& [path, value] : std::vector<std::pair<std::string, std::string>>{
             {"points.lower_ball_left.y", "0.905"},
             {"points.bar_end_left.z", "-0.07"},
             {"springs.coil_left.preload", "7000"},
             {"points.wheel_centre_left.x", "-0.05"}}) {
        const auto both = as_drawn(axle({{path, value}})),
                   each = as_drawn(axle({{path + "@left", value}, {path + "@right", value}}));
        EXPECT_EQ(both, each) << path;
        EXPECT_NE(both, as_drawn(axle({{path + "@left", value}}))) << path;
    }
}

TEST(OneSide, NumbersOfASpringOnOneSideAreSetListedAndRewrittenAlone) {
    const Scene scene = axle(
        {{"springs.coil_left.rate@left", "80e3"}, {"springs.coil_left.preload@right", "5000"}});
    EXPECT_EQ(rate(scene, "coil_left"), 80e3);
    EXPECT_EQ(rate(scene, "coil_right"), 95e3);
    EXPECT_NE(free_length(scene, "coil_left"), free_length(scene, "coil_right"));
    const auto numbers = find_number(scene, "springs.coil_left.rate@left");
    ASSERT_TRUE(numbers);
    EXPECT_EQ(numbers->value, 80e3);
    EXPECT_EQ(find_number(scene, "springs.coil_left.rate@right")->value, 95e3);
    EXPECT_FALSE(find_number(scene, "springs.coil_left.rate@middle"));
    EXPECT_FALSE(find_number(scene, "points.rack.z@left")) << "both sides share it";

    const std::string text = reader::read_text(file, reader::Pipes::allowed).text;
    const std::string written = rewrite_scene(
        text, "axle.yaml", std::vector<Setting>{{"springs.coil_left.rate@right", "70e3"}});
    EXPECT_EQ(rate(parse_scene(written, "axle.yaml"), "coil_right"), 70e3);
    EXPECT_EQ(rate(parse_scene(written, "axle.yaml"), "coil_left"), 95e3);
    const std::string again = rewrite_scene(
        written, "axle.yaml",
        std::vector<Setting>{{"springs.coil_left.rate@right", "60e3"}, {"points.rack.z", "0.002"}});
    EXPECT_EQ(rate(parse_scene(again, "axle.yaml"), "coil_right"), 60e3);
}

TEST(OneSide, VariedSceneEqualsReadingItWithSettings) {
    const std::string text = reader::read_text(file, reader::Pipes::allowed).text;
    const reader::ParsedScene parsed(text, "axle.yaml", std::nullopt);
    reader::VariedScene varied(parsed,
                               {"points.upper_ball_left.z@right", "springs.coil_left.rate"});
    for (const double z : {0.25, 0.26}) {
        const double values[] = {z, 90e3};
        const Scene fast = varied.read(values), slow = parsed.read(std::vector<Setting>{
                                                    setting("points.upper_ball_left.z@right", z),
                                                    {"springs.coil_left.rate", "90e3"}});
        EXPECT_EQ(as_drawn(fast), as_drawn(slow));
        EXPECT_EQ(point(fast, "upper_ball_right").z(), z);
        EXPECT_EQ(rate(fast, "coil_right"), 90e3);
    }
}

TEST(OneSide, RepeatedReadingKeepsTheSettingsOfOtherNumbers) {
    const std::string text = reader::read_text(file, reader::Pipes::allowed).text;
    const reader::ParsedScene parsed(text, "axle.yaml", std::nullopt);
    const std::vector<Setting> others{{"points.upper_ball_left.z@right", "0.27"}};
    const std::vector<double> fine{90e3}, wrong{-1};
    reader::VariedScene varied(parsed, {"springs.coil_left.rate"}, others);
    std::vector<Setting> all = others;
    all.push_back({"springs.coil_left.rate", "90e3"});
    EXPECT_EQ(as_drawn(varied.read(fine)), as_drawn(parsed.read(all)));
    EXPECT_EQ(point(varied.read(fine), "upper_ball_right").z(), 0.27);
    const auto message = [](const auto& read) {
        try {
            (void)read();
        } catch (const SceneError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    all.back().value = "-1";
    EXPECT_EQ(message([&] { return varied.read(wrong); }),
              message([&] { return parsed.read(all); }));
}

}  // namespace
}  // namespace elastocheck
