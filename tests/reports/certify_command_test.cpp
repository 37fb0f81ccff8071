// `elastocheck certify`: output, files and exit codes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

using nlohmann::json;

TEST(CertifyCommand, ProvesTheReferencesAndSaysWhatThatMeans) {
    expect_says(
        "certify " + scenes + "/pinned_bar.yaml --points 4", 0,
        {.out = {"equilibrium", "energy", "series", "one curve of equilibria is proved from 0 to ",
                 "Not proved: that the equations describe the suspension", "Proved: all "}});
}

TEST(CertifyCommand, SaysWhereACurveLeadsOverAStop) {
    expect_says(
        "certify " + scenes + "/../extremes/stop_that_touches.yaml --method equilibrium --points 4",
        0, {.out = {"from 0 to 2000 N, over corners of laws\n", "from 0 to -2000 N\n"}});
}

TEST(CertifyCommand, APointThatIsProvablyNoneIsABrokenLimit) {
    expect_says("certify " + scenes + "/chrono_mcpherson.yaml --method published --points 4", 1,
                {.out = {"Wrong: ", "published: excluded at "}});
}

// The published recursion's point has an error of 2 mm: the tolerance is fixed before the proof.
TEST(CertifyCommand, TheToleranceIsWhatIsProved) {
    const std::string asks =
        "certify " + scenes + "/pinned_bar.yaml --method equilibrium --points 2 --tolerance ";
    expect_parts(elastocheck_says(asks + "1e-8mm").out, {"equilibria to 1e-08 mm and 1e-06 deg"});
    expect_says(asks + "1e-14mm,1e-14deg", 3, {.out = {"Not all is proved: "}});
    expect_says(asks + "1e-6cm", 2, {.err = {"1e-6cm"}});
}

TEST(CertifyCommand, ALimitPointEndsAPathAndIsProved) {
    const Said said = elastocheck_says(
        "certify " + scenes + "/two_spring_arch.yaml --set branches.down.to=-400 --points 4");
    expect_parts(said.out, {"a limit point is proved, between -211.516594"});
}

TEST(CertifyCommand, WritesItsTableAndDocument) {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    const Said said =
        expect_says("certify " + scenes + "/pinned_bar.yaml --points 2 --json -o " + out, 0);
    const json result = json::parse(said.out)["scenes"][0]["results"][0];
    EXPECT_GT(result["verdict"]["compared"], 0);
    EXPECT_EQ(result["verdict"]["grade"], "pass");
    EXPECT_TRUE(result["verdict"]["sentence"].get<std::string>().starts_with("Proved: all "));
    EXPECT_FALSE(result["tables"]["sides"]["rows"].empty());
    expect_parts(text_of(out + "/sides.csv"), {"branch,solver,outcome,points,proved"});
}

}  // namespace
}  // namespace elastocheck
