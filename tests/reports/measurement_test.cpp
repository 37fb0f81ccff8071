// Measured curves: read, refused, compared.
#include "reports/document/measurement.hpp"

#include <gtest/gtest.h>

#include "models/compile.hpp"
#include "reports/page/sections/sections.hpp"
#include "tests/reports/result.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

struct Solved {
    Model model = compile(support::scene("mcpherson"));
    compare::Comparison comparison;
    Solved() {
        compare::Options options;
        options.recursion.steps = 40;
        comparison = compare::compare(model, options);
    }
};
const Solved& solved() {
    static const Solved once;
    return once;
}

json measured(const std::string& csv) {
    json scene = json::object();
    add_measurement(scene, csv, "kc.csv", solved().model, solved().comparison);
    return scene["measured"];
}

std::string refusal(const std::string& csv) {
    try {
        (void)measured(csv);
    } catch (const MeasurementError& error) {
        return error.what();
    }
    return "read";
}

TEST(Measurement, OfTheEquilibriumItselfIsMetByBothReferencesAndMissedByTheRecursion) {
    std::string csv = "load_N, travel_mm, toe_deg, wheel_centre_y_change_mm\n";
    for (const auto& branch : solved().comparison.branches) {
        const auto& curve = branch.runs[1].curve;
        for (std::size_t k = 5; k < curve.load.size(); k += 5)
            csv += std::to_string(curve.load[k]) + "," + std::to_string(curve.travel[k]) + "," +
                   std::to_string(curve.values[k][3]) + "," +
                   std::to_string(curve.values[k][1] - curve.values[0][1]) + "\n";
    }
    const json m = measured(csv);
    EXPECT_EQ(m["points"], 16);
    ASSERT_EQ(m["readings"].size(), 2u);
    for (const auto& reading : m["readings"])
        for (const auto& row : reading["channels"]) {
            EXPECT_EQ(row["compared"],
                      reading["reading"] == "at equal load" ? 16 : row["compared"].get<int>());
            EXPECT_GE(row["compared"], 14);
            for (const char* leg : {"equilibrium", "energy"})
                EXPECT_LE(std::abs(row[leg]["signed_max"].get<double>()), 2e-6)
                    << row;  // six decimals in the file
        }
    const auto& load = m["readings"][0]["channels"][0];
    const auto& expected = solved().comparison.branches[0].deviation.equal_parameter.channels[3];
    EXPECT_NEAR(std::abs(load["recursive"]["signed_max"].get<double>()), expected.max, 1e-5);
}

TEST(Measurement, IsDrawnOverTheCurvesAndComparedInASectionOfItsOwn) {
    json result = sample_result();
    result["scenes"][0]["measured"] = measured("travel_mm,toe_deg\n-50,1.4\n50,-1.8\n");
    const std::string file = "result.json";
    bool section = false, drawn = false, fourth = false;
    for (const auto& s : sections_of(Field{&result["scenes"][0], "scenes[0]", &file})) {
        section = section || s.id == "measured";
        for (const auto& group : s.figures)
            for (const auto& figure : group.figures) {
                const auto& table = group.table;
                if (figure.title == "Toe angle")
                    fourth = table.columns.back().name == "measured" && table.rows.front().back() == "–" &&
                             table.rows[table.rows.size() / 2].back() == "−0.20000";
                for (const auto& series : figure.series)
                    drawn = drawn || (series.title == "measured" && figure.title == "Toe angle" &&
                                      series.rows.size() == 2);
            }
    }
    EXPECT_TRUE(section);
    EXPECT_TRUE(drawn);
    EXPECT_TRUE(fourth);
}

TEST(Measurement, WhatIsWrongIsRefusedWithItsPlace) {
    struct Case {
        const char *csv, *why;
    };
    for (const auto& [csv, why] :
         {Case{"", "kc.csv: empty; the first line names the columns"},
          Case{"travel_mm,toe_deg\n", "kc.csv: no point in it"},
          Case{"travel_mm,tow_deg\n1,2\n", "kc.csv:1: unknown column 'tow_deg', did you mean 'toe_deg'?"},
          Case{"travel_mm,toe_rad\n1,2\n",
               "kc.csv:1: unknown column 'toe_rad'; allowed: travel_mm, load_N, branch,"},
          Case{"toe_deg\n1\n",
               "kc.csv:1: neither 'travel_mm' nor 'load_N'; one of them says where a point is"},
          Case{"travel_mm,load_N\n1,2\n", "kc.csv:1: no output among the columns"},
          Case{"travel_mm,toe_deg,toe_deg\n1,2,3\n", "kc.csv:1: column 'toe_deg' stands there twice"},
          Case{"travel_mm,toe_deg\n1,2\n3\n", "kc.csv:3: 1 cells, but 2 columns are named in the first line"},
          Case{"travel_mm,toe_deg\n1,nan\n", "kc.csv:2: toe_deg: 'nan' is not a number"},
          Case{"travel_mm,toe_deg\n1,\"2,5\"\n", "kc.csv:2: 3 cells"},
          Case{"branch,travel_mm,toe_deg\njonce,1,2\n",
               "kc.csv:2: branch: the scene has no 'jonce', did you mean 'jounce'?"}})
        EXPECT_TRUE(refusal(csv).starts_with(why)) << refusal(csv) << "\nexpected: " << why;
}

TEST(Measurement, PointsOutsideTheRangeAreNotCompared) {
    const json m = measured("travel_mm,toe_deg\n1e4,0\n50,\n");
    EXPECT_EQ(m["readings"][0]["channels"][0]["compared"], 0);
    EXPECT_TRUE(json::parse(m.dump())["readings"][0]["channels"][0]["energy"]["signed_max"].is_null());
}

}  // namespace
}  // namespace elastocheck::reports
