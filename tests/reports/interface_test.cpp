// Command-line interface for programs: --json, --version.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

using nlohmann::json;

const std::string bushing = scenes + "/single_bushing.yaml";

// ---- --json

// The single document on standard output.
json document(const std::string& arguments, int code = 0) {
    const RunResult said = expect_run(arguments + " --json", code);
    json parsed = json::parse(said.out, nullptr, false);
    EXPECT_FALSE(parsed.is_discarded()) << arguments << ": " << said.out.substr(0, 300);
    return parsed;
}

TEST(Json, NewListsAndPrintsTheFilesOfTheBuiltInScenes) {
    const json templates = document("new");
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scenes))
        files += entry.path().extension() == ".yaml";
    EXPECT_EQ(templates["templates"].size(), files);
    EXPECT_EQ(document("new pendulum")["templates"][0]["text"], text_of(scenes + "/pendulum.yaml"));
}

TEST(Json, SolveDocumentHasTheNumbersOfTheCsv) {
    const json part = document(
        "solve " + bushing + " --steps 4 --method equilibrium --channels 'centre_*'")["scenes"][0];
    const auto cells =
        cells_of(run_elastocheck("solve " + bushing +
                                 " --steps 4 --method equilibrium --channels 'centre_*'")
                     .out);
    std::size_t row = 1;
    for (const auto& branch : part["branches"]) {
        const auto& leg = branch["legs"][0];
        EXPECT_EQ(leg["leg"], "equilibrium");
        EXPECT_EQ(leg["outcome"], "converged");
        for (std::size_t k = 0; k < leg["curve"]["a"].size(); ++k, ++row) {
            EXPECT_EQ(leg["curve"]["a"][k].get<double>(), std::stod(cells[row][2]));
            EXPECT_EQ(leg["curve"]["values"]["centre_z"][k].get<double>(),
                      std::stod(cells[row].back()));
        }
    }
    EXPECT_EQ(row, cells.size());
    EXPECT_EQ(part["channels"].size(), 3u);
    const json& solved = part["results"][0];
    EXPECT_EQ(solved["verdict"]["reasons"], json::array());
    EXPECT_EQ(solved["tables"]["legs"]["rows"].size(), part["branches"].size());
}

// ---- --version, --help

// Commit recorded by the build for the sources in a folder.
std::string commit_of(const std::string& folder) {
    expect_result(support::shell("cmake -D SOURCE=" + folder + " -D OUTPUT=" + folder + "/out -P " +
                                 folder + "/reports/files/build_info.cmake"),
                  0);
    std::smatch found;
    const std::string text = text_of(folder + "/out");
    return std::regex_search(text, found, std::regex("commit = \"([^\"]*)\"")) ? found[1].str()
                                                                               : "";
}

TEST(Version, CommitIsThatOfTheArchiveAndNeverThatOfASurroundingRepository) {
    const std::string root = scenes + "/../..", git = "git -c safe.directory='*' -C " + root + " ";
    const RunResult head = support::shell(git + "rev-parse --show-prefix HEAD");
    if (!head.out.starts_with("\n")) GTEST_SKIP() << "not a checkout of its own";
    const std::string commit = head.out.substr(1, 40);
    const Folder around;
    const std::string archive = (around.path / "archive").string(),
                      copy = (around.path / "copy").string();
    ASSERT_EQ(
        support::shell(
            "cd " + around.path.string() +
            " && mkdir -p archive copy/reports/files && git init -q && " + git +
            "archive HEAD .gitattributes reports/files/build_info.cmake | tar x -C archive && cp " +
            root +
            "/reports/files/build_info.cmake copy/reports/files/ && git add copy && git -c "
            "user.name=t -c user.email=t@example.org commit -q -m x")
            .code,
        0);
    EXPECT_EQ(commit_of(archive), commit);
    EXPECT_EQ(commit_of(copy), "unknown") << "the checkout around it is somebody else's";
}

}  // namespace
}  // namespace elastocheck
