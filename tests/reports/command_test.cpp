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

// Definitions of outputs have one source: README, inspect and result.json agree.
TEST(Command, ReadmeHasTheDefinitionsOfInspect) {
    const std::string readme = text_of(scenes + "/../../reports/README.md") +
                               text_of(scenes + "/../../compare/outputs/catalogue/README.md");
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
            means = std::regex_replace(means, std::regex("(spring|damper) '[^']+'"), "$1");
            means = std::regex_replace(means, std::regex("ground axis [xyz](, positive [a-z ]+)?"),
                                       "ground axis");
            EXPECT_TRUE(contains(readme, means))
                << "neither README says: " << means << "\nof " << row;
        }
    }
    EXPECT_GT(rows, 50);
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
                             "Deviation: of the method 'series' from the equilibrium leg"},
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

TEST(Command, CompareWritesTheTableAndTheResult) {
    const Folder folder;
    const Said said = expect_says("compare " + scenes + "/chrono_mcpherson.yaml --steps 20 -o " +
                                      (folder.path / "out").string(),
                                  0);
    EXPECT_TRUE(said.err.empty()) << said.err;  // no progress in a pipe
    expect_parts(said.out, {"branch 'jounce': 0 to 3000 N in 20 steps", "  toe ", "at equal travel",
                            "recursive    converged", "conclusive: "});
    const auto result = nlohmann::json::parse(text_of(folder.path / "out" / "result.json"));
    EXPECT_EQ(result["scenes"][0]["name"], "McPherson strut (generic vehicle of Project Chrono)");
    const std::string curves = text_of(folder.path / "out" / "curves.csv");
    EXPECT_TRUE(
        curves.starts_with("scene,branch,leg,parameter,parameter unit,output,unit,value\n"));
    expect_parts(curves, {",rebound,energy,-3000,N,"});
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
    const auto& tables = result["scenes"][0]["results"][0]["tables"];
    EXPECT_EQ(tables["convergence"]["rows"].size(), 2u * 2 * 2 * 6)
        << "branches, methods, readings, outputs";
    EXPECT_EQ(tables["step_errors"]["rows"].size(), 2u * 2 * 2 * 6 * 5);
    EXPECT_EQ(tables["attribution"]["rows"].size(), 2u * 2 * 6);
    expect_parts(text_of(folder.path / "out" / "convergence.csv"),
                 {"lift,published,at equal load,nose_z,mm,converging,"});
    expect_parts(text_of(folder.path / "out" / "step_errors.csv"),
                 {"lift,published,at equal load,nose_z,mm,320,converged,"});
    expect_parts(text_of(folder.path / "out" / "attribution.csv"),
                 {"lift,at equal load,nose_z,mm,"});
    expect_says("converge " + scenes + "/bushing_pair.yaml --steps 10,20", 2);
    expect_says("converge " + scenes + "/bushing_pair.yaml --method tangnt", 2);
}

}  // namespace
}  // namespace elastocheck
