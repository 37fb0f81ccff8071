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
    expect_run("report " + strut + " -o " + to + " " + arguments, 0);
    return json::parse(text_of(to + "/result.json"))["scenes"][0];
}

TEST(ReportParts, OnlyKcAndQuickGiveTheKcTablesWithoutAConvergenceStudy) {
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
}

TEST(ProgressLine, HasPercentageRemainingTimeAndWorkAndFitsTheTerminal) {
    EXPECT_EQ(progress_line("jounce", 0.5, 12, 80),
              "[##########----------]  50 %, 12 s left: jounce");
    EXPECT_EQ(progress_line("jounce", 0.5, 12, 0), " 50 %, 12 s left: jounce");
    EXPECT_EQ(progress_line("jounce", 0, 0, 80), "[--------------------]   0 %: jounce");
    EXPECT_EQ(progress_line("a command", NAN, 30, 80), "30 s: a command");
    EXPECT_EQ(progress_line("prüfen", 1, 3, 43), "[####################] 100 %, 0 s left: pr");
    EXPECT_EQ(progress_line("prüfen", 1, 3, 44), "[####################] 100 %, 0 s left: prü");
}

}  // namespace
}  // namespace elastocheck
