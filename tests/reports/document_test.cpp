// result.json contains everything that was compared; missing values are explicit.
#include "reports/document/document.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <cmath>

#include "compare/comparison/elements.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/compile.hpp"
#include "reports/document/curves.hpp"
#include "reports/json/json.hpp"
#include "reports/tables/csv.hpp"
#include "reports/tables/render.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

struct Made {
    Scene scene = support::scene("chrono_mcpherson");
    Model model = compile(scene);
    compare::Comparison comparison;

    Made() {
        compare::Options options;
        options.recursion.steps = 12;
        comparison = compare::compare(model, options);
    }
    json document(std::string_view input = "input") const {
        json whole = reports::document("elastocheck compare x", provenance());
        json part = scene_document(scene, input, model);
        add_comparison(part, scene, model, comparison);
        add_verdict(part, comparison.compared, reasons_of(comparison));
        whole["scenes"].push_back(part);
        return whole;
    }
};

TEST(Document, CarriesWhatItTakesToTrustAndReproduceIt) {
    const json d = Made().document();
    const json& s = d["scenes"][0];
    EXPECT_EQ(d["schema"], result_schema);
    EXPECT_EQ(s["input_hash"], input_hash("input"));
    for (const char* key : {"elastocheck", "commit", "compiler", "flags", "cpu"})
        EXPECT_FALSE(d["provenance"][key].get<std::string>().empty()) << key;
    for (const char* key : {"Eigen", "Ceres", "NLopt", "yaml-cpp", "fmt"})
        EXPECT_FALSE(d["provenance"]["libraries"][key].get<std::string>().empty()) << key;
    EXPECT_EQ(s["model"]["unknowns"], 27);
    EXPECT_EQ(s["model"]["idle_modes"].size(), 1u);
    EXPECT_EQ(s["verdict"]["conclusive"], true);
    EXPECT_GT(s["verdict"]["numbers_compared"], 1000);
}

TEST(Document, HoldsEveryPointOfEveryLegAndBothReadings) {
    const Made made;
    const json d = json::parse(made.document().dump());
    const json& s = d["scenes"][0];
    ASSERT_EQ(s["branches"].size(), 2u);
    for (const auto& branch : s["branches"]) {
        EXPECT_EQ(branch["unit"], "N");
        EXPECT_EQ(branch["from"], 0);
        EXPECT_EQ(std::abs(branch["to"].get<double>()), 3000);
        EXPECT_EQ(branch["drivers"]["moved"], json::array({"vertical"}));
        EXPECT_EQ(branch["abscissa"], "travel");
        ASSERT_EQ(branch["legs"].size(), 3u);
        for (const auto& leg : branch["legs"]) {
            EXPECT_EQ(leg["outcome"], "converged");
            EXPECT_EQ(leg["curve"]["a"].size(), 13u);
            for (const auto& channel : s["channels"])
                EXPECT_EQ(leg["curve"]["values"][channel["name"].get<std::string>()].size(), 13u);
            EXPECT_EQ(leg["residuals_by"].size(), 3u);
        }
        // All channels except those that are undefined somewhere on the branch: null.
        const auto compared = std::ranges::count_if(s["channels"], [&](const json& channel) {
            return std::ranges::none_of(branch["legs"], [&](const json& leg) {
                const auto& values = leg["curve"]["values"][channel["name"].get<std::string>()];
                return std::ranges::any_of(values, [](const json& v) {
                    return !v.is_number() || !std::isfinite(v.get<double>());
                });
            });
        });
        for (const char* pair : {"deviation", "cross_check", "reference_uncertainty"})
            for (const char* reading : {"at_equal_parameter", "at_equal_abscissa"})
                EXPECT_EQ(branch[pair][reading]["channels"].size(), compared) << pair << reading;
    }
    const auto& toe = s["branches"][0]["deviation"]["at_equal_parameter"]["channels"]["toe"];
    EXPECT_EQ(toe["max"], made.comparison.branches[0].deviation.equal_parameter.channels[3].max);
    EXPECT_EQ(toe["unit"], "deg");
}

TEST(Document, EveryChannelSaysWhatItIs) {
    const json d = Made().document();
    std::set<std::string> rates;  // of the state and how it answers
    for (const auto& row : d["scenes"][0]["characteristics"]["design"]["rows"])
        rates.insert(row[0].get<std::string>());
    EXPECT_GT(rates.size(), 20u);
    for (const auto& channel : d["scenes"][0]["channels"]) {
        EXPECT_FALSE(channel["definition"].get<std::string>().empty()) << channel;
        EXPECT_EQ(channel["kinematic"], (channel["unit"] == "mm" || channel["unit"] == "deg") &&
                                            !rates.contains(channel["name"].get<std::string>()))
            << channel;
        EXPECT_FALSE(channel.contains("unique")) << channel;
    }
}

TEST(Document, TellsWhatElementsBearAtTheEndsOfTheBranches) {
    const Made made;
    const json whole = json::parse(made.document().dump());
    const auto told = compare::force_rows(made.model, made.comparison);
    EXPECT_EQ(whole["scenes"][0]["forces"], json::parse(table_json(told).dump()));
    const std::string rows = forces_csv(whole, "result.json");
    EXPECT_TRUE(
        rows.starts_with("scene,branch,end,end unit,element,output,unit,value,error,share [%]\n"))
        << rows;
    EXPECT_EQ(std::ranges::count(rows, '\n'), 1 + static_cast<long>(told.size()));
    EXPECT_NE(rows.find(",rebound,-3000,N,K1_coil,K1_coil.force,N,"), std::string::npos) << rows;
}

TEST(Csv, WhatIsUndefinedIsAnEmptyCell) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(
        curves_row("b", compare::Leg::equilibrium, compare::Unit::newton, {2, 0, {1.5, nan, 3}}),
        "b,equilibrium,2,N,1.5,,3\n");
}

TEST(Document, NumbersThatAreNotFiniteAreNull) {
    Made made;
    made.comparison.branches[0].runs[0].curve.values[3][0] =
        std::numeric_limits<double>::quiet_NaN();
    made.comparison.branches[0].deviation.equal_parameter.channels[0].max =
        std::numeric_limits<double>::infinity();
    const json d = json::parse(made.document().dump());
    const json& s = d["scenes"][0];
    EXPECT_TRUE(s["branches"][0]["legs"][0]["curve"]["values"]["wheel_centre_x"][3].is_null());
    EXPECT_TRUE(
        s["branches"][0]["deviation"]["at_equal_parameter"]["channels"]["wheel_centre_x"]["max"]
            .is_null());
}

TEST(Document, InputHashIsFnv1a) {
    EXPECT_EQ(input_hash(""), "cbf29ce484222325");
    EXPECT_EQ(input_hash("a"), "af63dc4c8601ec8c");
    EXPECT_EQ(input_hash("foobar"), "85944171f73967e8");
}

// Three bytes of text, each with its own list: a file of 30 MB would take 2 GB.
TEST(Json, WhatWouldTakeMoreMemoryThanThereIsIsRefusedBeforeItIsParsed) {
    std::string many = "[";
    while (many.size() < 30'000'000) many += "[],";
    many.back() = ']';
    try {
        (void)parse_json(many);
        ADD_FAILURE() << "parsed";
    } catch (const JsonError& error) {
        EXPECT_EQ(std::string(error.what()), "would take about 2.4 GB of memory; allowed: 2 GB");
    }
    std::string text = "[\"";  // brackets within a string are text
    text += many.substr(0, 20'000'000) + "\"]";
    EXPECT_EQ(parse_json(text).size(), 1u);
}

}  // namespace
}  // namespace elastocheck::reports
