// The command line: output, exit codes, typing errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

TEST(Command, InspectShowsCountsIdleModesAndWhatWasLeftOut) {
    expect_says(
        "inspect " + scenes + "/chrono_mcpherson.yaml", 0,
        {.out = {"coordinates           18", "constraints            9", "unknowns              27",
                 "strut: rotation about the line through 'strut_tube' and 'K2_strut_mount'",
                 "ball_joint           arm - wheel: coincident points", "left out",
                 "in equilibrium"}});
}

// Definitions of outputs have one source: README, inspect and result.json agree.
TEST(Command, TheReadmeSaysOfEveryOutputWhatInspectSays) {
    const std::string readme = text_of(scenes + "/../../reports/README.md");
    int rows = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
        if (entry.path().extension() != ".yaml") continue;
        const std::string out = elastocheck_says("inspect " + entry.path().string()).out;
        const auto begin = out.find("\noutputs\n") + 9, end = out.find("\nredundant constraints");
        std::istringstream lines(out.substr(begin, end - begin));
        for (std::string row; std::getline(lines, row);) {
            if (row.empty()) continue;
            ++rows;
            std::string means = row.substr(row.find_first_not_of(' ', row.find("] ") + 1));
            if (means.starts_with("such as: ")) means = means.substr(9);
            // Only names of the scene and axes differ.
            means = std::regex_replace(means, std::regex("^position of '[^']+'"),
                                       "position of the probe");
            means = std::regex_replace(means, std::regex("joint '[^']+' on ('[^']+'|ground)"),
                                       "the joint on its first body");
            means = std::regex_replace(means, std::regex("moves '[^']+'"), "moves the joint");
            means = std::regex_replace(means, std::regex("(spring|damper) '[^']+'"),
                                       "the spring or damper");
            means = std::regex_replace(means, std::regex("ground axis [xyz](, positive [a-z ]+)?"),
                                       "ground axis");
            EXPECT_TRUE(contains(readme, means))
                << "reports/README.md does not say: " << means << "\nof " << row;
        }
    }
    EXPECT_GT(rows, 50);
}

TEST(Command, InspectNamesWhatIsRedundantUnbalancedAndLeftOut) {
    const Folder folder;
    const auto scene =
        folder.write("s.yaml",
                     "elastocheck: 1\nname: s\nunits: {length: m, angle: rad, force: N}\n"
                     "points: {a: [0, 0, 0], b: [1, 0, 0], c: [1, 1, 0]}\nbodies: {bar: {origin: "
                     "a}, idler: {origin: c}}\n"
                     "joints:\n  first: {type: revolute, bodies: [bar, ground], at: a, axis: x}\n"
                     "  second: {type: revolute, bodies: [bar, ground], at: b, axis: x}\n"
                     "  hanger: {type: spherical, bodies: [idler, bar], at: c}\n"
                     "bushings: {k: {bodies: [bar, ground], at: c, rates: [1e4, 1e4, 1e4]}}\n"
                     "static_loads: {weight: {on: bar, at: c, force: [0, 0, -50]}}\n"
                     "loads: {up: {on: bar, at: c, force: [0, 0, 1]}}\nbranches: {up: {load: up, "
                     "to: 10, steps: 2}}\n"
                     "probes: {tip: {on: bar, at: c}}\n");
    expect_says("inspect " + scene, 0,
                {.out = {"joint 'second': 5 of its rows repeat",
                         "body 'idler': it is attached to one other body",
                         "joint 'hanger': a body that it connects is left out",
                         "out of balance by 40.82 N"}});
}

TEST(Command, SeriesSolvesComparesAndStudiesItsOrders) {
    const Folder folder;
    const std::string scene = scenes + "/chrono_mcpherson.yaml",
                      rates = (folder.path / "rates.csv").string();
    const Said solved =
        expect_says("solve " + scene + " --method series --steps 10 --rates " + rates, 0);
    EXPECT_EQ(std::ranges::count(solved.out, '\n'), 1 + 2 * 11);
    expect_parts(text_of(rates),
                 {"branch,parameter,parameter unit,wheel_centre_x [mm per parameter unit]"});

    const Said compared =
        expect_says("compare " + scene + " --method series --steps 10 -o " +
                        (folder.path / "compared").string(),
                    0,
                    {.out = {"series       converged",
                             ": the method 'series' of the linear recursion beside two",
                             "The recursion is the method 'series'"},
                     .not_out = {"eq. (29)"}});
    const auto result = nlohmann::json::parse(text_of(folder.path / "compared/result.json"));
    const auto& leg = result["scenes"][0]["branches"][0]["legs"][0];
    EXPECT_EQ(leg["method"], "series");
    const auto& deviation =
        result["scenes"][0]["branches"][0]["deviation"]["at_equal_parameter"]["channels"];
    EXPECT_LE(deviation["toe"]["max"], 1e-9);

    const Said studied = expect_says(
        "converge " + scene + " --method series -o " + (folder.path / "studied").string(), 0,
        {.out = {"the series over its order"}});
    expect_parts(text_of(folder.path / "studied/orders.csv"), {"jounce,1e-09,16,converged"});
    EXPECT_FALSE(std::filesystem::exists(folder.path / "studied/convergence.csv"));
}

TEST(Command, SeriesSaysWhereThePathEndsAndGoesOnByArcLength) {
    const std::string solve =
        "solve " + scenes + "/two_spring_arch.yaml --set branches.down.to=-400 --method series";
    expect_says(solve, 3, {.err = {"limit point near -211.51659"}});
    expect_says(solve + " --arc-length --steps 40", 0, {.out = {"down,recursive,-400"}});
}

TEST(Command, OptionsOfAnotherMethodAreRefused) {
    const std::string scene = scenes + "/pinned_bar.yaml";
    for (const char* option : {"--order 8", "--expansions 5", "--arc-length", "--rates x.csv"})
        expect_says("solve " + scene + " --method tangent " + option, 2,
                    {.err = {"only with --method series"}});
    expect_says("solve " + scene + " --tolerance 1mm", 2,
                {.err = {"--tolerance: only with --method adaptive or series"}});
    expect_says("solve " + scene + " --method series --tolerance 1deg", 2);
    expect_says("solve " + scene + " --method sries", 2);
    expect_says("solve " + scene + " --method series --order 0", 2);
    expect_says("compare " + scene + " --method energy", 2);
    for (const char* method : {"recursive", "published", "adaptive --tolerance 1e-3mm", "energy"})
        expect_says("solve " + scene + " --steps 4 --method " + method, 0);
}

TEST(Command, CompareWritesTheTableAndTheResult) {
    const Folder folder;
    const Said said = expect_says("compare " + scenes + "/chrono_mcpherson.yaml --steps 20 -o " +
                                      (folder.path / "out").string(),
                                  0);
    EXPECT_TRUE(said.err.empty()) << said.err;  // no progress in a pipe
    expect_parts(said.out, {"branch 'jounce': 0 to 3000 N in 20 steps", "toe [deg]",
                            "at equal travel", "recursive    converged", "conclusive: "});
    const auto result = nlohmann::json::parse(text_of(folder.path / "out" / "result.json"));
    EXPECT_EQ(result["scenes"][0]["name"], "McPherson strut (generic vehicle of Project Chrono)");
    const std::string curves = text_of(folder.path / "out" / "curves.csv");
    EXPECT_TRUE(
        curves.starts_with("scene,branch,leg,parameter,parameter unit,output,unit,value\n"));
    expect_parts(curves, {",rebound,energy,-3000,N,"});
}

TEST(Command, CompareThatCannotJudgeExitsWith3AndStillWritesWhatItFound) {
    const Folder folder;
    expect_says("compare " + scenes + "/two_spring_arch.yaml --set branches.down.to=-300 -o " +
                    (folder.path / "out").string(),
                3, {.out = {"INCONCLUSIVE", "limit point"}});
    const auto result = nlohmann::json::parse(text_of(folder.path / "out" / "result.json"));
    EXPECT_EQ(result["scenes"][0]["verdict"]["conclusive"], false);
    EXPECT_FALSE(result["scenes"][0]["verdict"]["reasons"].empty());
}

TEST(Command, AReferenceWithoutASinglePointIsReportedNotCrashedOn) {
    // The mount's lateral preload rotates with the strut: an equilibrium, but no minimum of the
    // energy.
    const Folder folder;
    std::string scene = text_of(scenes + "/chrono_mcpherson_preload.yaml");
    scene.replace(scene.find("bodies: [ground, strut], at: strut_top"), 38,
                  "bodies: [strut, ground], at: strut_top");
    const auto preload = scene.find("preload: [", scene.find("K2_strut_mount"));
    scene.replace(preload, scene.find(']', preload) + 1 - preload,
                  "preload: [-76.9309197398, 813.830593499, -3796.67069248]");
    expect_says(
        "compare " + folder.write("unstable.yaml", scene), 3,
        {.out = {"energy leg: branch lost: branch 'jounce', settling from the design pose: the "
                 "equilibrium stops being "
                 "a minimum",
                 "nothing compared: a curve is empty"}});
}

TEST(Command, SolveThatFailsExitsWith3AndSaysWhere) {
    const Folder folder;
    std::string scene = text_of(scenes + "/pendulum.yaml");
    for (const char* word : {"to: 1500, steps: 60", "to: -1500, steps: 60"})
        scene.replace(scene.find(word), std::string(word).size(),
                      word[4] == '-' ? "to: -3000, steps: 600" : "to: 3000, steps: 600");
    expect_says("solve " + folder.write("p.yaml", scene) + " --method published", 3,
                {.err = {"published: diverged: branch 'up': at 2685 N: "}});
}

TEST(Command, ConvergeSplitsTheErrorAndWritesItsTables) {
    const Folder folder;
    expect_says(
        "converge " + scenes +
            "/bushing_pair.yaml --method published,tangent --steps 20,40,80,160,320 -o " +
            (folder.path / "out").string(),
        0,
        {.out = {"branch 'lift' at equal load: order at which the largest step error",
                 "branch 'lift' at equal nose_z", "  published ", "  tangent ",
                 "|Φ| at its end, eq. (31)", "whole = lever + axis + load + rest", "conclusive"}});
    const auto result = nlohmann::json::parse(text_of(folder.path / "out" / "result.json"));
    const auto& study = result["scenes"][0]["convergence"];
    EXPECT_EQ(study["outputs"]["rows"].size(), 2u * 2 * 2 * 6)
        << "branches, methods, readings, outputs";
    EXPECT_EQ(study["step_errors"]["rows"].size(), 2u * 2 * 2 * 6 * 5);
    EXPECT_EQ(study["gap"]["rows"].size(), 2u * 2 * 6);
    expect_parts(text_of(folder.path / "out" / "convergence.csv"),
                 {"lift,published,at equal load,nose_z,mm,converging,"});
    expect_parts(text_of(folder.path / "out" / "step_errors.csv"),
                 {"lift,published,at equal load,nose_z,mm,320,converged,"});
    expect_parts(text_of(folder.path / "out" / "attribution.csv"),
                 {"lift,at equal load,nose_z,mm,"});
    expect_says("converge " + scenes + "/bushing_pair.yaml --steps 10,20", 2);
    expect_says("converge " + scenes + "/bushing_pair.yaml --method tangnt", 2);
}

TEST(Command, BadInputExitsWith2AndWritesNothing) {
    const Folder folder;
    const auto bad = folder.write(
        "bad.yaml", "elastocheck: 1\nname: x\nunits: {length: inch, angle: deg, force: N}\n");
    const auto out = (folder.path / "out").string();
    expect_says("compare " + bad + " -o " + out, 2, {.err = {"bad.yaml:3: units.length: "}});
    EXPECT_FALSE(std::filesystem::exists(out));
    expect_says("compare " + (folder.path / "none.yaml").string(), 2);
    expect_says("inspect " + folder.path.string(), 2);
}

TEST(Command, TyposAreAnsweredWithTheNearestWord) {
    struct Typo {
        const char *arguments, *answer;
    };
    for (const auto& [arguments, answer] :
         {Typo{"comprae x", "unknown command 'comprae', did you mean 'compare'?"},
          Typo{"inspet x", "did you mean 'inspect'?"},
          Typo{"compare --stpes 3 x", "unknown option '--stpes', did you mean '--steps'?"},
          Typo{"solve x --methd=energy", "did you mean '--method'?"},
          Typo{"solve x --method enrgy",
               "--method: enrgy not in {recursive,equilibrium,energy,published,closed"},
          Typo{"solve x --steps 0", "--steps"}, Typo{"solve", "SCENE is required"},
          Typo{"", "subcommand is required"}}) {
        const Said said = expect_says(arguments, 2, {.err = {answer}});
        EXPECT_TRUE(said.out.empty()) << said.out;
    }
}

}  // namespace
}  // namespace elastocheck
