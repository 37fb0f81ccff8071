// `elastocheck certify`: output, files and exit codes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/reports/command.hpp"

namespace {

namespace support = elastocheck::support;
using elastocheck::elastocheck_says;
using elastocheck::scenes;
using nlohmann::json;
using support::contains;
using support::Folder;
using support::Said;
using support::text_of;

TEST(CertifyCommand, ProvesTheReferencesAndSaysWhatThatMeans) {
    const Said said = elastocheck_says("certify " + scenes + "/pinned_bar.yaml --points 4");
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_TRUE(contains(said.out, "equilibrium")) << said.out;
    EXPECT_TRUE(contains(said.out, "energy")) << said.out;
    EXPECT_TRUE(contains(said.out, "series")) << said.out;
    EXPECT_TRUE(contains(said.out, "one curve of equilibria is proved from 0 to ")) << said.out;
    EXPECT_TRUE(contains(said.out, "Not proved: that the equations describe the suspension"))
        << said.out;
    EXPECT_TRUE(contains(said.out, "Proved: all ")) << said.out;
}

TEST(CertifyCommand, SaysWhereACurveLeadsOverAStop) {
    const Said said =
        elastocheck_says("certify " + scenes +
                         "/../extremes/stop_that_touches.yaml --method equilibrium --points 4");
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_TRUE(contains(said.out, "from 0 to 2000 N, over corners of laws\n")) << said.out;
    EXPECT_TRUE(contains(said.out, "from 0 to -2000 N\n")) << said.out;
}

TEST(CertifyCommand, APointThatIsProvablyNoneIsABrokenLimit) {
    const Said said = elastocheck_says("certify " + scenes +
                                       "/chrono_mcpherson.yaml --method published --points 4");
    EXPECT_EQ(said.code, 1) << said.out << said.err;
    EXPECT_TRUE(contains(said.out, "Wrong: ")) << said.out;
    EXPECT_TRUE(contains(said.out, "published: excluded at ")) << said.out;
}

// The published recursion's point has an error of 2 mm: the tolerance is fixed before the proof.
TEST(CertifyCommand, TheToleranceIsWhatIsProved) {
    const std::string asks =
        "certify " + scenes + "/pinned_bar.yaml --method equilibrium --points 2 --tolerance ";
    EXPECT_TRUE(
        contains(elastocheck_says(asks + "1e-8mm").out, "equilibria to 1e-08 mm and 1e-06 deg"));
    const Said beyond = elastocheck_says(asks + "1e-14mm,1e-14deg");
    EXPECT_EQ(beyond.code, 3) << beyond.out;
    EXPECT_TRUE(contains(beyond.out, "Not all is proved: ")) << beyond.out;
    const Said wrong = elastocheck_says(asks + "1e-6cm");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_TRUE(contains(wrong.err, "1e-6cm")) << wrong.err;
}

TEST(CertifyCommand, ALimitPointEndsAPathAndIsProved) {
    const Said said = elastocheck_says(
        "certify " + scenes + "/two_spring_arch.yaml --set branches.down.to=-400 --points 4");
    EXPECT_TRUE(contains(said.out, "a limit point is proved, between -211.516594"))
        << said.out << said.err;
}

TEST(CertifyCommand, WritesItsTableAndDocument) {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    const Said said =
        elastocheck_says("certify " + scenes + "/pinned_bar.yaml --points 2 --json -o " + out);
    ASSERT_EQ(said.code, 0) << said.err;
    const json part = json::parse(said.out)["scenes"][0]["certify"];
    EXPECT_GT(part["points"], 0);
    EXPECT_EQ(part["proved"], part["points"]);
    EXPECT_TRUE(part["says"].get<std::string>().starts_with("Proved: all "));
    EXPECT_FALSE(part["ways"]["rows"].empty());
    EXPECT_TRUE(contains(text_of(out + "/certify.csv"), "branch,solver,outcome,points,proved"));
}

}  // namespace
