// Tables of studies: complete, and with a reason for every missing number.
#include "compare/tables/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

void expect_whole(const Table& table, std::size_t rows) {
    EXPECT_EQ(table.rows.size(), rows) << table.name;
    std::set<std::string> names;
    for (const auto& column : table.columns)
        EXPECT_TRUE(names.insert(column.name).second) << column.name;
    for (const auto& row : table.rows) {
        ASSERT_EQ(row.size(), table.columns.size()) << table.name;
        for (std::size_t c = 0; c < row.size(); ++c)
            EXPECT_EQ(std::holds_alternative<std::string>(row[c]), table.columns[c].words)
                << table.name << ": " << table.columns[c].name;
    }
}

TEST(Table, EveryStudyIsOneTableWithAsManyCellsAsColumns) {
    const Model model = compile(support::scene("pinned_bar"));
    const auto all = channels(model);
    const auto comparison = compare(model);
    expect_whole(channel_table(all), all.size());
    expect_whole(curve_table(comparison), 3 * (comparison.branches[0].runs[0].curve.a.size() +
                                               comparison.branches[1].runs[0].curve.a.size()));
    expect_whole(deviation_table(comparison), 2 * 2 * all.size());
    expect_whole(agreement_table(comparison), 2);
    expect_whole(rate_table(rate_errors(model, comparison)), 0);
    std::vector<Settled> rest;
    for (const auto& branch : model.branches) rest.push_back(settled(model, all, branch));
    expect_whole(settled_table(all, rest), 2 * 3);
    StudyOptions options;
    options.steps = {5, 10, 20, 40, 80};
    const Study s = study(model, options);
    expect_whole(study_table(s), 2 * 2 * 3);
    expect_whole(step_table(s), 2 * 2 * 3 * 5);
    expect_whole(gap_table(s.channels, attribute_gap(model)), 2 * 2 * 3);
    OrderOptions orders;
    orders.orders = {4, 8};
    orders.tolerances = {1e-6};
    expect_whole(order_table(order_study(model, orders)), 2 * 2);
    PrecisionOptions precision;
    precision.most_steps = 40;
    const auto arithmetic = precision_study(model, precision);
    expect_whole(precision_table(arithmetic), 3 * 3 * 2);
    expect_whole(floor_table(arithmetic), 3 * 3);
    TradeOptions trade_options;
    trade_options.most_steps = 20;
    trade_options.rounds = 0;
    const Trade priced = trade(model, trade_options);
    expect_whole(trade_table(priced), priced.points.size());
}

TEST(Table, WhatIsMissingIsToldInItsRow) {
    // Constant travel: no reading at equal abscissa, and the row gives the reason.
    Scene scene = support::scene("pinned_bar");
    scene.branches.resize(1);
    scene.branches[0].steps = 10;
    const Model model = compile(scene);
    Options options;
    options.abscissa = model.probes.front().name + "_y";
    const Table table = deviation_table(compare(model, options));
    bool told = false;
    for (const auto& row : table.rows)
        told = told || std::get<std::string>(row.back()) == options.abscissa + " does not move";
    EXPECT_TRUE(told);
}

}  // namespace
}  // namespace elastocheck::compare
