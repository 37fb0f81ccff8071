// Tables of a trade: text, CSV and JSON say the same.
#include "reports/tables/trade_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "compare/trade.hpp"
#include "models/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

Model shipped(const std::string& name, double load = 1) {
    Scene scene = support::scene(name);
    for (auto& branch : scene.branches) branch.to *= load;
    return compile(scene);
}

TradeOptions quick(Tolerance tolerance, int most_steps = 160) {
    TradeOptions options;
    options.tolerance = tolerance;
    options.most_steps = most_steps;
    options.rounds = 2;
    return options;
}

TEST(TradeTables, TextCsvAndJsonSayTheSame) {
    const Model model = shipped("pendulum", 2);
    const Trade result = trade(model, quick({0.01, 0.001}, 640));
    ASSERT_TRUE(result.recommendation);
    const std::string text = reports::trade_table(model, result), csv = reports::trade_csv(result);
    EXPECT_NE(text.find("the same 10 output points"), std::string::npos);
    EXPECT_NE(text.find("For 0.01 mm: " + describe(result.points[result.recommendation->point])),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("diverged"), std::string::npos);
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')), result.points.size() + 1);
    const auto json = nlohmann::ordered_json::parse(reports::trade_json(result).dump());
    EXPECT_EQ(json["points"].size(), result.points.size());
    EXPECT_TRUE(json["tolerance"]["deg"].is_null());
    EXPECT_EQ(json["recommendation"]["position"], result.recommendation->point);
    for (std::size_t k = 0; k < result.points.size(); ++k)
        EXPECT_EQ(json["points"][k]["error"]["mm"].is_null(), std::isnan(result.points[k].error.mm)) << k;

    const Trade none = trade(model, quick({1e-15}, 10));
    EXPECT_NE(reports::trade_table(model, none).find("nothing here reaches it"), std::string::npos);
    EXPECT_TRUE(reports::trade_json(none)["recommendation"].is_null());
}

}  // namespace
}  // namespace elastocheck::compare
