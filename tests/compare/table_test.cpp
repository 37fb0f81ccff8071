// Tables of studies: complete, and with a reason for every missing number.
#include "compare/tables/rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "compare/studies/study.hpp"
#include "compare/studies/work_precision.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

template <class Row>
void expect_whole(const std::vector<Row>& rows, std::size_t count) {
    const Table table = table_of(rows);
    EXPECT_EQ(table.rows.size(), count);
    std::set<std::string> names;
    for (const auto& column : table.columns)
        EXPECT_TRUE(names.insert(column.name).second) << column.name;
    for (const auto& row : table.rows) {
        ASSERT_EQ(row.size(), table.columns.size());
        for (std::size_t c = 0; c < row.size(); ++c)
            EXPECT_TRUE(table.columns[c].digits == Digits::hidden ||
                        std::holds_alternative<std::string>(row[c]) == table.columns[c].words)
                << table.columns[c].name;
    }
}

TEST(ResultTables, EveryRowHasACellPerColumn) {
    const Model model = compile(support::scene("pinned_bar"));
    StudyOptions options;
    options.steps = {5, 10, 20, 40, 80};
    const Study s = study(model, options);
    expect_whole(study_rows(s), 2 * 2 * 3);
    expect_whole(step_rows(s), 2 * 2 * 3 * 5);
    expect_whole(gap_rows(s.channels, attribute_gap(model)), 2 * 2 * 3);
    TradeOptions trade_options;
    trade_options.max_steps = 20;
    trade_options.rounds = 0;
    const Trade priced = trade(model, trade_options);
    expect_whole(trade_rows(priced), priced.points.size());
}

TEST(ResultTables, RowsAreSelectedByTheirFields) {
    const std::vector rows{StepRow{.branch = "b"}, StepRow{.branch = "c"}, StepRow{.branch = "b"}};
    EXPECT_EQ(where(rows, &StepRow::branch, "c").size(), 1u);
    EXPECT_EQ(distinct(rows, &StepRow::branch), (std::vector<std::string>{"b", "c"}));
}

TEST(ResultTables, MissingValueIsExplainedInItsRow) {
    // A level that did not converge: no numbers, and the row gives the reason.
    const Model model = compile(support::scene("pinned_bar"));
    Study s = study(model, {.steps = {5, 10, 20, 40, 80}});
    auto& method = s.branches[0].methods[0];
    method.equal_parameter.clear();
    method.not_studied = "with 40 steps: diverged";
    const auto row = study_rows(s).front();
    EXPECT_EQ(row.not_studied, "with 40 steps: diverged");
    EXPECT_TRUE(std::isnan(row.gap) && row.output.empty());
    EXPECT_EQ(step_rows(s).front().steps, s.branches[0].steps[0]);
}

}  // namespace
}  // namespace elastocheck::compare
