// The day of a user with a whole axle: subframe, nonlinear bushings, beam bar, stops, rack or toe links, a trim.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

using nlohmann::json;

struct Axle {
    const char* scene;
    const char* number;  // a hardpoint that moves toe over travel, and its limits [mm]
    double from, to;
    const char* changed;  // another value of it
};

std::string file_of(const Axle& axle) {
    return std::string(ELASTOCHECK_AXLES) + "/" + axle.scene + ".yaml";
}

class Axles : public testing::TestWithParam<Axle> {};

TEST_P(Axles, OneBranchIsReportedAndJudged) {
    const Folder folder;
    const std::string out = (folder.path / "report").string();
    const Said said =
        expect_says("report " + file_of(GetParam()) + " --only kc --branch heave --quiet -o " + out,
                    0, {.not_out = {"Not judged", "nan"}});
    const std::string page = text_of(out + "/report.html");
    EXPECT_GT(page.size(), 10'000u);
    EXPECT_FALSE(contains(page, "Not judged"));
}

TEST_P(Axles, AHardpointIsFoundThatKeepsToeWithinABandOverTravel) {
    const Folder folder;
    const Axle& axle = GetParam();
    const std::string goals = folder.write(
        "goals.yaml",
        "vary: {" + std::string(axle.number) + ": [" + std::to_string(axle.from) + ", " +
            std::to_string(axle.to) +
            "]}\ngoals:\n  - {figure: left.toe, over: left.travel, from: -50, to: 50, points: 3, "
            "change: true, within: [-0.6, 0.6]}\n");
    expect_says("optimise " + file_of(axle) + " " + goals + " --starts 1 --quiet", 0,
                {.out = {"The bands are met", "confirm the values"}});
}

// The curves of a changed axle over travel give the change back.
TEST_P(Axles, AHardpointIsFittedToCurvesOverTravel) {
    const Folder folder;
    const Axle& axle = GetParam();
    const std::string all = (folder.path / "all.csv").string();
    expect_says("solve " + file_of(axle) + " --set " + axle.number + "=" + axle.changed +
                    " --steps 8 --channels left.travel,left.toe,left.camber -o " + all,
                0);
    std::string heave = "branch,left.travel_mm,left.toe_deg,left.camber_deg\n";
    for (const auto& row : cells_of(text_of(all)))
        if (row[0] == "heave") heave += "heave," + row[4] + "," + row[5] + "," + row[6] + "\n";
    const json result = json::parse(expect_says("fit " + file_of(axle) + " --measured " +
                                                    folder.write("rig.csv", heave) + " --vary " +
                                                    axle.number + " --quiet --json",
                                                0)
                                        .out);
    const json numbers = result["scenes"][0]["results"][0]["tables"]["numbers"];
    EXPECT_NEAR(numbers["rows"][0][3].get<double>(), std::stod(axle.changed), 1e-3);
}

TEST_P(Axles, ACandidateOfTheSameStatesIsRight) {
    const Folder folder;
    const std::string candidate = (folder.path / "candidate.csv").string();
    expect_says("solve " + file_of(GetParam()) + " --steps 8 -o " + candidate, 0);
    expect_says("judge " + file_of(GetParam()) +
                    " --steps 8 --tolerance 0.01mm,0.001deg --candidate " + candidate,
                0, {.not_out = {"Not judged"}});
}

INSTANTIATE_TEST_SUITE_P(
    Own, Axles,
    testing::Values(Axle{"front_subframe_axle", "points.tie_inner_left.z", -60, -20, "-37"},
                    Axle{"rear_five_link_axle", "points.toe_inner_left.z", -40, -10, "-24"}),
    [](const auto& at) { return std::string(at.param.scene); });

// Two minutes each.
class WholeAxles : public Axles {};
TEST_P(WholeAxles, WholeReportOfAnAxleIsJudged) {
    const Folder folder;
    expect_says("report " + file_of(GetParam()) + " --quiet -o " + (folder.path / "out").string(),
                0, {.not_out = {"Not judged", "nan"}});
}
INSTANTIATE_TEST_SUITE_P(Nightly, WholeAxles,
                         testing::Values(Axle{"front_subframe_axle", "", 0, 0, ""},
                                         Axle{"rear_five_link_axle", "", 0, 0, ""}),
                         [](const auto& at) { return std::string(at.param.scene); });

}  // namespace
}  // namespace elastocheck
