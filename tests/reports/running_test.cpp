// Threads, progress and parts of a report, from the command line.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/files/terminal.hpp"
#include "tests/reports/command.hpp"
#include "tests/reports/documents.hpp"

namespace elastocheck {
namespace {

using reports::progress_line;
using reports::result_in;
using json = nlohmann::ordered_json;

const std::string strut = scenes + "/chrono_mcpherson.yaml";

json scene_of(const Folder& folder, const std::string& arguments) {
    const std::string to = (folder.path / "report").string();
    expect_says("report " + strut + " -o " + to + " " + arguments, 0);
    return json::parse(text_of(to + "/result.json"))["scenes"][0];
}

TEST(Running, AReportIsTheSameWithAnyNumberOfThreads) {
    const Folder folder;
    const std::string to = (folder.path / "report").string();
    std::vector<std::string> results, pages;
    for (const char* jobs : {"--jobs 1", "--jobs=3 --quiet"}) {
        expect_says("report " + strut + " -o " + to + " " + jobs, 0);
        results.push_back(text_of(to + "/result.json"));
        pages.push_back(text_of(to + "/report.html"));
    }
    EXPECT_GT(results.front().size(), 10000u);
    expect_parts(results.front(), {}, {"--jobs"});
    for (std::size_t k = 1; k < results.size(); ++k) {
        EXPECT_TRUE(results[k] == results.front()) << k;
        EXPECT_TRUE(pages[k] == pages.front()) << k;
    }
}

TEST(Running, OtherCommandsAreTheSameWithAnyNumberOfThreads) {
    for (const char* command : {"certify", "converge", "gate"}) {
        const std::string call = std::string(command) + " " + scenes + "/pinned_bar.yaml --jobs ";
        const Said one = elastocheck_says(call + "1"), three = elastocheck_says(call + "3");
        EXPECT_EQ(one.code, 0) << one.err;
        EXPECT_EQ(one.out, three.out) << command;
    }
    expect_says("compare " + strut + " --jobs 0", 2);
}

TEST(Running, KinematicsAndComplianceNeedNoStudy) {
    const Folder folder;
    for (const char* arguments : {"--only kc", "--quick"}) {
        const json scene = scene_of(folder, arguments);
        EXPECT_TRUE(result_in(scene, "converge").is_null()) << arguments;
        for (const char* table : {"rates", "compliance", "static", "largest_forces"})
            EXPECT_FALSE(scene["results"][0]["tables"][table]["rows"].empty())
                << arguments << ": " << table;
        EXPECT_EQ(scene["results"][0]["analysis"], "compare") << arguments;
        for (const char* part : {"branches", "drawing", "results", "verdict"})
            EXPECT_TRUE(scene.contains(part)) << arguments << ": " << part;
        // branch, points of, points, proved
        const json proofs = scene["results"][0]["tables"]["proofs"]["rows"];
        const bool quick = arguments == std::string("--quick");
        EXPECT_EQ(proofs.size(), scene["branches"].size() * (quick ? 1 : 3));
        for (const auto& proof : proofs) {
            const auto branch = std::ranges::find_if(
                scene["branches"], [&](const json& b) { return b["name"] == proof[0]; });
            if (!quick) {
                EXPECT_GT(proof[3], 0);
                continue;
            }
            EXPECT_EQ(proof[1], "equilibrium");  // one on each side of the branch
            const int sides = (*branch)["from"] < 0 && (*branch)["to"] > 0 ? 2 : 1;
            EXPECT_EQ(proof[2], sides);
            EXPECT_EQ(proof[3], sides);
        }
        EXPECT_EQ(
            contains(text_of(folder.path / "report/report.md"), "the ends of the branches only"),
            arguments == std::string("--quick"));
    }
    EXPECT_EQ(scene_of(folder, "--only evidence")["results"][1]["analysis"], "converge");
    expect_says("report " + strut + " --only kinematics -o " + (folder.path / "again").string(), 2);
}

TEST(Running, AReportOfSomeBranchesHasTheseAlone) {
    const Folder folder;
    const json scene = scene_of(folder, "--quick --branch rebound");
    ASSERT_EQ(scene["branches"].size(), 1u);
    EXPECT_EQ(scene["branches"][0]["name"], "rebound");
    expect_says("report " + strut + " -o " + (folder.path / "none").string() + " --branch reboud",
                2, {.err = {"has no branch 'reboud', did you mean 'rebound'"}});
}

// Of a scene with a trim too, with the effects of its numbers.
TEST(Running, AReportOfSomeBranchesOfATrimmedSceneHasTheEffectsOfItsNumbers) {
    const Folder folder;
    expect_says("report " + scenes + "/double_wishbone.yaml --only kc --branch travel -o " +
                    (folder.path / "report").string(),
                0);
    const json scene = json::parse(text_of(folder.path / "report/result.json"))["scenes"][0];
    ASSERT_EQ(scene["branches"].size(), 1u);
    const json verdict = result_in(scene, "sensitivity")["verdict"];
    EXPECT_EQ(verdict["grade"], "pass");
    EXPECT_GT(verdict["compared"], 100);
}

TEST(Running, ALineOfProgressSaysShareTimeAndWork) {
    EXPECT_EQ(progress_line("jounce", 0.5, 12, 80),
              "[##########----------]  50 %, 12 s left: jounce");
    EXPECT_EQ(progress_line("jounce", 0.5, 12, 0), " 50 %, 12 s left: jounce");
    EXPECT_EQ(progress_line("jounce", 0, 0, 80), "[--------------------]   0 %: jounce");
    EXPECT_EQ(progress_line("a command", NAN, 30, 80), "30 s: a command");
    EXPECT_EQ(progress_line("prüfen", 1, 3, 43), "[####################] 100 %, 0 s left: pr");
    EXPECT_EQ(progress_line("prüfen", 1, 3, 44), "[####################] 100 %, 0 s left: prü");
}

TEST(Running, ATerminalShowsABarUnlessQuiet) {
    const std::string call =
        std::string(ELASTOCHECK_COMMAND) + " compare " + scenes + "/pinned_bar.yaml";
    const auto on_a_terminal = [](const std::string& line) {
        return support::says("script -qec '" + line + "' /dev/null").out;
    };
    const std::string shown = on_a_terminal(call);
    expect_parts(shown, {"\r\033[K[", " leg"});
    // The bar is gone before the first line of the result.
    expect_parts(shown,
                 {"\r\033[K" +
                  elastocheck_says("compare " + scenes + "/pinned_bar.yaml").out.substr(0, 20)});
    expect_parts(on_a_terminal(call + " --quiet"), {}, {"\033[K"});
}

TEST(Running, WithoutATerminalALineIsWrittenEveryTenSeconds) {
    const std::string call =
        "judge " + scenes + "/pinned_bar.yaml --candidate-command \"sh -c 'sleep 12' {output}\"";
    const Said said = elastocheck_says(call);
    expect_parts(said.err, {"10 s: sh with "});
    EXPECT_EQ(std::ranges::count(said.err, '\r'), 0);
}

}  // namespace
}  // namespace elastocheck
