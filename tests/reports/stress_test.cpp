// Survival map in all output formats, and the extreme scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include <nlohmann/json.hpp>

#include "reports/extremes/extremes.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/page/report/report.hpp"
#include "reports/tables/studies/stress_tables.hpp"
#include "tests/reports/command.hpp"
#include "tests/reports/result.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

const char* const map = R"({
  "solvers": ["published", "series"], "sweeps": ["as it is", "far <away>"],
  "map": [{"scene": "arch", "signs": ["39", "X!"]}],
  "extremes": [{"scene": "column", "variant": "straight | so", "signs": "?~"}],
  "counts": {"right": 3, "unpromised": 1, "honest": 1, "elsewhere": 1, "unjudged": 1, "wrong": 1},
  "wrong": [{"scene": "arch", "variant": "far", "way": "down", "solver": "published", "why": "off by 2 mm"}],
  "skipped": []})";

TEST(Survival, TheMapIsOnThePageAndInItsTwin) {
    const Folder folder;
    auto result = small_result();
    write_report(result, "result.json", folder.path / "without");
    expect_parts(text_of(folder.path / "without" / "report.html"), {},
                 {"Stress test: extreme scenes"});
    result["stress"] = json::parse(map);
    write_report(result, "result.json", folder.path / "with");
    const std::string html = text_of(folder.path / "with" / "report.html"),
                      markdown = text_of(folder.path / "with" / "report.md");
    expect_parts(
        html, {"<b class=\"some\">3</b><b class=\"many\">9</b>",
               "<b class=\"wrong\">X</b><b class=\"failed\">!</b>",
               "<b class=\"unknown\">?</b><b class=\"elsewhere\">~</b>", "Of 8 results 3 are right",
               "1 are wrong", "far &lt;away&gt;", "off by 2 mm"});
    expect_parts(markdown, {"| arch | `39` | `X!` |", "`?~`", "straight \\| so", "off by 2 mm"});
}

TEST(Survival, ASignThatIsNoneIsRefused) {
    const Folder folder;
    for (const char* signs : {"3", "39!", "3`", "3<"}) {
        auto result = small_result();
        result["stress"] = json::parse(map);
        result["stress"]["map"][0]["signs"][1] = signs;
        EXPECT_THROW(write_report(result, "result.json", folder.path / "r"), ResultError) << signs;
    }
}

TEST(Survival, OfTheCommandIsWhatItWrites) {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    const auto said = elastocheck_says("stress " + scenes + "/four_bar.yaml --json -o " + out);
    EXPECT_EQ(said.out, text_of(out + "/stress.json"));
    const json document = json::parse(said.out);
    EXPECT_EQ(said.code, document["wrong"].empty() ? 0 : 1) << said.err;
    EXPECT_EQ(document["schema"], "elastocheck/stress/2");
    EXPECT_EQ(document["map"][0]["signs"].size(), document["sweeps"].size());
    const auto& columns = document["cells"]["columns"];
    EXPECT_EQ(columns.size(), 15u);
    EXPECT_TRUE(text_of(out + "/cells.csv").starts_with("scene,sweep,variant,"));
    EXPECT_EQ(document["counts"]["wrong"], document["wrong"].size());
    const auto report =
        elastocheck_says("report " + scenes + "/single_bushing.yaml --stress " + out +
                         "/stress.json -o " + (folder.path / "page").string());
    expect_parts(text_of(folder.path / "page" / "report.html"), {"Survival map"});
}

TEST(Survival, WhatCannotBeAskedIsRefusedBeforeTheWork) {
    for (const auto& [arguments, says] :
         {std::pair<std::string, const char*>{"stress --set points.tip.x=1", "give one"},
          {"stress there_is_none.yaml", "there_is_none.yaml"},
          {"report " + scenes + "/single_bushing.yaml -o never --stress " + scenes +
               "/single_bushing.yaml",
           "single_bushing.yaml"},
          {"report --from a.json -o never --stress b.json", "--stress: not with --from"}})
        expect_says(arguments, 2, {.err = {says}});
}

TEST(Survival, ScenesThatAreExtremeByTheirMakingAreRightOrHonest) {
    const auto survival = compare::stress(extremes());
    EXPECT_GT(survival.judged(), 300);
    for (const auto& cell : survival.cells)
        EXPECT_TRUE(cell.verdict != compare::Verdict::wrong)
            << fmt::format("{}, {}, {}, {}: {} {}", cell.scene, cell.variant, cell.side,
                           cell.solver, cell.why, cell.detail);
    if (HasFailure()) std::cout << stress_text(survival);
}

}  // namespace
}  // namespace elastocheck::reports
