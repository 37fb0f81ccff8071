// Commands before solving: templates, trim, inspect, formulations, --keep-all.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/warnings/plausibility.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/reports/command.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck {
namespace {

std::vector<std::string> shipped() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(scenes))
        if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
    return names;
}

// ---- elastocheck new

TEST(New, ListsEverySceneWithALine) {
    const Said said = expect_says("new", 0);
    for (const auto& name : shipped()) expect_parts("\n" + said.out, {"\n" + name + " "});
    expect_parts(said.out, {"McPherson strut (Kang 2004, section 3)"});
}

TEST(New, PrintedTemplateEqualsTheSceneAndIsValidAlone) {
    const Folder folder;
    for (const auto& name : shipped()) {
        const std::string file = (folder.path / (name + ".yaml")).string();
        expect_says("new " + name + " > " + file, 0);
        EXPECT_EQ(text_of(file), text_of(scenes + "/" + name + ".yaml")) << name;
        // Self-contained: it is read from its own folder, trimmed or not.
        const Said read = elastocheck_says("inspect " + file);
        EXPECT_NE(read.code, 2) << name << ": " << read.err;
    }
}

// ---- trim

TEST(TrimCommand, IsConfirmedInTheResult) {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    expect_says("compare " ELASTOCHECK_CLAIMS "/block.yaml -o " + out, 0);
    const auto result = nlohmann::json::parse(text_of(out + "/result.json"));
    const auto& trim = result["scenes"][0]["trim"];
    EXPECT_NEAR(trim["adjusted"][0]["by"].get<double>(), 500, 1e-6);
    EXPECT_LE(std::abs(trim["conditions"][0]["missed_by_confirming_leg"].get<double>()), 1e-6);
    EXPECT_EQ(trim["confirmed_by"], "energy");
}

// ---- the README

TEST(Readme, ItsTenLinesAreASuspensionThatCanBeJudged) {
    const std::string page = text_of(std::string(ELASTOCHECK_VALIDATION) + "/../../README.md");
    const auto from = page.find("```yaml\nelastocheck: 1"), to = page.find("\n```", from);
    ASSERT_NE(from, std::string::npos);
    const std::string lines = page.substr(from + 8, to - from - 7);
    EXPECT_LE(std::ranges::count(lines, '\n'), 11);
    const Folder folder;
    const std::string file = folder.write("my_arm.yaml", lines);
    expect_says("compare " + file, 0, {.out = {"roll_centre_height"}});
    const Said said = expect_says("report " + file + " -o " + (folder.path / "out").string(), 0);
    // The quoted answer, independent of line breaks. Its first sentence depends on rounding.
    std::string flat = page, sentence = parts_of(said.out, '\n').front();
    const auto after_rounding = sentence.find("The cheapest method");
    ASSERT_NE(after_rounding, std::string::npos) << sentence;
    sentence.erase(0, after_rounding);
    std::ranges::replace(flat, '\n', ' ');
    for (const std::string space : {"\u00a0", "\u202f"})
        for (std::size_t at; (at = sentence.find(space)) != std::string::npos;)
            sentence.replace(at, space.size(), " ");
    expect_parts(flat, {sentence});
}

// ---- numbers that are probably in another unit

TEST(Plausibility, NoBuiltInSceneAndNoImportWarns) {
    const Folder folder;
    int read = 0;
    // Springs that their files stretch in the drawn position: 306 mm long, drawn with 340 mm.
    const std::vector<std::string> in_tension{"generic__MacPhersonStrut.json",
                                              "generic__SemiTrailingArm.json",
                                              "hmmwv__HMMWV_DoubleWishboneReducedFront.json"};
    const auto expect_none = [&](const std::string& file, const std::string& name) {
        if (std::ranges::find(in_tension, name) != in_tension.end()) return;
        const std::string said = elastocheck_says("inspect " + file).err;
        EXPECT_FALSE(contains(said, "(warning)")) << name << ": " << said;
        ++read;
    };
    for (const char* part : {"/", "/../extremes/"})
        for (const auto& entry : std::filesystem::directory_iterator(scenes + part))
            if (entry.path().extension() == ".yaml") expect_none(entry.path(), "");
    for (const auto& entry :
         std::filesystem::directory_iterator(scenes + "/../../tests/models/import/samples")) {
        const std::string file = (folder.path / "imported.yaml").string();
        if (elastocheck_says("import " + entry.path().string() + " -o " + file).code != 0) continue;
        expect_none(file, entry.path().filename());
        std::filesystem::remove(file);
    }
    EXPECT_GT(read, 60);
}

// ---- The likeliest mistakes.

struct Edit {
    std::string from, to;  // every occurrence
};
std::string with(std::string text, const std::vector<Edit>& edits) {
    for (const auto& [from, to] : edits) {
        auto at = text.find(from);
        EXPECT_NE(at, text.npos) << from;
        for (; at != text.npos; at = text.find(from, at + to.size()))
            text.replace(at, from.size(), to);
    }
    return text;
}
TEST(Mistakes, PointsFarFromTheirBodyAreNotedByInspect) {
    const std::string axle =
        with(text_of(scenes + "/front_axle.yaml"),
             {{"bodies: [lower_arm_left, wheel_left]", "bodies: [lower_arm_left, wheel_right]"}});
    const auto notes = compare::misplaced_points(parse_scene(axle, "axle.yaml"));
    ASSERT_EQ(notes.size(), 2u);
    expect_parts(notes[0], {"'lower_ball_left' is ", "is 'wheel_right' the body meant?"});
    const std::string link = with(text_of(scenes + "/multi_link.yaml"),
                                  {{"bodies: [lateral, subframe]", "bodies: [lateral, knuckle]"},
                                   {"{type: spherical, bodies: [lateral, knuckle]",
                                    "{type: spherical, bodies: [lateral, subframe]"}});
    const auto of_link = compare::misplaced_points(parse_scene(link, "link.yaml"));
    ASSERT_FALSE(of_link.empty());
    expect_parts(of_link.back(),
                 {"'lateral': its end on 'subframe' is ", "are its ends exchanged?"});
    for (const auto& name : support::scene_names())
        EXPECT_TRUE(compare::misplaced_points(support::scene(name)).empty()) << name;
}

// A drop link that goes over centre 63 mm below the design position. The place is told once, with the
// part; the other branches keep their results.
TEST(Mistakes, ALinkOverCentreIsNamedOnce) {
    const std::string scene =
        scenes +
        "/front_axle.yaml --set points.drop_link_left.x=-0.1 "
        "--set points.drop_link_left.y=0.64 --set points.drop_link_left.z=-0.11";
    const Said said = expect_says("compare " + scene, 3);
    const std::string verdict = said.out.substr(said.out.find("Not judged: parallel: "));
    const auto first = verdict.find("the softest motion");
    EXPECT_NE(first, verdict.npos);
    EXPECT_EQ(verdict.find("the softest motion", first + 1), verdict.npos);
}

// ---- inspect

TEST(Inspect, ShowsTheBeginningOfLongListsAndAllWhenVerbose) {
    const Folder folder;
    const auto scene = folder.write("chain.yaml", chain_of(100));
    const Said some = elastocheck_says("inspect " + scene),
               all = elastocheck_says("inspect --verbose " + scene);
    EXPECT_EQ(some.code, 0) << some.err;
    expect_parts(some.out, {"... and 60 more; --verbose lists all"}, {"  b41 ", "fill-in"});
    expect_parts(all.out, {"  b41 ", "  h100 ", "matrix of eq. (24)", "entries of L + U"},
                 {"--verbose"});
}

// ---- too large for the energy leg

TEST(TooLarge, TooLargeSceneIsRejectedByTheEnergyLegBeforeSolving) {
    const Folder folder;
    const std::string scene = folder.write("chain.yaml", chain_of(150));
    expect_says("solve " + scene + " --method energy --set branches.push.steps=60000", 3,
                {.err = {"too large: branch 'push': about ", "operations for 900 coordinates"}});
}

}  // namespace
}  // namespace elastocheck
