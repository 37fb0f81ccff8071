// Two variants: what differs is named with both values, what does not is left out.
#include "reports/document/against.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "reports/document/document.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/page/sections.hpp"
#include "tests/reports/command.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

// A solved document as read from result.json.
json solved(const std::string& name, std::vector<Setting> settings = {}) {
    const Scene scene =
        read_scene(std::string(ELASTOCHECK_SCENES) + "/" + name + ".yaml", settings);
    const Model model = compile(scene);
    compare::Options options;
    options.recursion.steps = 8;
    options.prove = false;
    const auto comparison = compare::compare(model, options);
    json part = scene_document(scene, "", model);
    add_comparison(part, scene, model, comparison);
    add_verdict(part, comparison.compared, {});
    return json::parse(part.dump());
}
const json& base() {
    static const json once = solved("chrono_mcpherson_travel");
    return once;
}
const json& variant() {
    static const json once = [] {
        json made = solved("chrono_mcpherson_travel", {{"points.tie_rod_inner.z", "-0.053"}});
        made["name"] = "Higher rack";
        return made;
    }();
    return once;
}
json against(const json& was, const json& is) {
    json with = was;
    add_against(with, is);
    return with["against"];
}
const json* named(const json& list, const char* key, const std::string& name) {
    for (const auto& one : list)
        if (one[key] == name) return &one;
    return nullptr;
}

TEST(Against, ASceneHasNoDifferenceFromItself) {
    const json none = against(base(), base());
    for (const char* key : {"numbers", "figures", "only_base", "only_variant"})
        EXPECT_TRUE(none[key].empty()) << key << none[key];
    EXPECT_EQ(none["branches"].size(), base()["branches"].size());
    for (const auto& branch : none["branches"]) EXPECT_TRUE(branch["curves"].empty()) << branch;
}

TEST(Against, NamesTheNumberThatDiffersAndTheFiguresThatItMoved) {
    const json found = against(base(), variant());
    ASSERT_EQ(found["numbers"].size(), 1u) << found["numbers"];
    EXPECT_EQ(found["numbers"][0]["path"], "points.tie_rod_inner.z");
    EXPECT_EQ(found["numbers"][0]["variant"]["value"], -0.053);
    // first what an engineer notices most
    const auto noticed = [&](std::size_t k) {
        return found["figures"][k]["noticed"].get<double>();
    };
    EXPECT_GT(noticed(0), 10);
    for (std::size_t k = 1; k < found["figures"].size(); ++k)
        EXPECT_LE(noticed(k), noticed(k - 1)) << found["figures"][k];
    const auto value = [](const json& scene, const char* output) {
        for (const auto& leg : scene["branches"][0]["legs"])
            if (leg["leg"] == "equilibrium")
                for (std::size_t k = 0; k < leg["curve"]["a"].size(); ++k)
                    if (leg["curve"]["a"][k] == 0.0)
                        return leg["curve"]["values"][output][k].get<double>();
        return std::nan("");
    };
    for (const char* output : {"bump_steer", "bump_camber", "wheel_rate", "side_view_swing_arm"}) {
        const json* figure = named(found["figures"], "output", output);
        ASSERT_TRUE(figure) << output;
        EXPECT_EQ((*figure)["base"], value(base(), output));
        EXPECT_EQ((*figure)["variant"], value(variant(), output));
    }
    // a swing arm is compared by its reciprocal
    const json& arm = *named(found["figures"], "output", "side_view_swing_arm");
    EXPECT_EQ(arm["unit_of_difference"], "1/m");
    EXPECT_NEAR(arm["difference"].get<double>(),
                1e3 / arm["variant"].get<double>() - 1e3 / arm["base"].get<double>(), 1e-12);
    // and over the branches on the same axis
    const json* toe = named(found["branches"][0]["curves"], "output", "toe");
    ASSERT_TRUE(toe);
    double largest = 0;
    for (std::size_t k = 0; k < (*toe)["base"]["y"].size(); ++k) {
        ASSERT_EQ((*toe)["base"]["a"][k], (*toe)["variant"]["a"][k]);
        largest = std::max(largest, std::abs((*toe)["variant"]["y"][k].get<double>() -
                                             (*toe)["base"]["y"][k].get<double>()));
    }
    EXPECT_NEAR(std::abs((*toe)["largest"].get<double>()), largest, 1e-9);
    EXPECT_GT(largest, 0.01);
}

TEST(Against, OtherStepsAreComparedAtEqualParameter) {
    json coarse = base();  // every second point of each branch, by the same solution
    for (auto& branch : coarse["branches"])
        for (auto& leg : branch["legs"]) {
            const auto half = [](json& list) {
                json few = json::array();
                for (std::size_t k = 0; k < list.size(); k += 2) few.push_back(list[k]);
                list = few;
            };
            half(leg["curve"]["a"]);
            for (auto& values : leg["curve"]["values"]) half(values);
        }
    for (const auto& branch : against(coarse, base())["branches"])
        for (const auto& curve : branch["curves"])
            EXPECT_LT(std::abs(curve["largest"].get<double>()), 1e-2)
                << branch["name"] << curve["output"];  // interpolation between 80 mm / 4
}

TEST(Against, WhatOnlyOneHasIsNamed) {
    json other = variant();
    other["branches"][0]["name"] = "Ride";
    other["channels"][0]["name"] = "hub_x";
    const json found = against(base(), other);
    EXPECT_EQ(found["only_base"].size(), 2u) << found["only_base"];
    EXPECT_EQ(found["only_variant"], (json{"output hub_x", "branch Ride"}));
    json bare = {{"name", "x"}, {"source", "x.yaml"}, {"input_hash", ""}};
    EXPECT_THROW(add_against(bare, base()), ResultError);
}

TEST(Against, TheSectionDrawsBothOnCommonAxesAndSaysNothingOfAVerdict) {
    json with = base();
    add_against(with, variant());
    with = json::parse(with.dump());
    const std::string file = "result.json";
    const auto section = against_section({&with, "", &file});
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
    EXPECT_EQ(section->tables[0].rows[0][0], "points.tie_rod_inner.z");
    EXPECT_GT(section->tables[1].rows.size(), 5u);
    // variants of one scene have its name
    json twin = with;
    twin["against"]["name"] = with["name"], twin["against"]["source"] = "cars/stiffer.yaml";
    const auto named = against_section({&twin, "", &file});
    EXPECT_EQ(named->title, "Differences of stiffer.yaml");
    expect_parts(named->figures[0].caption, {"Thin line: stiffer.yaml."});
    EXPECT_FALSE(against_section({&base(), "", &file}));
    EXPECT_EQ(sections_of({&with, "", &file}).front().id, "against") << "the page begins with it";
    expect_parts(
        against_sentence(with),
        {"1 number of the scene and ",
         "differ, most " + with["against"]["figures"][0]["output"].get<std::string>() + " ["});
}

TEST(Against, TheCommandComparesTwoScenesAndHasNoFail) {
    const Folder folder;
    const std::string scene = scenes + "/double_wishbone_rigid.yaml",
                      higher = folder.write("higher.yaml", text_of(scene)),
                      out = " --against --quick -o " + (folder.path / "out").string(),
                      command = "env -u CI " ELASTOCHECK_COMMAND " report " + scene;
    const auto said = expect_said(support::says(command + " " + higher + out), 0);
    expect_parts(said.out + said.err, {}, {"ail"});
    expect_parts(text_of(folder.path / "out/report.html"), {"<h1>"});
    EXPECT_EQ(support::says(command + out).code, 2) << "one scene has nothing to be compared with";
}

}  // namespace
}  // namespace elastocheck::reports
