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

// ---- elastocheck import

// A body whose weight acts along a free slide is imported, and the head of its scene says that no
// branch begins.
TEST(Import, SaysWhetherTheDrawnPositionSettles) {
    const Folder here;
    const auto head_of = [&](const std::string& sample) {
        const std::string file = (here.path / "scene.yaml").string();
        std::filesystem::remove(file);
        expect_says(
            "import " + scenes + "/../../tests/models/import/samples/" + sample + " -o " + file, 0,
            {.out = {"settle"}});
        const std::string text = text_of(file);
        return text.substr(0, text.find("\nelastocheck: 1"));
    };
    expect_parts(
        head_of("chrono_Cylindrical_Case01.adm"),
        {"# The drawn position does NOT settle, so that no branch starts: loaded idle mode: "});
    expect_parts(head_of("chrono_RotSpring_Case01.adm"),
                 {"# The drawn position settles: bodies move by up to 646 mm"});
}

// ---- elastocheck new

TEST(New, ListsEverySceneWithALine) {
    const Said said = expect_says("new", 0);
    for (const auto& name : shipped()) expect_parts("\n" + said.out, {"\n" + name + " "});
    expect_parts(said.out, {"McPherson strut (Kang 2004, section 3)"});
}

TEST(New, PrintsTheSceneAsItIsAndItStandsAlone) {
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

TEST(New, UnknownNameIsAnsweredWithTheNearest) {
    const Said said = expect_says("new mcphersn", 2);
    EXPECT_TRUE(said.out.empty());
    expect_parts(said.err,
                 {"new: there is no template 'mcphersn', did you mean 'mcpherson'? there are:"});
}

// ---- trim

std::string block(const std::string& trim, const std::string& more = "") {
    return "elastocheck: 1\nname: block\nunits: {length: m, angle: rad, force: N}\n"
           "points: {low: [0, 0, 0], high: [0, 0, 0.4], aside: [1, 0, 0.4]}\nbodies: {block: "
           "{origin: "
           "high}}\n"
           "joints: {guide: {type: translational, bodies: [block, ground], at: high, axis: z}}\n"
           "springs:\n  coil: {bodies: [block, ground], from: high, to: low, rate: 20e3}\n"
           "  across: {bodies: [block, ground], from: high, to: aside, rate: 0.001}\n" +
           more + "loads: {up: {on: block, at: high, force: [0, 0, 1]}}\n" + trim +
           "branches: {up: {load: up, to: 100, steps: 4}}\nprobes: {top: {on: block, at: high}}\n";
}

TEST(TrimCommand, EveryCommandStartsFromTheTrimmedScene) {
    const Folder folder;
    const auto scene = folder.write(
        "block.yaml",
        block("trim: {adjust: [springs.coil.preload], until: [top.z], under: {up: -500}}\n"));
    expect_says("inspect " + scene, 0,
                {.out = {"trim, found by the equilibrium leg", "confirmed by the energy leg",
                         "springs.coil.preload",
                         "+500 N: force 500 N in compression, free length 425 mm", "until top.z"}});
    // Without the trim the block would start 25 mm lower.
    const Said solved = elastocheck_says("solve " + scene + " --method equilibrium");
    expect_parts(solved.out, {"up,equilibrium,0,"}, {",375,"});
    const std::string out = (folder.path / "out").string();
    expect_says("compare " + scene + " -o " + out, 0);
    const auto result = nlohmann::json::parse(text_of(out + "/result.json"));
    const auto& trim = result["scenes"][0]["trim"];
    EXPECT_NEAR(trim["adjusted"][0]["by"].get<double>(), 500, 1e-6);
    EXPECT_LE(std::abs(trim["conditions"][0]["missed_by_confirming_leg"].get<double>()), 1e-6);
    EXPECT_EQ(trim["confirmed_by"], "energy");
}

TEST(TrimCommand, QuestionThatIsIllPosedIsBadInputWithItsLine) {
    const Folder folder;
    const auto scene = folder.write(
        "block.yaml",
        block("trim: {adjust: [springs.across.preload], until: [top.z], under: {up: -500}}\n"));
    expect_says(
        "inspect " + scene, 2,
        {.err = {"block.yaml:11: trim: 'springs.across.preload' has no influence on top.z"}});
}

TEST(TrimCommand, WhatIsNotReachedLeavesNothingToJudge) {
    const Folder folder;
    // The rod stops the block 0.5 m above its hanging position.
    const auto scene = folder.write(
        "block.yaml",
        "elastocheck: 1\nname: rod\nunits: {length: m, angle: rad, force: N}\n"
        "points: {pivot: [0, 0, 0], tip: [1, 0, 0], low: [1, 0, -1]}\nbodies: {rod: {origin: "
        "pivot}}\n"
        "joints: {pivot: {type: revolute, bodies: [rod, ground], at: pivot, axis: y}}\n"
        "springs: {coil: {bodies: [rod, ground], from: tip, to: low, rate: 20e3}}\n"
        "loads: {up: {on: rod, at: tip, force: [0, 0, 1]}}\n"
        "trim: {adjust: [springs.coil.preload], until: {tip.z: 3}}\n"
        "branches: {up: {load: up, to: 100, steps: 4}}\nprobes: {tip: {on: rod, at: tip}}\n");
    for (const char* command : {"inspect", "solve", "compare", "converge", "trade"})
        expect_says(std::string(command) + " " + scene, 3,
                    {.err = {"block.yaml:9: trim: the conditions cannot be met: the closest "
                             "iterate misses 'tip.z'"}});
    expect_says("gate " + scene + " --accept --reason first", 3);
    EXPECT_FALSE(std::filesystem::exists(folder.path / "baselines"));
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

// Points and rates for a scene in mm.
std::string arm_in(const std::string& units) {
    return "elastocheck: 1\nname: arm\nunits: " + units + R"(
points: {outer: [500, 900, 0], inner: [420, 600, -50], seat: [150, 800, 0], top: [150, 800, 300],
         centre: [0, 1100, 0], patch: [0, 1100, -320]}
bodies: {arm: {origin: centre}}
bushings:
  outer: {bodies: [arm, ground], at: outer, rates: [4000, 9000, 9000], rotational_rates: [2, 6, 6]}
  inner: {bodies: [arm, ground], at: inner, rates: [4000, 9000, 9000], rotational_rates: [2, 6, 6]}
springs: {coil: {bodies: [arm, ground], from: seat, to: top, rate: 90}}
loads: {up: {on: arm, at: patch, force: [0, 0, 1]}}
branches: {up: {load: up, to: 100, steps: 4}}
wheel: {body: arm, centre: centre, contact_patch: patch, contact: carrier, spin_axis: y, side: left}
)";
}

TEST(Plausibility, ALengthInTheWrongUnitIsAWarningWithItsLine) {
    const Folder folder;
    const std::string file =
        folder.write("m.yaml", arm_in("{length: m, angle: deg, force: N, moment: N·m}"));
    for (const char* command : {"inspect ", "solve "})
        expect_says(command + file, 0,
                    {.err = {"m.yaml:3: units.length: the hardpoints extend over 620 m, far from "
                             "the size of a car; are they in mm, not in m? (warning)\n"}});
    const std::string own = folder.write("own.csv", elastocheck_says("solve " + file).out);
    for (const std::string& command :
         {std::string("inspect "), std::string("solve "), "judge --candidate " + own + " "}) {
        const auto said = elastocheck_says(command + "--json " + file);
        const auto document = nlohmann::json::parse(said.out, nullptr, false);
        ASSERT_TRUE(document.is_object()) << command << said.err;
        ASSERT_EQ(document["scenes"][0]["warnings"].size(), 1u) << command;
    }
    std::string small = arm_in("{length: mm, angle: deg, force: N, moment: N·m}");
    const auto points = small.find("points:"), bodies = small.find("bodies:");
    small.replace(
        points, bodies - points,
        "points: {outer: [0.5, 0.9, 0], inner: [0.42, 0.6, -0.05], seat: [0.15, 0.8, 0],\n"
        "         top: [0.15, 0.8, 0.3], centre: [0, 1.1, 0], patch: [0, 1.1, -0.32]}\n");
    expect_parts(elastocheck_says("inspect " + folder.write("mm.yaml", small)).err,
                 {"mm.yaml:3: units.length: the hardpoints extend over "});
}

TEST(Plausibility, RotationalRatesWithoutAUnitOfMomentAreAWarningWithTheirLine) {
    const Folder folder;
    expect_says("inspect " + folder.write("a.yaml", arm_in("{length: mm, angle: deg, force: N}")),
                0,
                {.err = {"a.yaml:8: bushings.outer.rotational_rates: 6 N·mm/deg beside 9e+03 N/mm "
                         "is the rotational stiffness of a bushing with a radius of 0.2 mm; "
                         "`units` says no moment: is `moment: N·m` meant? (and so of 1 more) "
                         "(warning)\n"}});
    const Said right = elastocheck_says(
        "inspect " +
        folder.write("b.yaml", arm_in("{length: mm, angle: deg, force: N, moment: N·m}")));
    EXPECT_TRUE(right.err.empty()) << right.err;
}

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

// ---- The likeliest mistakes, each in the McPherson strut with a trim.

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
std::string strut(const std::vector<Edit>& edits) {
    return with(text_of(scenes + "/mcpherson_strut.yaml"), edits);
}
std::vector<Edit> y_to_the_right() {
    std::vector<Edit> edits;
    for (const std::string y :
         {"0.520", "0.507", "0.94057703", "0.445", "0.89495045", "0.785", "0.8532915", "1.10"})
        edits.push_back({" " + y + ",", " -" + y + ","});
    return edits;
}

TEST(Mistakes, AWheelOnTheOtherSideThanItsCentreIsAnError) {
    const Folder folder;
    for (const char* command : {"inspect ", "solve ", "report --quick -o page "})
        expect_says(
            command + folder.write("a.yaml", strut({{"side: left", "side: right"},
                                                    {"spin_axis: y", "spin_axis: [0, -1, 0]"}})),
            2, {.err = {"a.yaml:81: wheel.side: a right wheel with its centre at y = 1.1 m"}});
    expect_says(
        "inspect " + folder.write("b.yaml", strut(y_to_the_right())), 2,
        {.err = {"b.yaml:81: wheel.side: a left wheel with its centre at y = -1.1 m; y points "
                 "left from the middle of the car: allowed: right, or points with y to the "
                 "left and x forward"}});
}

TEST(Mistakes, PointsWithXToTheRearAreAWarning) {
    const Folder folder;
    auto edits = y_to_the_right();  // both: a half turn, and the wheel is at the right
    edits.insert(edits.end(), {{"[-0.", "[+0."},
                               {"[0.220", "[-0.220"},
                               {"[+0.", "[0."},
                               {"side: left", "side: right"},
                               {"spin_axis: y", "spin_axis: [0, -1, 0]"}});
    expect_says("inspect " + folder.write("a.yaml", strut(edits)), 0,
                {.err = {"a.yaml:81: wheel: caster -", " deg, mechanical trail -", "anti-dive -",
                         "all negative; does x point rearward? (warning)"}});
}

TEST(Mistakes, ImplausibleNumbersAreWarningsWithTheirLine) {
    struct Case {
        std::vector<Edit> edits;
        std::vector<std::string> says;
    };
    const std::vector<Case> cases{
        {{{"  tie_rod: {type: distance, bodies: [wheel, rack], from: tie_rod_outer, to: "
           "tie_rod_inner}\n",
           ""},
          {", joints.tie_rod]", "]"},
          {"travel: 0, toe: 0}", "travel: 0}"},
          {"  steering: {drive: joints.rack, from: -0.05, to: 0.05, steps: 80, hold: {travel: "
           "0}}\n",
           ""}},
         {"a.yaml:79: wheel: toe 31.16 deg at rest, plausible: -10 to 10; is a tie rod missing",
          "wheel: shift 102.6 mm at rest"}},
        {{{"[0.6e6, 2.5e6, 2.5e6]", "[600, 2500, 2500]"}},
         {"a.yaml:56: bushings.arm_rear: displacement ", "wheel: shift 87.83 mm at rest"}},
        {{{"vertical: {on: wheel, at: contact, force: [0, 0, 1]}",
           "vertical: {on: wheel, at: contact, force: [0, 0, -1]}"}},
         {"a.yaml:70: trim.under.vertical: the static load pulls wheel down with 3500 N",
          "a.yaml:40: springs.coil: force -", "it is in tension"}},
        {{{"under: {vertical: 3500}", "under: {vertical: 3.5}"}},
         {"a.yaml:70: trim.under.vertical: a static wheel load of 3.5 N, plausible: 50 to "}},
        {{{"wheelbase: 2.7,", "wheelbase: 2700,"}},
         {"a.yaml:87: vehicle.wheelbase: 2700 m, expected 0.5 to 10 m; `units` says that"}},
        {{{"contact: [-0.04, 1.10, -0.346]", "contact: [-0.04, 1.10, 0.246]"}},
         {"a.yaml:81: wheel: the contact patch is above the wheel centre; does z point up?"}},
    };
    for (const auto& [edits, says] : cases) {
        const Folder folder;
        const std::string file = folder.write("a.yaml", strut(edits));
        expect_says("inspect " + file, 0, {.err = says});
    }
    // the same in the document, on the page and beside a solution
    const Folder folder;
    const std::string file = folder.write("a.yaml", strut(cases[1].edits));
    const std::string& warning = cases[1].says[0];
    expect_parts(elastocheck_says("inspect --json " + file).out, {warning});
    expect_parts(elastocheck_says("solve " + file).err, {warning});
    const std::string page = (folder.path / "page").string();
    expect_parts(elastocheck_says("report --quick " + file + " -o " + page).err, {warning});
    expect_parts(text_of(page + "/report.html"), {"bushings.arm_rear: displacement "});
}

// The structure is shown, and then why the trim is not reached: the part that is free or locked.
TEST(Mistakes, PartsThatAreFreeOrLockedAreNamedBeforeTheTrim) {
    const std::string text = text_of(scenes + "/mcpherson_strut.yaml");
    const auto section = [&](const std::string& from, const std::string& to) {
        const auto begin = text.find(from);
        return text.substr(begin, text.find(to, begin) - begin);
    };
    const std::string arms = section("  arm_front:\n", "\nloads:");
    struct Case {
        std::vector<Edit> edits;
        std::vector<std::string> shows, says;
        int code;
    };
    const std::vector<Case> cases{
        {{{section("  strut_mount:", "  arm_front:\n"), ""}},
         {"  strut: rotation about the axis "},
         {"trim: nothing resists a motion of 'wheel': strut: rotation about ",
          "so the trim fails: "},
         3},
        {{{"axis: y, held: true}", "axis: y}"}},
         {"degrees of freedom"},
         {"trim: 'joints.tie_rod' has no influence on travel and toe",
          "; the softest motion as drawn is wheel: rotation about ", "'rack'"},
         2},
        {{{arms, ""},
          {"joints:\n",
           "joints:\n"
           "  arm_front: {type: revolute, bodies: [arm, ground], at: arm_front, axis: x}\n"
           "  arm_rear: {type: revolute, bodies: [arm, ground], at: arm_rear, axis: [arm_rear, "
           "arm_front]}\n"}},
         {"  body 'arm' cannot move: the joints 'arm_front' and 'arm_rear' lock it\n"},
         {"trim: body 'arm' cannot move: the joints 'arm_front' and 'arm_rear' lock it; so the "
          "trim "
          "fails: "},
         3},
    };
    for (const auto& [edits, shows, says, code] : cases) {
        const Folder folder;
        const std::string file = folder.write("a.yaml", strut(edits));
        expect_says("inspect " + file, code, {.out = shows, .err = says});
        expect_says("solve " + file, code, {.err = says});
    }
}

TEST(Mistakes, PointsFarFromTheirBodyAreNotedByInspect) {
    const Folder folder;
    const std::string exchanged = strut(
        {{"from: tie_rod_outer, to: tie_rod_inner", "from: tie_rod_inner, to: tie_rod_outer"}});
    expect_says(
        "inspect " + folder.write("a.yaml", exchanged), 0,
        {.out = {"points that may belong to another body\n  'tie_rod': its end on 'wheel' is ",
                 "are its ends exchanged?"}});
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
    expect_says("solve --method series " + scene, 3,
                {.err = {"limit point near -63.0907434 mm",
                         "; the softest motion before it is bar_left: rotation about "}});
    const Said said = expect_says("compare " + scene, 3);
    const std::string verdict = said.out.substr(said.out.find("Not judged: parallel: "));
    const auto first = verdict.find("the softest motion");
    EXPECT_NE(first, verdict.npos);
    EXPECT_EQ(verdict.find("the softest motion", first + 1), verdict.npos);
}

// A rack that nothing holds, with the steering axes leaning outwards: the wheels steer away.
TEST(Plausibility, AnUnstableEquilibriumNamesTheRackThatIsFree) {
    const Folder folder;
    std::string scene = text_of(scenes + "/front_axle.yaml");
    const auto held = scene.find(", held: true"), steering = scene.find("  steering: ");
    scene.erase(steering, scene.find('\n', steering) + 1 - steering);
    scene.erase(held, 12);
    expect_says(
        "solve " + folder.write("free.yaml", scene) + " --set points.upper_ball_left.y=0.95", 3,
        {.err = {"is unstable: bodies that are displaced: ", "'rack'"}});
}

// ---- inspect

TEST(Inspect, OriginsAreInMillimetres) {
    const Said said = elastocheck_says("inspect " + scenes + "/front_axle.yaml");
    expect_parts(said.out, {"origin (-279, 0, 1) mm"}, {") m\n"});
}

TEST(Inspect, SaysWhatElementsAre) {
    const Folder folder;
    const auto scene = folder.write(
        "all.yaml",
        "elastocheck: 1\nname: all\nunits: {length: m, angle: rad, force: N}\n"
        "points: {a: [0, 0, 0], b: [1, 0, 0], c: [1, 0.5, 0], d: [0, 1, 0], low: [1, 0, -0.5]}\n"
        "bodies: {arm: {origin: a}, other: {origin: d}}\n"
        "joints: {hinge: {type: revolute, bodies: [arm, ground], at: a, axis: y}}\n"
        "springs:\n"
        "  coil: {bodies: [arm, ground], from: b, to: low, rate: 20e3, bump_stop: {clearance: "
        "0.03, rate: "
        "300e3}}\n"
        "  curved: {bodies: [arm, ground], from: b, to: low, curve: {table: [[-0.05, -900], [0, "
        "0], [0.05, "
        "1400]]}}\n"
        "torsion_springs: {bar: {bodies: [arm, ground], at: a, axis: y, rate: 40}}\n"
        "bushings:\n"
        "  mount: {bodies: [other, ground], at: d, rates: [1e6, 1e6, 1e6], rotational_rates: [10, "
        "10, 10],\n"
        "          formulation: {frame: j, angles: cardan}}\n"
        "beams: {leaf: {bodies: [arm, other], through: [b, d], E: 206e9, G: 79e9, diameter: 0.02, "
        "segments: "
        "4}}\n"
        "loads: {up: {on: arm, at: b, force: [0, 0, 1]}}\n"
        "branches: {up: {load: up, to: 100, steps: 4}}\nprobes: {tip: {on: other, at: d}}\n");
    expect_says(
        "inspect " + scene, 0,
        {.out = {"axial spring, 20 N/mm", "stop, touches when 30 mm shorter, 300 N/mm",
                 "curve from -50 to 50 mm, ", "torsion spring, ",
                 "bushing, frame on j, Cardan angles", "leaf.1 ... 4", "beam in 4 segments"}});
}

TEST(Inspect, ShowsTheBeginningOfLongListsAndAllWhenVerbose) {
    const Folder folder;
    const auto scene = folder.write("chain.yaml", chain_of(100));
    const Said some = elastocheck_says("inspect " + scene),
               all = elastocheck_says("inspect --verbose " + scene);
    EXPECT_EQ(some.code, 0) << some.err;
    expect_parts(some.out,
                 {"... and 60 more bodies; --verbose lists all",
                  "... and 60 more elements; --verbose lists all"},
                 {"  b41 ", "  factors "});
    expect_parts(all.out, {"  b41 ", "  h100 ", "  matrix ", "  factors ", "entries of L + U: "},
                 {"--verbose"});
}

TEST(Inspect, ListsNumbersWithTheirSidesWhenVerbose) {
    expect_says(
        "inspect --verbose " + scenes + "/front_axle.yaml --set springs.coil_left.rate@right=80e3",
        0,
        {.out = {"springs.coil_left.rate", "both sides; alone: @left 95000, @right 80000",
                 "points.rack.z"}});
}

TEST(Inspect, TellsTheSizeBeforeAndAfter) {
    const Said said = elastocheck_says("inspect " + scenes + "/four_bar.yaml");
    EXPECT_TRUE(contains(said.out, "the scene  ") && contains(said.out, "as solved  ")) << said.out;
}

TEST(Inspect, NamesWhatIsCondensedWithItsReason) {
    const Said said = elastocheck_says("inspect " + scenes + "/front_axle.yaml");
    expect_parts(said.out, {"left out or condensed, because no output depends on it",
                            "body 'drop_link_left': a link with a ball at each end and no load: "
                            "replaced by the distance joint 'drop_link_left'",
                            "the scene  13 bodies", "as solved  11 bodies"});
}

// ---- wheel and ride rate

TEST(Rates, AreSaidWhereAWheelIsLiftedAndRideRatesWhereItHasATyre) {
    const Said tyre = expect_says(
        "compare " + scenes + "/tyre_on_road.yaml", 0,
        {.out = {"wheel rate from 0 to 60 mm: 30 N/mm (0 %); ride rate: 26.09 N/mm (0 %)\n",
                 "wheel rate from 0 to 1500 N: 30 N/mm (0 %); ride rate: 26.09 N/mm (0 %)\n"}});
    EXPECT_FALSE(contains(tyre.out, "from 0 to 2000 N")) << "the tyre bears a part of that\n"
                                                         << tyre.out;
    const Said strut = elastocheck_says("compare " + scenes + "/mcpherson.yaml --steps 10");
    expect_parts(strut.out, {"wheel rate from 0 to "}, {"ride rate"});
}

// ---- compare --formulations

TEST(FormulationsCommand, ShowsTheSpreadBesideUncertaintyAndDeviation) {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    expect_says(
        "compare " + scenes + "/mcpherson.yaml --steps 10 --formulations -o " + out, 0,
        {.out = {"formulations of the bushings (8): K2_strut_mount, K3_arm_front, K4_arm_rear",
                 "largest less smallest value over 7 formulations",
                 "not solved: frame in the middle: loaded idle mode: ", "without offset moment",
                 "A correct tool with the same input may differ from this one by the spread"}});
    const auto result = nlohmann::json::parse(text_of(out + "/result.json"));
    EXPECT_EQ(result["scenes"][0]["formulations"]["spread"]["rows"].size(), 10u);
    EXPECT_TRUE(text_of(out + "/formulations.csv").starts_with("branch,output,unit,spread,"));
}

TEST(FormulationsCommand, SceneWithoutAChoiceCouldNotBeJudged) {
    expect_says("compare " + scenes + "/two_spring_arch.yaml --steps 4 --formulations", 3,
                {.out = {"inconclusive: the scene has no bushing that leaves a choice"}});
}

// ---- No energy

TEST(NoEnergy, IsSaidAndTheSeriesJudges) {
    const Folder folder;
    std::string scene = text_of(scenes + "/mcpherson.yaml");
    const std::string load = "force: [0, 0, 1]}";
    const auto at = scene.find(load);
    ASSERT_NE(at, scene.npos);
    scene.replace(at, load.size(), "force: [0, 0, 1], follows: true}");
    const std::string out = (folder.path / "out").string();
    expect_says("compare " + folder.write("kick.yaml", scene) + " --steps 10 -o " + out, 0,
                {.out = {"energy       not conservative", "series       converged",
                         "the equilibrium leg and series judge each other; no energy exists: ",
                         "'vertical'", "or series where no energy exists", "conclusive: "}});
    const auto result = nlohmann::json::parse(text_of(out + "/result.json"));
    const auto& branch = result["scenes"][0]["branches"][0];
    EXPECT_EQ(branch["second_reference"], "series");
    EXPECT_EQ(branch["reference_uncertainty"]["of"], "series");
    EXPECT_EQ(branch["legs"].size(), 4u);
}

// ---- too large for the energy leg

TEST(TooLarge, IsSaidAndTheEnergyLegBearsWitness) {
    const Folder folder;
    const std::string scene = folder.write("chain.yaml", chain_of(150)),
                      out = (folder.path / "out").string();
    expect_says("solve " + scene + " --method energy", 3,
                {.err = {"too large: branch 'push': about 3e+11 operations for 900 coordinates"}});
    expect_says(
        "compare " + scene + " -o " + out, 0,
        {.out = {
             "energy       too large", "series       converged",
             "or series where the scene is too large for it",
             "the equilibrium leg and series judge each other; branch 'push': about",
             "the energy leg judges the states: the equilibrium leg's states have residuals of ",
             "conclusive: "}});
    const auto result = nlohmann::json::parse(text_of(out + "/result.json"));
    const auto& branch = result["scenes"][0]["branches"][0];
    EXPECT_EQ(branch["witness"]["leg"], "energy");
    for (const char* unit : {"force_N", "moment_Nm", "constraint_mm"})
        EXPECT_LE(branch["witness"]["left"][unit].get<double>(),
                  branch["witness"]["at_most"][unit].get<double>())
            << unit;
    expect_parts(branch["energy_not_asked"].get<std::string>(), {"900 coordinates"});
}

// ---- --keep-all

TEST(KeepAll, SolvesTheWholeSceneToTheSameNumbers) {
    const Folder folder;
    const auto scene =
        folder.write("s.yaml",
                     "elastocheck: 1\nname: s\nunits: {length: m, angle: rad, force: N}\n"
                     "points: {a: [0, 0, 0], b: [1, 0, 0], c: [1, 1, 0]}\nbodies: {bar: {origin: "
                     "a}, idler: {origin: c}}\n"
                     "joints:\n  first: {type: revolute, bodies: [bar, ground], at: a, axis: y}\n"
                     "  hanger: {type: revolute, bodies: [idler, bar], at: c, axis: y}\n"
                     "bushings: {k: {bodies: [bar, ground], at: b, rates: [1e4, 1e4, 1e4]}}\n"
                     "loads: {up: {on: bar, at: b, force: [0, 0, 1]}}\nbranches: {up: {load: up, "
                     "to: 100, steps: 2}}\n"
                     "probes: {tip: {on: bar, at: b}}\n");
    const Said less = elastocheck_says("inspect " + scene),
               all = expect_says("inspect " + scene + " --keep-all", 0);
    expect_parts(less.out,
                 {"body 'idler': it is attached to one other body", "coordinates            6"});
    expect_parts(all.out, {"coordinates           12"});
    for (const char* command : {"solve ", "compare "})
        expect_says(command + scene + " --keep-all", 0);
}

}  // namespace
}  // namespace elastocheck
