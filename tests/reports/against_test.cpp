// Two variants: what differs is named with both values, what does not is left out.
#include "reports/document/against.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "compare/outputs/curve.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "reports/page/sections.hpp"
#include "tests/reports/command.hpp"
#include "tests/reports/result.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

SceneAnalyses solved(const std::string& name, std::vector<Setting> settings = {}) {
    const Scene read = read_scene(std::string(ELASTOCHECK_SCENES) + "/" + name + ".yaml", settings);
    SceneAnalyses scene{.scene = read, .model = compile(read)};
    compare::Options options;
    options.recursion.steps = 8;
    options.prove = false;
    add_comparison(scene, compare::compare(scene.model, options));
    return scene;
}
const SceneAnalyses& base() {
    static const SceneAnalyses once = solved("chrono_mcpherson_travel");
    return once;
}
const SceneAnalyses& variant() {
    static const SceneAnalyses once = [] {
        SceneAnalyses made =
            solved("chrono_mcpherson_travel", {{"points.tie_rod_inner.z", "-0.053"}});
        made.scene.name = "Higher rack";
        return made;
    }();
    return once;
}

TEST(SceneDifferences, SceneHasNoDifferencesFromItself) {
    const Against none = differences(base(), base());
    EXPECT_TRUE(none.numbers.empty() && none.figures.empty());
    EXPECT_TRUE(none.only_base.empty() && none.only_variant.empty());
    EXPECT_EQ(none.branches.size(), base().comparison.branches.size());
    for (const auto& branch : none.branches) EXPECT_TRUE(branch.curves.empty()) << branch.name;
}

TEST(SceneDifferences, ContainTheNumberThatDiffersAndTheFiguresThatItMoved) {
    const Against found = differences(base(), variant());
    ASSERT_EQ(found.numbers.size(), 1u);
    EXPECT_EQ(found.numbers[0].is->path, "points.tie_rod_inner.z");
    EXPECT_EQ(found.numbers[0].is->value, -0.053);
    EXPECT_GT(found.figures.front().noticed, 10);
    EXPECT_TRUE(std::ranges::is_sorted(found.figures, std::greater{}, &Against::Figure::noticed))
        << "first what an engineer notices most";
    const auto value = [](const SceneAnalyses& scene, const char* output) {
        const auto& curve = scene.comparison.branches[0].run(compare::Leg::equilibrium).curve;
        return curve.values[curve.start][channel_of(scene, output)];
    };
    const auto figure = [&](const char* output) {
        const auto at = std::ranges::find(found.figures, output, &Against::Figure::output);
        EXPECT_NE(at, found.figures.end()) << output;
        return *at;
    };
    for (const char* output : {"bump_steer", "bump_camber", "wheel_rate", "side_view_swing_arm"}) {
        EXPECT_EQ(figure(output).base, value(base(), output));
        EXPECT_EQ(figure(output).variant, value(variant(), output));
    }
    // a swing arm is compared by its reciprocal
    const auto arm = figure("side_view_swing_arm");
    EXPECT_EQ(arm.unit_of_difference, "1/m");
    EXPECT_NEAR(arm.difference, 1e3 / arm.variant - 1e3 / arm.base, 1e-12);
    // and over the branches on the same axis
    const auto toe = std::ranges::find(found.branches[0].curves, "toe", &Against::Curve::output);
    ASSERT_NE(toe, found.branches[0].curves.end());
    double largest = 0;
    EXPECT_EQ(toe->base.a, toe->variant.a);
    for (std::size_t k = 0; k < toe->base.y.size(); ++k)
        largest = std::max(largest, std::abs(toe->variant.y[k] - toe->base.y[k]));
    EXPECT_NEAR(std::abs(toe->largest), largest, 1e-9);
    EXPECT_GT(largest, 0.01);
}

TEST(SceneDifferences, ScenesWithDifferentStepsAreComparedAtEqualParameter) {
    SceneAnalyses coarse = base();  // every second point of each branch, by the same solution
    for (auto& branch : coarse.comparison.branches)
        truth_of(branch) = compare::thinned(truth_of(branch), 2);
    for (const auto& branch : differences(coarse, base()).branches)
        for (const auto& curve : branch.curves)
            EXPECT_LT(std::abs(curve.largest), 1e-2)
                << branch.name << curve.output;  // interpolation between 80 mm / 4
}

TEST(SceneDifferences, BranchOrChannelOfOneSceneOnlyIsNamed) {
    SceneAnalyses other = variant();
    other.comparison.branches[0].branch = "Ride";
    other.comparison.channels[0].name = "hub_x";
    const Against found = differences(base(), other);
    EXPECT_EQ(found.only_base.size(), 2u);
    EXPECT_EQ(found.only_variant, (std::vector<std::string>{"output hub_x", "branch Ride"}));
}

TEST(SceneDifferences, SectionDrawsBothScenesWithoutAVerdict) {
    SceneAnalyses scene = base();
    scene.against = differences(base(), variant());
    const auto section = against_section(scene);
    ASSERT_TRUE(section);
    EXPECT_EQ(section->mark, Mark::none);
    EXPECT_EQ(section->title, "Differences of Higher rack");
    ASSERT_EQ(section->figures.size(), 1u);
    for (const auto& figure : section->figures[0].figures) {
        ASSERT_EQ(figure.series.size(), 2u) << figure.title;
        EXPECT_GT(figure.series[0].rows.size(), 4u) << figure.title;
        EXPECT_EQ(figure.series[0].rows.size(), figure.series[1].rows.size()) << figure.title;
    }
    ASSERT_GE(section->tables.size(), 2u);
    EXPECT_EQ(section->tables[0].rows[0][0], compare::Cell("points.tie_rod_inner.z"));
    EXPECT_GT(section->tables[1].rows.size(), 5u);
    // variants of one scene have its name
    SceneAnalyses twin = scene;
    twin.against->name = scene.scene.name, twin.against->source = "cars/stiffer.yaml";
    const auto named = against_section(twin);
    EXPECT_EQ(named->title, "Differences of stiffer.yaml");
    expect_parts(named->figures[0].caption, {"Thin line: stiffer.yaml."});
    EXPECT_FALSE(against_section(base()));
    EXPECT_EQ(sections_of(scene).front().id, "against") << "the page begins with it";
    expect_parts(against_sentence("a.yaml", *scene.against),
                 {" against a.yaml: 1 number of the scene and ",
                  "differ, most " + scene.against->figures[0].output + " ["});
}

}  // namespace
}  // namespace elastocheck::reports
