// The commands solve-for, optimise, fit and tolerances.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

using nlohmann::json;

const std::string springs = scenes + "/parallel_springs.yaml";
const std::string strut = scenes + "/mcpherson.yaml";

json result_in(const Said& said) { return json::parse(said.out)["scenes"][0]["results"][0]; }
json rows_of(const json& result, const char* table) { return result["tables"][table]["rows"]; }
std::string text_of_all(const json& result) { return result["notes"].dump(); }

// ---- solve-for

TEST(SolveForCommand, WritesTheSceneWithOnlyTheNumberChanged) {
    const Folder folder;
    const std::string file = (folder.path / "new.yaml").string();
    expect_says("solve-for " + strut +
                    " --vary points.tie_rod_inner.z=-0.05:0.02 --want bump_steer=0 -o " + file,
                0, {.out = {"All wishes are met", "confirm the values"}, .err = {"Written: "}});
    const auto before = parts_of(text_of(strut), '\n'), after = parts_of(text_of(file), '\n');
    ASSERT_EQ(after.size(), before.size() + 1);
    EXPECT_EQ(after[0], "# Changed by elastocheck solve-for: bump_steer=0");
    int changed = 0;
    for (std::size_t k = 0; k < before.size(); ++k) {
        if (before[k] == after[k + 1]) continue;
        ++changed;
        EXPECT_TRUE(after[k + 1].starts_with("  tie_rod_inner: [-0.300, 0.445, -0.01"))
            << after[k + 1];
        EXPECT_TRUE(after[k + 1].ends_with("]  # points.tie_rod_inner.z was -0.015"))
            << after[k + 1];
    }
    EXPECT_EQ(changed, 1);
    // The result has no bump steer, so that nothing is left to change; its line at the head is
    // replaced.
    const Said again = expect_says(
        "solve-for " + file +
            " --vary points.tie_rod_inner.z=-0.05:0.02 --want bump_steer=0 --json -o " + file,
        0);
    const json result = result_in(again);
    EXPECT_EQ(result["analysis"], "solve-for");
    EXPECT_EQ(result["verdict"]["grade"], "pass");
    EXPECT_LE(std::abs(rows_of(result, "numbers")[0][4].get<double>()), 1e-8);
    EXPECT_EQ(parts_of(text_of(file), '\n').size(), after.size());
}

TEST(SolveForCommand, WishesThatCannotBeMetAreExitCodeOneWithTheConflict) {
    expect_says("solve-for " + springs +
                    " --vary springs.first.rate=10:60 --want centre_z@up:3000=437.5 --want "
                    "centre_z@up:1500=421.4",
                1,
                {.out = {"The wishes cannot be met; these numbers come nearest.",
                         "In conflict: centre_z at up = 3000 N; centre_z at up = 1500 N.",
                         "No limit of a number causes this"}});
    expect_says(
        "solve-for " + springs + " --vary springs.first.rate=20:32 --want centre_z@up:3000=437.5",
        1,
        {.out = {"Out of reach: centre_z at up = 3000 N.",
                 "nearer with springs.first.rate above 32"}});
}

TEST(SolveForCommand, InvalidArgumentsAreRejected) {
    const std::string vary = " --vary springs.first.rate=10:60 ",
                      want = " --want centre_z@up:3000=437";
    expect_says("solve-for " + springs + " --vary springs.frist.rate=10:60" + want, 2,
                {.err = {"--vary 'springs.frist.rate=10:60': the scene has no number "
                         "'springs.frist.rate', did you mean "
                         "'springs.first.rate'?"}});
    expect_says(
        "solve-for " + springs + vary + "--want center_z=1", 2,
        {.err = {
             "--want 'center_z=1': the scene has no output 'center_z', did you mean 'centre_z'?"}});
    expect_says(
        "solve-for " + springs + vary + "--want centre_z@upp:3=1", 2,
        {.err = {"--want 'centre_z@upp:3=1': the scene has no branch 'upp', did you mean 'up'?"}});
    expect_says("solve-for " + springs + vary + "--want centre_z@up:4000=1", 2,
                {.err = {"branch 'up' goes from 0 to 3000 N"}});
    expect_says("solve-for " + springs + vary + "--want centre_z", 2,
                {.err = {"allowed: OUTPUT=VALUE"}});
    expect_says("solve-for " + springs + " --vary springs.first.rate" + want, 2,
                {.err = {"needs limits, =LOW:HIGH"}});
    expect_says("solve-for " + springs + " --vary springs.first.rate=60:10" + want, 2,
                {.err = {"the lower limit is not below the upper one"}});
    expect_says("solve-for " + springs + vary + "--want centre_x=3", 2,
                {.err = {"--want centre_x=3: none of the numbers moves it",
                         "springs.first.rate: no output moves with it"}});
    expect_says("solve-for " + springs + vary + "--want centre_x@up:3000=3", 2,
                {.err = {"springs.first.rate: it moves centre_z, for example, and not centre_x"}});
}

TEST(SolveForCommand, DoesNotOverwriteAFileOfAnother) {
    const Folder folder;
    const std::string mine = folder.write("mine.yaml", "elastocheck: 1\n");
    const Said said = elastocheck_says(
        "solve-for " + springs +
        " --vary springs.first.rate=10:60 --want centre_z@up:3000=437.5 -o " + mine);
    EXPECT_NE(said.code, 0);
    EXPECT_EQ(text_of(mine), "elastocheck: 1\n");
}

// ---- optimise

// Two upright springs: z = 400 + F / (k_1 + k_2) mm. z ≤ 437.5 over the branch asks for k_1 + k_2 ≥
// 80 at its end alone; the smallest change of 30 and 45 over equal ranges is 2.5 each, a change of
// √2 2.5 / 50 of the ranges. 1 mm more needs 80 - 77.92 less.
TEST(OptimiseCommand, WritesTheSceneThatKeepsACurveWithinItsBand) {
    const Folder folder;
    const std::string goals = folder.write(
        "goals.yaml",
        "vary:\n"
        "  springs.first.rate: [10, 60]\n"
        "  springs.second.rate: [20, 70]\n"
        "goals:\n"
        "  - {figure: centre_z, branch: up, from: 0, to: 3000, points: 9, at_most: "
        "437.5}\n"
        "  - {figure: centre_x, branch: up, from: 0, to: 3000, points: 3, within: [-1, "
        "1]}\n");
    const std::string file = (folder.path / "new.yaml").string();
    const std::string line = "optimise " + springs + " " + goals + " --quiet";
    expect_says(
        line + " -o " + file, 0,
        {.out = {"4 of 4 starts end within the bands.",
                 "The bands are met with a change of 7.07 % of the ranges",
                 "centre_z <= 437.5 mm at up = 3000 N         0.1  0.302",
                 "centre_x at up from 0 to 3000 N: within its band, but none of the numbers "
                 "moves it",
                 "springs.first.rate: it moves centre_z, for example, and not centre_x",
                 "confirm the values", "Proved: all "},
         .err = {"Written: "}});
    const std::string text = text_of(file);
    EXPECT_TRUE(text.starts_with("# Changed by elastocheck optimise: "));
    EXPECT_TRUE(contains(text, "# springs.first.rate was 30"));
    const Said said = expect_says(line + " --json", 0);
    const json result = result_in(said);
    EXPECT_EQ(result["analysis"], "optimise");
    EXPECT_NEAR(rows_of(result, "numbers")[0][3].get<double>(), 32.5, 1e-4);
    EXPECT_NEAR(rows_of(result, "numbers")[1][3].get<double>(), 47.5, 1e-4);
    ASSERT_EQ(rows_of(result, "prices").size(), 1u);
    EXPECT_NEAR(rows_of(result, "prices")[0][2].get<double>(), 0.302, 1e-3);
    ASSERT_EQ(rows_of(result, "searches").size(), 4u);
    EXPECT_EQ(expect_says(line + " --json --jobs 1", 0).out.size(), said.out.size());
}

// The least k_1 + k_2 with z ≤ 440 is 75 again; with z ≤ 437.5 at the limit of the second it is all
// in the first.
TEST(OptimiseCommand, MinimisesAFigureAndNamesAConflict) {
    const Folder folder;
    const std::string vary =
        "vary: {springs.first.rate: [10, 60], springs.second.rate: [20, 46]}\n";
    const auto run = [&](const std::string& goals, int code, const Parts& parts) {
        expect_says("optimise " + springs + " " + folder.write("goals.yaml", vary + goals) +
                        " --starts 2 --quiet",
                    code, parts);
    };
    run("goals: [{figure: centre_z@up:3000, at_most: 437.5}]\nminimise: centre_z@down:-3000\n", 0,
        {.out = {"centre_z at down = -3000 N: 362.5 mm from 360",
                 "lowers centre_z at down = -3000 N [mm] by:"}});
    run("goals: [{figure: centre_z@up:3000, at_most: 425}]\n", 1,
        {.out = {"The bands cannot be met; these numbers come nearest.",
                 "Out of reach: centre_z <= 425 mm at up = 3000 N.",
                 "springs.first.rate above 60; springs.second.rate above 46"}});
    run("goals:\n"
        "  - {figure: centre_z@up:3000, at_most: 437.5}\n"
        "  - {figure: centre_z@up:1500, at_least: 421}\n",
        1,
        {.out = {"In conflict: centre_z <= 437.5 mm at up = 3000 N; centre_z >= 421 mm at up = "
                 "1500 N.",
                 "No limit of a number causes this"}});
}

// Over travel a curve lies on both branches; between its points it stays within its band, too.
TEST(OptimiseCommand, KeepsToeOfAStrutWithinABandOverItsTravel) {
    const Folder folder;
    const std::string goals =
        folder.write("goals.yaml",
                     "vary: {points.tie_rod_inner.z: [-0.05, 0.02]}\n"
                     "goals:\n"
                     "  - {figure: toe, over: travel, from: -80, to: 80, points: 5, within: [-0.1, "
                     "0.1]}\n");
    const Said said =
        expect_says("optimise " + strut + " " + goals + " --starts 1 --quiet --json", 0);
    const json result = result_in(said);
    EXPECT_EQ(result["verdict"]["grade"], "pass");
    EXPECT_EQ(rows_of(result, "prices")[0][0], "toe <= 0.1 deg at travel = -80 mm");
    EXPECT_NEAR(rows_of(result, "numbers")[0][3].get<double>(), -0.0125, 1e-4);
    EXPECT_FALSE(contains(text_of_all(result), "Between its points"));
}

// The wheel centre is furthest out at 8 mm of travel, between the two points of the curve.
TEST(OptimiseCommand, AddsPointsWhereACurveLeavesItsBandBetweenItsPoints) {
    const Folder folder;
    const std::string goals =
        folder.write("goals.yaml",
                     "vary: {points.arm_rear.z: [-0.16, -0.12], points.arm_front.z: [-0.18, "
                     "-0.13]}\n"
                     "goals:\n"
                     "  - {figure: wheel_centre_y, over: travel, from: -10, to: 30, points: 2, "
                     "at_most: 1100.02}\n");
    const json result =
        result_in(expect_says("optimise " + strut + " " + goals + " --starts 1 --quiet --json", 0));
    const json goal = rows_of(result, "goals")[0];
    EXPECT_GE(goal[3].get<double>(), 3);
    EXPECT_NEAR(goal[7].get<double>(), 1100.02, 1e-6);
    EXPECT_NE(rows_of(result, "numbers")[0][4].get<double>(), 0);
    const std::string bound = rows_of(result, "prices")[0][0];
    EXPECT_TRUE(bound.starts_with("wheel_centre_y <= 1100.02 mm at travel = ")) << bound;
}

// An arm on a revolute joint, whose branch drives the travel over which a curve lies.
const std::string arm =
    "elastocheck: 1\nname: arm\nunits: {length: mm, angle: deg, force: N}\n"
    "points: {in: [400, 500, 0], c: [0, 750, 0], p: [0, 750, -320]}\n"
    "bodies: {arm: {origin: c}}\n"
    "joints: {in: {type: revolute, bodies: [arm, ground], at: in, axis: [0.2, 1, 0.1]}}\n"
    "branches: {travel: {drive: travel, from: -60, to: 60, steps: 24}}\n"
    "wheel: {body: arm, centre: c, contact_patch: p, contact: carrier, spin_axis: y, side: left}\n";

TEST(OptimiseCommand, TakesACurveOverTheTravelThatItsBranchDrives) {
    const Folder folder;
    const std::string scene = folder.write("arm.yaml", arm);
    for (const auto& [file, goals] :
         {std::pair{scene, std::string("vary: {points.in.z: [-30, 30]}\n"
                                       "goals: [{figure: camber, over: travel, from: -40, to: 40, "
                                       "within: [-1, 1]}]\n")},
          {scenes + "/double_wishbone.yaml",
           "vary: {points.tie_rod_inner.z: [-0.02, 0.02]}\n"
           "goals: [{figure: toe, over: travel, from: -60, to: 60, points: 5, change: true, "
           "within: [-0.2, 0.1]}]\n"}}) {
        const Said said =
            elastocheck_says("optimise " + file + " " + folder.write("goals.yaml", goals) +
                             " --starts 1 --quiet --json");
        ASSERT_LE(said.code, 1) << said.err;
        EXPECT_EQ(rows_of(result_in(said), "numbers").size(), 1u);
    }
}

TEST(OptimiseCommand, RefusesAMistakeWithItsLine) {
    const Folder folder;
    const std::string vary = "vary: {springs.first.rate: [10, 60]}\n";
    const auto complaint = [&](const std::string& text, const std::string& where,
                               const std::string& part) {
        expect_says("optimise " + springs + " " + folder.write("goals.yaml", text) + " --quiet", 2,
                    {.err = {"goals.yaml:" + where, part}});
    };
    complaint("vary: {springs.frist.rate: [10, 60]}\n", "1: vary.springs.frist.rate: ",
              "the scene has no number 'springs.frist.rate', did you mean 'springs.first.rate'?");
    complaint("vary:\n  springs.first.rate: [60, 10]\n", "2: ", "not below the upper");
    complaint("vary:\n  springs.first.rate: [40, 60]\n", "2: ", "is 30 in the scene");
    complaint("vary:\n  springs.first.rate: 40\n", "2: ", "expected a list of 2 limits");
    complaint(vary, "1: ", "neither goals nor a figure");
    complaint("goals: []\n", "1: vary: ", "missing");
    complaint(vary + "goals:\n  - {figure: center_z, within: [1, 2]}\n",
              "3: goals.figure: ", "the scene has no output 'center_z', did you mean 'centre_z'?");
    complaint(vary + "goals:\n  - {figure: centre_z@upp:3, within: [1, 2]}\n",
              "3: ", "the scene has no branch 'upp', did you mean 'up'?");
    complaint(vary + "goals:\n  - {figure: centre_z@up:4000, within: [1, 2]}\n",
              "3: ", "branch 'up' goes from 0 to 3000 N");
    complaint(vary + "goals:\n  - {figure: centre_z, witin: [1, 2]}\n",
              "3: ", "unknown field 'witin', did you mean 'within'?");
    complaint(vary + "goals:\n  - {figure: centre_z}\n", "3: ", "allowed: either within");
    complaint(vary + "goals:\n  - {figure: centre_z, within: [1, 2], at_most: 3}\n",
              "3: ", "allowed: either within");
    complaint(vary + "goals:\n  - {figure: centre_z, within: [2, 1]}\n",
              "3: ", "not below the upper");
    complaint(vary + "goals:\n  - {figure: centre_z, within: [1, 2], branch: up}\n",
              "3: ", "only of a curve");
    complaint(vary + "goals:\n  - {figure: centre_z, within: [1, 2], from: 3}\n", "3: ", "missing");
    complaint(vary +
                  "goals:\n  - {figure: centre_x, over: centre_z, from: 0, to: 500, within: [1, "
                  "2]}\n",
              "3: ", "no branch reaches centre_z = 0");
    complaint(vary + "minimise: center_z\n", "2: minimise: ", "did you mean 'centre_z'");
    // What no number moves: with the reason.
    complaint(vary + "goals:\n  - {figure: centre_x@up:3000, within: [3, 4]}\n",
              "3: goals: ", "springs.first.rate: it moves centre_z, for example, and not centre_x");
    complaint(vary + "minimise: centre_x@up:3000\n",
              "2: minimise: ", "none of the numbers moves it");
}

// ---- fit

TEST(FitCommand, TakesPointsOverTheTravelThatTheBranchDrives) {
    const Folder folder;
    const Said said = expect_says("fit " + folder.write("arm.yaml", arm) +
                                      " --set points.in.z=3 --vary points.in.z" + " --measured " +
                                      folder.write("rig.csv",
                                                   "travel_mm,toe_deg,camber_deg\n"
                                                   "-60,0.86907282346310277,1.4805067754802927\n"
                                                   "0,0,0\n"
                                                   "60,-0.66046268975544742,-1.5751502146793623\n"
                                                   "90,-1,-2\n") +
                                      " --json",
                                  0);
    const json fitted = result_in(said);
    EXPECT_NEAR(rows_of(fitted, "numbers")[0][3].get<double>(), 0, 1e-6) << fitted;
    EXPECT_TRUE(contains(text_of_all(fitted), "1 row that no branch reaches (line 5)"));
}

TEST(FitCommand, FindsTheNumberBehindCurvesOfTheReferences) {
    const Folder folder;
    const std::string csv = (folder.path / "rig.csv").string(),
                      fitted = (folder.path / "fitted.yaml").string();
    expect_says("solve " + strut +
                    " --steps 12 --set points.tie_rod_inner.z=-0.013 --channels "
                    "toe,camber -o " +
                    csv,
                0);
    const Said said = expect_says("fit " + strut + " --measured " + csv +
                                      " --vary points.tie_rod_inner.z --json -o " + fitted,
                                  0);
    const json result = result_in(said);
    EXPECT_EQ(result["analysis"], "fit");
    EXPECT_NEAR(rows_of(result, "numbers")[0][3].get<double>(), -0.013, 1e-9);
    EXPECT_TRUE(contains(text_of(fitted), "# points.tie_rod_inner.z was -0.015"));
}

// Points at travel and as changes, as a rig has them.
TEST(FitCommand, ReadsPointsOverTravel) {
    const Folder folder;
    const std::string csv = (folder.path / "rig.csv").string();
    expect_says("solve " + strut +
                    " --steps 12 --set points.tie_rod_inner.z=-0.013 --channels "
                    "travel,toe > " +
                    csv,
                0);
    std::string rig = "travel_mm,toe_change_deg\n";
    for (const auto& row : cells_of(text_of(csv)))
        if (row[0] == "jounce" || row[0] == "rebound")
            if (row[2] != "0") rig += row[row.size() - 2] + "," + row[row.size() - 1] + "\n";
    const Said said = expect_says("fit " + strut + " --measured " + folder.write("t.csv", rig) +
                                      " --vary 'points.tie_rod_inner.z=-0.03:0' --json",
                                  0);
    EXPECT_NEAR(rows_of(result_in(said), "numbers")[0][3].get<double>(), -0.013, 1e-6);
}

// A file of a rig: names of tests, points by parameter and by travel; rows without use are counted.
TEST(FitCommand, ReadsTheWordsOfARigAndCountsTheRowsThatItLeavesOut) {
    const Folder folder;
    const std::string wishbone = scenes + "/double_wishbone.yaml";
    std::string rig =
        "Test,parameter_mm,Rack Travel [mm],Wheel Travel [mm],Left Toe Angle (arcmin)\n";
    for (const auto& row : cells_of(expect_says("solve " + wishbone +
                                                    " --steps 8 --set points.tie_rod_inner.z=0.003 "
                                                    "--channels toe",
                                                0)
                                        .out)) {
        if (row[0] != "travel" && row[0] != "steering") continue;
        const bool steers = row[0] == "steering";
        rig += (steers ? "Steer,," : "Bounce,") + row[2] + (steers ? ",," : ",,,") +
               std::to_string(60 * std::stod(row[4])) + "\n";
    }
    rig += "Bounce,500,,,1\nBounce,,,500,1\nBounce,,,,2\n";
    const json result =
        result_in(expect_says("fit " + wishbone + " --measured " + folder.write("rig.csv", rig) +
                                  " --vary points.tie_rod_inner.z --json",
                              0));
    EXPECT_NEAR(rows_of(result, "numbers")[0][3].get<double>(), 0.003, 1e-6);
    expect_parts(text_of_all(result), {"2 rows beyond the range of branch 'travel'",
                                       "1 row without a parameter or travel"});
}

TEST(FitCommand, UndeterminedNumbersAreNamedWithExitCodeThree) {
    const Folder folder;
    const std::string csv = (folder.path / "rig.csv").string();
    expect_says("solve " + springs + " --steps 4 --channels centre_z -o " + csv, 0);
    expect_says(
        "fit " + springs + " --measured " + csv + " --vary 'springs.*.rate'", 3,
        {.out = {"not determined",
                 "The data do not determine these changes; what was not measured tells "
                 "them apart:",
                 "springs.first.rate +0.3 N/mm, springs.second.rate -0.3 N/mm", "guide.moment_y"}});
    expect_says("fit " + springs + " --measured " + csv + " --vary 'springs.*.rtae'", 2,
                {.err = {"--vary 'springs.*.rtae': the scene has no number"}});
}

// The travel is driven and the links are rigid, so that its curves do not contain the rate of the
// coil: a load that moves the wheel does.
TEST(FitCommand, ProposesTheLoadCaseThatWouldDetermineANumber) {
    const Folder folder;
    const std::string wishbone = scenes + "/double_wishbone_rigid.yaml";
    const auto lines = parts_of(
        expect_says("solve " + wishbone + " --steps 4 --channels toe,camber", 0).out, '\n');
    std::string rig = lines[0] + "\n";
    for (const auto& line : lines)
        if (line.starts_with("travel,")) rig += line + "\n";
    const Said said =
        expect_says("fit " + wishbone + " --measured " + folder.write("rig.csv", rig) +
                        " --vary springs.coil.rate --json",
                    3);
    const json open = rows_of(result_in(said), "undetermined");
    ASSERT_EQ(open.size(), 1u);
    const std::string at = open[0][2];
    EXPECT_TRUE(at.starts_with("lateral = ") || at.starts_with("vertical = ")) << at;
    EXPECT_GT(open[0][5].get<double>(), 1e-3);
}

// One value in eight is 30 mm off.
TEST(FitCommand, GivesGrossOutliersLittleWeightIfRobust) {
    const Folder folder;
    std::string rig = "branch,load_N,centre_z_mm\n";
    for (int k = 1; k <= 24; ++k) {
        const double z = 400 + 125.0 * k / 80 + (k % 8 == 3 ? 30 : 0) + (k % 2 == 0 ? 0.01 : -0.01);
        rig += "up," + std::to_string(125 * k) + "," + std::to_string(z) + "\n";
    }
    const std::string line = "fit " + springs + " --measured " + folder.write("rig.csv", rig) +
                             " --vary springs.first.rate --json";
    const auto fitted = [&](const std::string& option) {
        const json result = result_in(expect_says(line + option, 0));
        return std::pair(rows_of(result, "numbers")[0], rows_of(result, "outputs")[0]);
    };
    const auto [plain, outputs] = fitted("");
    EXPECT_GT(std::abs(plain[3].get<double>() - 35), 3);
    const auto [robust, marked] = fitted(" --robust");
    EXPECT_NEAR(robust[3].get<double>(), 35, robust[5].get<double>());
    EXPECT_LE(robust[5].get<double>(), 0.05);
    EXPECT_EQ(marked[5].get<double>(), 3);
}

// ---- tolerances

TEST(TolerancesCommand, HasTheClosedFormOfTwoSprings) {
    const Folder folder;
    const std::string file = folder.write("tol.yaml",
                                          "springs.first.rate: {normal: {sd: 0.3}}\n"
                                          "springs.second.rate: {uniform: {half_width: 0.9}}\n"
                                          "correlations:\n"
                                          "  - [springs.first.rate, springs.second.rate, 0.5]\n");
    const Said said =
        expect_says("tolerances " + springs + " " + file + " --of centre_z@up:3000 --json", 0);
    const double rate = 3000 / 75.0 / 75, a = 0.3, b = 0.9 / std::sqrt(3.0);
    const json row = rows_of(result_in(said), "figures")[0];
    EXPECT_NEAR(row[4].get<double>(), rate * std::sqrt(a * a + b * b + a * b), 1e-8);
    EXPECT_NEAR(row[5].get<double>(), rate * (0.9 + 0.9), 1e-8);
    expect_says("tolerances " + springs + " " + file + " --of centre_z@up:3000", 0,
                {.out = {"springs.second.rate", "%"}});
}

// Both sides that err alike are the number of both.
TEST(TolerancesCommand, HasNumbersOfOneSide) {
    const Folder folder;
    const auto scatter = [&](const std::string& name, const std::string& tolerances) {
        const Said said = expect_says("tolerances " + scenes + "/front_axle.yaml " +
                                          folder.write(name, tolerances) +
                                          " --of left.bump_steer@parallel:0 --json",
                                      0);
        return rows_of(result_in(said), "figures")[0][4].get<double>();
    };
    const std::string z = "points.tie_rod_inner_left.z", sd = ": {normal: {sd: 0.0005}}\n";
    const double both = scatter("both.yaml", z + sd);
    EXPECT_GT(both, 0.01);
    const std::string alike = "correlations:\n  - [" + z + "@left, " + z + "@right, 1]\n";
    EXPECT_NEAR(scatter("sides.yaml", z + "@left" + sd + z + "@right" + sd + alike), both,
                1e-9 * both);
}

TEST(TolerancesCommand, RefusesAMistakeWithItsLine) {
    const Folder folder;
    const auto complaint = [&](const std::string& text, const std::string& part) {
        expect_says("tolerances " + springs + " " + folder.write("tol.yaml", text) +
                        " --of centre_z@up:3000",
                    2, {.err = {"tol.yaml:", part}});
    };
    complaint("springs.first.rte: {normal: {sd: 1}}\n", "did you mean 'springs.first.rate'");
    complaint("springs.first.rate: {normal: {sd: 0}}\n", "more than zero");
    complaint("springs.first.rate: {}\n", "one of {normal: {sd: ...}}");
    complaint("springs.first.rate: {normal: {sd: 1}}\ncorrelations: [[springs.first.rate, x, 1]]\n",
              "is not");
    complaint("correlations: []\n", "no tolerance");
}

}  // namespace
}  // namespace elastocheck
