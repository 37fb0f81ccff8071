// Tables of studies are the same in every format.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "compare/studies/converge.hpp"
#include "compare/studies/work_precision.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/compile.hpp"
#include "reports/page/common.hpp"
#include "reports/render/render.hpp"
#include "reports/text/numbers.hpp"
#include "tests/reports/command.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const compare::Table small{
    {{"who", "", "", true, Digits::words},
     {"how", "", "", true},
     {"error", "mm", "", false, Digits::size},
     {"count", "", "", false, Digits::whole}},
    {{"a, b", "x", 0.1, 3.0}, {"c", "x", nan, 4.0}, {"a, b", "y", 1e-7, 3.0}}};

TEST(Tables, CsvHasAUnitInTheHeaderAndExactNumbers) {
    EXPECT_EQ(csv(small),
              "who,how,error [mm],count\n\"a, b\",x,0.1,3\nc,x,,4\n\"a, b\",y,1e-07,3\n");
}

TEST(Tables, JsonHasNamesUnitsAndNullForAMissingNumber) {
    const json table = json::parse(table_json(small).dump());
    EXPECT_EQ(table["columns"][2], (json{{"name", "error"}, {"unit", "mm"}, {"description", ""}}));
    EXPECT_EQ(table["rows"].dump(),
              R"([["a, b","x",0.1,3.0],["c","x",null,4.0],["a, b","y",1e-07,3.0]])");
}

TEST(Tables, TextTableIsNarrowAndOmitsEmptyColumns) {
    EXPECT_EQ(text(small),
              "  who   error [mm]  count\n"
              "  a, b     1.0e-01      3\n"
              "  c              -      4\n"
              "  a, b     1.0e-07      3\n");
    compare::Table one{small.columns, {small.rows[1]}};
    one.columns[3].heading = "n";
    EXPECT_EQ(text(one), "  who  n\n  c    4\n");
    one.columns[3].place = 0, one.columns[0].place = 3;  // in the order for readers
    EXPECT_EQ(text(one), "  n  who\n  4  c\n");
}

TEST(Tables, PageShowsTheColumnsOfTheTerminal) {
    const compare::Table told{{{"who", "", "", true, Digits::words},
                               {"told", "m", "", false, Digits::given},
                               {"count", "", "", false, Digits::whole, "how many"},
                               {"share", "", "", false, Digits::percent},
                               {"empty", "", "", false, Digits::whole}},
                              {{"a", 1e-6, 12345.0, 0.137, nan}, {"b", 2.5e-6, nan, 1e-3, nan}}};
    const auto page = page_columns(told);
    ASSERT_EQ(page.size(), 4u);
    EXPECT_TRUE(page[0].words && !page[1].words);
    EXPECT_EQ(page[1].heading, "told [m]");
    EXPECT_EQ(page[2].heading, "how many");
    using Cells = std::vector<std::string>;
    EXPECT_EQ(page[0].cells, (Cells{"a", "b"}));
    EXPECT_EQ(page[1].cells, (Cells{number(1e-6, 1), number(2.5e-6, 2)}));
    EXPECT_EQ(page[2].cells, (Cells{whole_number(12345), "–"}));
    EXPECT_EQ(page[3].cells, (Cells{percent(0.137), percent(1e-3)}));
}

TEST(Tables, ChosenColumnsAreShownInTheirOrder) {
    const compare::Table chosen = with_columns(small, {"count", "how", "nothing", "who"});
    ASSERT_EQ(chosen.columns.size(), 3u);
    EXPECT_EQ(text(chosen),
              "  count  how  who\n"
              "      3  x    a, b\n"
              "      4  x    c\n"
              "      3  y    a, b\n");
}

// A page shades the cells of a column by their share of the largest; a detail is not on a terminal.
TEST(Tables, ShadesAndDetailsAreShownOnPagesOnly) {
    compare::Table table{
        {{"who", "", "", true, Digits::words}, {"effect", "", "", false, Digits::shaded}},
        {{"a", 2.0}, {"b", 0.5}, {"c", nan}}};
    EXPECT_EQ(page_columns(table)[1].shades, (std::vector<double>{1, 0.25, 0}));
    EXPECT_TRUE(page_columns(table)[0].shades.empty());
    const json data = page_table(table);
    EXPECT_EQ(data["rows"][1]["cells"][1]["share"], "0.25");
    EXPECT_EQ(data["folded"], false);
    compare::Result result{.tables = {table}};
    expect_parts(text(result), {"effect"});
    result.tables[0].detail = true;
    EXPECT_EQ(text(result), "");
    EXPECT_EQ(page_table(result.tables[0])["folded"], true);
}

TEST(Tables, OrderStudyIsEqualInEveryFormat) {
    const Model model = compile(support::scene("pinned_bar"));
    compare::ConvergenceStudies studies{
        .orders = compare::order_study(
            model, {.orders = {2, 8}, .tolerances = {1e-6, 1e-9}, .points = 5})};
    const auto result = result_of(model, studies);
    EXPECT_EQ(std::ranges::count(csv(whole_table(result, "orders")), '\n'), 1 + 2 * 4);
    const std::string said = text(result);
    for (const auto& branch : studies.orders)
        expect_parts(said, {"branch '" + branch.branch + "'"});
    expect_parts(said, {"tolerance [mm]  order  outcome", "   1e-06      8  converged"});

    studies.orders.front().failure = "the energy leg diverged";
    expect_parts(text(result_of(model, studies)),
                 {"no result to compare with: the energy leg diverged"});
}

TEST(Tables, ConvergenceStudyIsEqualInEveryFormat) {
    const Model model = compile(support::scene("bushing_pair"));
    compare::ConvergenceStudies studies{
        .methods = compare::study(model, {.steps = {20, 40, 80, 160, 320}}),
        .attribution = compare::attribute_gap(model)};
    compare::Study& study = *studies.methods;
    const auto outputs = study_rows(study);
    const auto steps = step_rows(study);
    const auto gaps = gap_rows(study.channels, studies.attribution);
    const std::string said = text(result_of(model, studies));
    for (const char* reading : {"at equal load", "at equal nose_z"}) {
        EXPECT_EQ(distinct(outputs, &compare::StudyRow::reading),
                  distinct(gaps, &compare::GapRow::reading));
        expect_parts(said, {std::string("branch 'lift' ") + reading});
    }
    EXPECT_EQ(json_of(result_of(model, studies))["tables"]["attribution"].dump(),
              table_json(table_of(gaps)).dump());

    std::string beside;  // the step counts stand side by side
    for (const auto& row : steps)
        if (row.branch == "lift" && row.output == "nose_x" && row.reading == "at equal load")
            beside += fmt::format("  {:.1e}", row.largest);
    expect_parts(said, {beside});

    // The error against the reference is step error plus gap; the contributions add up to the gap.
    EXPECT_EQ(steps[0].error, steps[0].end + outputs[0].gap);
    EXPECT_EQ(steps[4].largest, outputs[0].finest_step_error);
    for (const auto& row : gaps) {
        EXPECT_EQ(row.following.front(), row.whole);
        EXPECT_EQ(row.following.back(), row.rest);
        if (std::isfinite(row.lever_share)) {
            EXPECT_NEAR(row.lever_share * row.whole / 100, row.lever, 1e-12 * std::abs(row.whole));
        }
    }

    auto& method = study.branches[0].methods[0];
    method.equal_parameter.clear();
    method.equal_abscissa.clear();
    method.outcomes[1] = Outcome::diverged;
    method.not_studied = "with 40 steps: diverged";
    expect_parts(text(result_of(model, studies)), {"with 40 steps: diverged"});
    EXPECT_EQ(step_rows(study)[1].outcome, "diverged");
}

TEST(Tables, WorkPrecisionTableIsEqualInEveryFormat) {
    Scene scene = support::scene("pendulum");
    for (auto& branch : scene.branches) branch.to *= 2;  // large enough for a diverging row
    const Model model = compile(scene);
    const auto trade =
        compare::trade(model, {.tolerance = {0.01, 0.001}, .max_steps = 640, .rounds = 2});
    ASSERT_TRUE(trade.recommendation);
    const auto result = result_of(model, trade);
    const std::string said = text(result);
    expect_parts(
        said,
        {"the same 10 output points",
         "For 0.01 mm: " + describe(trade.points[trade.recommendation->point]), "diverged"},
        {"error [deg]"});  // a pendulum's outputs are positions

    const auto rows = compare::trade_rows(trade);
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv(table_of(rows)), '\n')),
              trade.points.size() + 1);
    EXPECT_TRUE(rows[trade.recommendation->point].recommended);
    const auto document = json::parse(json_of(result).dump());
    EXPECT_TRUE(document["tables"]["accuracies"]["rows"][0][2].is_null()) << "of angles";
    EXPECT_EQ(document["verdict"]["compared"], trade.recommendation->confirmed_numbers);

    const auto none = compare::trade(model, {.tolerance = {1e-15}, .max_steps = 10, .rounds = 0});
    const std::string unreached = text(result_of(model, none));
    expect_parts(unreached, {"no method reaches it"});
    EXPECT_FALSE(contains(unreached, "ratio\n")) << "no time was taken";
}

}  // namespace
}  // namespace elastocheck::reports
