// `elastocheck certify`: output, files and exit codes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

using nlohmann::json;

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
