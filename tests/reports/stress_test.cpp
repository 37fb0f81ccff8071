// The stress test as the command writes it, and the extreme scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "compare/result/result.hpp"
#include "compare/stress/stress.hpp"
#include "reports/extremes/extremes.hpp"
#include "reports/render/render.hpp"
#include "tests/reports/command.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

TEST(StressCommand, PrintsTheDocumentThatItWrites) {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    const auto said = run_elastocheck("stress " + scenes + "/four_bar.yaml --json -o " + out);
    EXPECT_EQ(said.out, text_of(out + "/result.json"));
    const json document = json::parse(said.out);
    const json& result = document["scenes"][0]["results"][0];
    EXPECT_EQ(said.code, result["verdict"]["grade"] == "pass" ? 0 : 1) << said.err;
    const json& map = result["tables"]["map"]["rows"];
    ASSERT_EQ(map.size(), 9u);
    EXPECT_EQ(map[0][1], "as it is");
    EXPECT_EQ(map[0][2].get<std::string>().size(), compare::solvers().size());
    const auto& columns = result["tables"]["cells"]["columns"];
    EXPECT_EQ(columns.size(), 14u);
    EXPECT_TRUE(text_of(out + "/cells.csv").starts_with("scene,sweep,variant,"));
}

TEST(StressCommand, InvalidArgumentsAreRejectedBeforeTheWork) {
    for (const auto& [arguments, says] :
         {std::pair<std::string, const char*>{"stress --set points.tip.x=1", "give one"},
          {"stress there_is_none.yaml", "there_is_none.yaml"}})
        expect_run(arguments, 2, {.err = {says}});
}

TEST(StressCommand, ResultsOfExtremeScenesAreRightOrReportedAsFailed) {
    const auto survival = compare::stress(extremes());
    EXPECT_GT(survival.judged(), 300);
    for (const auto& cell : survival.cells)
        EXPECT_TRUE(cell.verdict != compare::CellVerdict::wrong)
            << fmt::format("{}, {}, {}, {}: {} {}", cell.scene, cell.variant, cell.side,
                           cell.solver, cell.why, cell.detail);
    if (HasFailure()) std::cout << text(result_of(survival));
}

}  // namespace
}  // namespace elastocheck::reports
