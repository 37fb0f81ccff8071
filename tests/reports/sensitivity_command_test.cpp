// `elastocheck sensitivity`: output, files and exit codes.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/reports/command.hpp"
#include "tests/reports/documents.hpp"

namespace elastocheck {
namespace {

using json = nlohmann::ordered_json;

TEST(SensitivityCommand, ShowsWhatMovesAnOutputMostAndThatTheLegsAgree) {
    expect_says("sensitivity " + scenes + "/pinned_bar.yaml --of tip_z --to 'points.*' --points 2",
                0,
                {.out = {"up: derivatives at 0 and 5000 N", "tip_z", "points.tip.x", "mm per mm",
                         "the legs agree within 1e-07"}});
}

TEST(SensitivityCommand, RejectsAnUnknownNameWithTheNearest) {
    const std::string asks = "sensitivity " + scenes + "/pinned_bar.yaml ";
    expect_says(asks + "--of tip_zz", 2, {.err = {"--of", "did you mean 'tip_z'"}});
    expect_says(asks + "--to points.tip.u", 2, {.err = {"--to", "did you mean 'points.tip."}});
    expect_says(asks + "--branch upp", 2, {.err = {"--branch", "did you mean 'up'"}});
}

// A characteristic is a derivative itself; its gradient is compared between the legs too.
TEST(SensitivityCommand, DifferentiatesCharacteristicsAtChosenStations) {
    const std::string asks = "sensitivity " + scenes +
                             "/mcpherson.yaml --of bump_steer,wheel_rate,K1_coil.force "
                             "--to points.tie_rod_inner.z --branch jounce ";
    expect_says(asks + "--at jounce:1500,jounce:500", 0,
                {.out = {"jounce: derivatives at 500 and 1500 N", "deg/m per m", "N/mm per m",
                         "K1_coil.force", "the legs agree within 1e-07"}});
    expect_says(asks + "--at jonce:1500", 2, {.err = {"--at", "did you mean 'jounce'"}});
    expect_says(asks + "--at jounce:9000", 2, {.err = {"--at", "goes from 0 to 3000 N"}});
    expect_says(asks + "--at jounce", 2, {.err = {"allowed: BRANCH:VALUE"}});
}

TEST(SensitivityCommand, WritesEveryDerivative) {
    const Folder folder;
    const std::string file = (folder.path / "derivatives.csv").string();
    const Said said = expect_says("sensitivity " + scenes +
                                      "/pinned_bar.yaml --of 'tip_*' --to points.tip.x --points 1 "
                                      "--json --csv " +
                                      file,
                                  0);
    const json result = reports::result_in(json::parse(said.out)["scenes"][0], "sensitivity");
    EXPECT_EQ(result["verdict"]["grade"], "pass");
    EXPECT_EQ(result["tables"]["derivatives"]["rows"].size(),
              2 * 2 * 3);  // sides, stations, outputs
    EXPECT_EQ(result["tables"]["numbers"]["rows"][0][0], "points.tip.x");
    EXPECT_EQ(result["tables"]["agreement"]["rows"].size(), 2 * 3);  // sides, legs
    EXPECT_TRUE(contains(text_of(file), "branch,parameter,unit,output,number,derivative,per"));
}

// A direction that is zero in the scene is varied by a hundredth, not by a tenth of what it multiplies.
TEST(SensitivityCommand, VariesAZeroDirectionByLittle) {
    expect_says("sensitivity " + scenes +
                    "/trailing_arm.yaml --of toe --to loads.vertical.force.y --points 1",
                0, {.out = {"loads.vertical.force.y", "the legs agree within 1e-07"}});
}

// What the trim holds at zero is zero, not 1e-10 of rounding; two legs that differ by rounding agree.
TEST(SensitivityCommand, ShowsAndJudgesRoundingAsZero) {
    const Folder folder;
    const std::string file = (folder.path / "derivatives.csv").string();
    expect_says("sensitivity " + scenes +
                    "/double_wishbone.yaml --of toe --to points.tie_rod_inner.z --branch travel "
                    "--points 1 --csv " +
                    file,
                0, {.out = {"points.tie_rod_inner.z         0      82  deg per m      0"}});
    EXPECT_TRUE(contains(text_of(file), "travel to 80 mm,0,mm,toe,points.tie_rod_inner.z,0,"));
    expect_says("sensitivity " + scenes +
                    "/multi_link.yaml --of aligning_torque_steer --branch aligning --points 1",
                0, {.out = {"the legs agree within 1e-07"}});
}

TEST(SensitivityCommand, NamesEveryLegThatMakesItInconclusive) {
    expect_says("sensitivity " + scenes +
                    "/two_spring_arch.yaml --of apex_z --branch down --set branches.down.to=-400",
                3,
                {.out = {"inconclusive: down: equilibrium leg: limit point: ",
                         "\ninconclusive: down: energy leg: limit point: ",
                         "\ninconclusive: down: series leg: limit point: "}});
    expect_says(
        "sensitivity " + scenes + "/pinned_bar.yaml --of tip_z --to branches.up.steps --points 1",
        3, {.out = {"inconclusive: no derivative was compared"}});
}

// Under a mirror a number of both sides moves an output by the sum of what each side moves it by.
TEST(SensitivityCommand, OfBothSidesIsTheSumOfEach) {
    const Said said =
        expect_says("sensitivity " + scenes +
                        "/front_axle.yaml --of left.toe,right.camber,track --to "
                        "points.tie_rod_outer_left.z,points.lower_ball_left.y,"
                        "'points.tie_rod_outer_left.z@*',points.lower_ball_left.y@left,"
                        "points.lower_ball_left.y@right --branch roll --points 1 --json",
                    0);
    std::map<std::string, std::map<std::string, double>> rates;  // by output and place, by number
    const json table = reports::result_in(json::parse(said.out)["scenes"][0],
                                          "sensitivity")["tables"]["derivatives"];
    std::map<std::string, std::size_t> column;
    for (std::size_t c = 0; c < table["columns"].size(); ++c)
        column[table["columns"][c]["name"]] = c;
    for (const json& row : table["rows"]) {
        const std::string entry = row[column["output"]].get<std::string>() +
                                  row[column["parameter"]].dump() + row[column["branch"]].dump();
        rates[entry][row[column["number"]]] = row[column["derivative"]];
    }
    EXPECT_GE(rates.size(), 3);
    for (const auto& [entry, by] : rates)
        for (const std::string number :
             {"points.tie_rod_outer_left.z", "points.lower_ball_left.y"}) {
            const double both = by.at(number), left = by.at(number + "@left"),
                         right = by.at(number + "@right");
            EXPECT_NEAR(left + right, both, 1e-6 * (std::abs(left) + std::abs(right)) + 1e-9)
                << entry;
        }
}

// A number that decides which parts there are, or counts, has no derivative: the entry says so.
TEST(SensitivityCommand, SaysWhyThereIsNoDerivative) {
    expect_says("sensitivity " + scenes +
                    "/pinned_bar.yaml --of tip_z --to branches.up.steps,points.tip.x --points 1",
                0, {.out = {"no derivative: ", "branches.up.steps"}});
}

// Steps are counts: without --to they are no reason why a derivative is missing.
TEST(SensitivityCommand, LeavesOutCountsThatAreNotAskedFor) {
    expect_says("sensitivity " + scenes + "/pinned_bar.yaml --of tip_z --points 1 --most 0", 0,
                {.out = {"points.tip.x"}, .not_out = {"steps", "no derivative"}});
}

}  // namespace
}  // namespace elastocheck
