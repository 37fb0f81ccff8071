// Measured curves: reading, rejection, comparison.
#include "reports/given/measurement.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compare/candidate/measured.hpp"
#include "elastocheck/compile.hpp"
#include "reports/document/document.hpp"
#include "reports/files/limits.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/measured.hpp"
#include "reports/render/render.hpp"
#include "tests/reports/command.hpp"
#include "tests/reports/result.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

struct Solved {
    Scene scene;
    Model model = compile(scene);
    compare::Comparison comparison;
    compare::DefinedCurves defined;

    Solved(Scene scene_, int steps, const char* method = "published") : scene(std::move(scene_)) {
        compare::Options options;
        options.recursion.method = recursive::find_method(method).value();
        options.recursion.steps = steps;
        comparison = compare::compare(model, options);
        defined = compare::defined_curves(model, comparison);
    }
    const compare::Curve& curve(const std::string& branch) const {
        return comparison.branch(branch).run(compare::Leg::equilibrium).curve;
    }
    // Of the equilibrium leg at a point of a branch.
    double value(const std::string& branch, const char* output, std::size_t k) const {
        return curve(branch)
            .values[k][static_cast<std::size_t>(find_channel(comparison.channels, output))];
    }
    Measured typed(const std::string& csv, const ColumnMap& map = {},
                   const std::vector<std::string>& only = {}) const {
        return compare_measurement(model, comparison, defined,
                                   read_measurement(csv, "kc.csv", model, map, only));
    }
    json measured(const std::string& csv, const ColumnMap& map = {},
                  const std::vector<std::string>& only = {}) const {
        const Measured found = typed(csv, map, only);
        json readings = json::array();
        for (const auto& reading : found.found.readings)
            readings.push_back(objects(table_json(deviation_table(found, reading, comparison))));
        json columns, branches = json::array();
        const compare::Points& points = found.measurement.table.points;
        if (points.abscissa) columns[comparison.channels[*points.abscissa].name] = points.at;
        for (const auto& column : found.found.columns)
            columns[comparison.channels[column.channel].name] = column.values;
        for (const auto& place : found.found.places) {
            const auto b = static_cast<std::size_t>(place.branch);
            branches.push_back(place.branch < 0 ? "" : comparison.branches[b].branch);
        }
        return {{"columns", columns},
                {"branch", branches},
                {"readings", readings},
                {"loops", objects(table_json(loop_table(found, comparison)))},
                {"findings", found.found.explanations},
                {"left_out", found.left_out},
                {"points", found.measurement.table.lines.size()}};
    }
};
const Solved& solved() {
    static const Solved once(support::scene("chrono_mcpherson"), 40);
    return once;
}
json measured(const std::string& csv, const ColumnMap& map = {}) {
    return solved().measured(csv, map);
}

SceneAnalyses sample_with(Measured measured, const char* name = "chrono_mcpherson") {
    SceneAnalyses scene = sample_scene(name);
    scene.measured = std::move(measured);
    return scene;
}

TEST(Measurement, AsManyPointsAsTheLimitAreRead) {
    std::string csv = "load_N,toe_deg\n";
    for (std::size_t k = 0; k < max_measured_points; ++k) csv += "5e9,0\n";  // none within range
    EXPECT_EQ(measured(csv)["points"], max_measured_points);
}

TEST(Measurement, PointsOfTheEquilibriumLegAgreeWithReferencesAndNotWithTheRecursion) {
    std::string csv = "load_N, travel_mm, toe_deg, wheel_centre_y_change_mm\n";
    for (const char* branch : {"jounce", "rebound"})
        for (std::size_t k = 5; k < solved().curve(branch).a.size(); k += 5)
            csv +=
                fmt::format("{:.6f},{:.6f},{:.6f},{:.6f}\n", solved().curve(branch).a[k],
                            solved().value(branch, "travel", k), solved().value(branch, "toe", k),
                            solved().value(branch, "wheel_centre_y", k) -
                                solved().value(branch, "wheel_centre_y", 0));
    const json m = measured(csv);
    EXPECT_EQ(m["points"], 16);
    ASSERT_EQ(m["readings"].size(), 2u);
    for (const auto& reading : m["readings"])
        for (const auto& row : reading) {
            EXPECT_EQ(row["points"],
                      row["reading"] == "at equal load" ? 8 : row["points"].get<int>());
            EXPECT_GE(row["points"], 7);
            for (const char* leg : {"equilibrium", "energy"})
                EXPECT_LE(std::abs(row[std::string(leg) + " max"].get<double>()), 2e-6)
                    << row;  // six decimals in the file
        }
    const auto& load = m["readings"][0][0];
    const auto& expected = solved().comparison.branches[0].deviation.equal_parameter.channels[3];
    EXPECT_NEAR(std::abs(load["recursive max"].get<double>()), expected.max, 1e-5);
}

TEST(Measurement, PointsAreDrawnOverCurvesAndComparedInASection) {
    const SceneAnalyses scene =
        sample_with(solved().typed("travel_mm,toe_deg\n-50,1.4\n50,-1.8\n"));
    bool section = false, drawn = false;
    for (const auto& s : sections_of(scene)) {
        section = section || s.id == "measured";
        for (const auto& group : s.figures)
            for (const auto& figure : group.figures)
                for (const auto& series : figure.series)
                    drawn =
                        drawn || (series.title == "measured" &&
                                  figure.title.starts_with("Toe angle") && series.rows.size() == 2);
    }
    EXPECT_TRUE(section);
    EXPECT_TRUE(drawn);
}

// ---- Rigs.

const Solved& axle() {
    static const Solved once(support::scene("front_axle"), 10, "series");
    return once;
}

TEST(Measurement, TestAndColumnNamesOfARigAreRecognised) {
    std::string csv =
        "Test,Wheel Travel LH [mm],Lateral Force (kN),Braking Force (kN),Toe LH (arc-minutes),"
        "Right Camber Angle [deg],Oil Temperature\n";
    for (const auto& [test, branch] : {std::pair{"Bounce", "parallel"},
                                       {"Lateral - opposed", "lateral"},
                                       {"BRAKING", "braking"}}) {
        const auto& curve = axle().curve(branch);
        for (std::size_t k = 0; k < curve.a.size(); k += 3)
            csv += fmt::format("{},{:.7f},{:.7f},{:.7f},{:.7f},{:.7f},20\n", test,
                               axle().value(branch, "left.travel", k),
                               branch == std::string("lateral") ? curve.a[k] / 1e3 : 0.1234,
                               branch == std::string("braking") ? curve.a[k] / 1e3 : 0.4321,
                               60 * axle().value(branch, "left.toe", k),
                               axle().value(branch, "right.camber", k));
    }
    const json m = axle().measured(csv);
    EXPECT_EQ(m["left_out"], json::array({"Oil Temperature"}));
    ASSERT_EQ(m["readings"].size(), 2u);
    const auto& by_load = m["readings"][0];
    ASSERT_EQ(by_load.size(), 4u) << by_load;  // each of two tests by its own force
    EXPECT_EQ(by_load[0]["output"], "left.toe");
    EXPECT_EQ(by_load[3]["output"], "right.camber");
    for (const auto& reading : m["readings"])
        for (const auto& row : reading) {
            EXPECT_GE(row["points"], 4) << row;
            EXPECT_LE(std::abs(row["equilibrium max"].get<double>()), 1e-5) << row;
        }
    EXPECT_TRUE(m["findings"].empty()) << m["findings"];
    EXPECT_TRUE(m["loops"].empty());
}

// A loop of known width about the curve: the mean of both ways is the curve.
TEST(Measurement, MeanOfBothDirectionsOfALoopIsCompared) {
    const auto& curve = solved().curve("jounce");
    const auto point = [&](std::size_t k, double half) {
        return fmt::format("jounce,{:.6f},{:.7f}\n", curve.a[k],
                           solved().value("jounce", "toe", k) + half);
    };
    std::string csv = "branch,load_N,toe_deg\n";
    const std::size_t last = curve.a.size() - 1;
    for (std::size_t k = 0; k < last; k += 2) csv += point(k, 0.02);
    csv += point(last, 0);
    for (std::size_t k = last - 2;; k -= 2) {
        csv += point(k, -0.02);
        if (k < 2) break;
    }
    const json m = measured(csv);
    ASSERT_EQ(m["loops"].size(), 1u) << m["loops"];
    // columns that other tests need do not hide it
    std::string wider = "Aligning Torque [Nm],";
    for (const char c : csv) wider += c == '\n' ? std::string("\n,") : std::string(1, c);
    wider.pop_back();
    EXPECT_EQ(measured(wider)["loops"], m["loops"]);
    EXPECT_EQ(m["loops"][0]["output"], "toe");
    EXPECT_NEAR(m["loops"][0]["width"].get<double>(), 0.04, 2e-4);
    const auto& row = m["readings"][0][0];
    // next to the turning point the polygon of the other way ends in the point without width
    EXPECT_LE(row["equilibrium rms"].get<double>(), 0.004) << row;
    const json one_way = measured(csv.substr(0, csv.rfind('\n', csv.size() / 2) + 1));
    EXPECT_GE(one_way["readings"][0][0]["equilibrium rms"].get<double>(), 0.015);
    EXPECT_TRUE(one_way["loops"].empty());
}

// Friction of a rig: the wheel load is 100 N more on the way up, 100 N less on the way down.
TEST(Measurement, WheelLoadIsComparedAndItsHysteresisReported) {
    const auto points = std::ssize(axle().curve("parallel").a);
    std::string csv = "Test,Wheel Travel LH [mm],Wheel Load LH [N],Wheel Load RH [kN]\n";
    const auto point = [&](std::ptrdiff_t at, double friction) {
        const auto k = static_cast<std::size_t>(at);
        csv +=
            fmt::format("Bounce,{:.6f},{:.3f},{:.6f}\n", axle().value("parallel", "left.travel", k),
                        axle().value("parallel", "left.wheel_load", k) + friction,
                        axle().value("parallel", "right.wheel_load", k) / 1e3);
    };
    for (std::ptrdiff_t k = 0; k < points - 1; ++k) point(k, 100);
    for (std::ptrdiff_t k = points - 1; k >= 0; --k) point(k, k + 1 == points ? 0 : -100);
    const json m = axle().measured(csv);
    ASSERT_EQ(m["loops"].size(), 1u) << m["loops"];
    EXPECT_EQ(m["loops"][0]["output"], "left.wheel_load");
    EXPECT_NEAR(m["loops"][0]["width"].get<double>(), 200, 5);
    ASSERT_EQ(m["readings"].size(), 1u);
    const auto& rows = m["readings"][0];
    ASSERT_EQ(rows.size(), 2u) << rows;
    EXPECT_LE(rows[0]["equilibrium rms"].get<double>(), 40) << rows[0];
    EXPECT_EQ(rows[1]["output"], "right.wheel_load");
    EXPECT_LE(rows[1]["equilibrium rms"].get<double>(), 1) << rows[1];
}

TEST(Measurement, WrongSignUnitOrDefinitionOfAColumnIsNamed) {
    static const Solved rigid(support::scene("double_wishbone_rigid"), 10, "series");
    const auto& defined = rigid.defined;
    const auto d = static_cast<std::size_t>(find_channel(defined.channels, "caster@wheel_plane"));
    std::string csv = "branch,parameter_mm,caster_deg,camber_deg,toe_deg\n";
    std::size_t b = 0;
    while (rigid.comparison.branches[b].branch != "steering") ++b;
    const auto& curve = rigid.curve("steering");
    for (std::size_t k = 0; k < curve.a.size(); k += 2)
        csv += fmt::format("steering,{:.6f},{:.4f},{:.4f},{:.4f}\n", curve.a[k],
                           defined.branches[b].channel(d)[k], -rigid.value("steering", "camber", k),
                           rigid.value("steering", "toe", k));
    const json m = rigid.measured(csv);
    const std::string findings = m["findings"].dump();
    expect_parts(findings, {"by another definition: caster@wheel_plane", "with its sign turned"});
    EXPECT_EQ(m["findings"].size(), 2u) << findings;
}

// A model that is 10 % off still shows which sign, unit or zero of the file is wrong; and nothing is
// said where only the model is off.
TEST(Measurement, WrongSignUnitOrOffsetIsNamedForAnInexactModel) {
    const auto findings = [&](const char* branch, double place, double toe, double offset) {
        std::string csv = "branch,parameter_mm,left.toe_deg,right.toe_deg,left.camber_deg\n";
        const auto& curve = axle().curve(branch);
        for (std::size_t k = 0; k < curve.a.size(); ++k) {
            const double off = k % 2 == 0 ? 0.85 : 0.95;  // 10 %, and not proportional
            csv += fmt::format("{},{:.6f},{:.6f},{:.6f},{:.6f}\n", branch, place * curve.a[k],
                               toe * off * axle().value(branch, "left.toe", k) + offset,
                               off * axle().value(branch, "right.toe", k),
                               off * axle().value(branch, "left.camber", k));
        }
        return axle().measured(csv)["findings"];
    };
    const json turned = findings("steering", -1, 1, 0);
    ASSERT_EQ(turned.size(), 1u) << turned;
    expect_parts(turned[0], {"branch 'steering'", "with the sign of the parameter turned"});
    for (const char* branch : {"steering", "parallel", "opposite"})
        EXPECT_EQ(findings(branch, 1, 1, 0), json::array());
    for (const auto& [toe, offset, said] :
         {std::tuple{-1., 0.01, "left.toe is nearer with its sign turned"},
          {60., 0.5, "60 times (minutes of arc for degrees)"},
          {1., 2., "left.toe is nearer once 2"}}) {
        const json found = findings("parallel", 1, toe, offset);
        ASSERT_FALSE(found.empty());
        expect_parts(found[0], {said});
    }
}

TEST(Measurement, GradientOfEachTestIsInTheUnitOfItsAbscissa) {
    const json m = axle().measured(
        "branch,parameter_mm,load_N,left.toe_deg\nparallel,-20,,0.2\nparallel,0,,0.1\n"
        "parallel,20,,0\nlateral,,-1000,0.3\nlateral,,0,0.1\nlateral,,1000,-0.1\n");
    const json& rows = m["readings"][0];
    ASSERT_EQ(rows.size(), 2u);
    const auto slope_of = [](const json& row) { return row["gradient measured"].get<double>(); };
    EXPECT_EQ(rows[0]["test"], "parallel");
    EXPECT_EQ(rows[0]["gradient unit"], "deg/mm");
    EXPECT_NEAR(slope_of(rows[0]), -0.005, 1e-12);
    EXPECT_EQ(rows[1]["test"], "lateral");
    EXPECT_EQ(rows[1]["gradient unit"], "deg/kN");
    EXPECT_NEAR(slope_of(rows[1]), -0.2, 1e-12);
    const std::size_t last = axle().curve("lateral").a.size() - 1;
    const double expected =
        (axle().value("lateral", "left.toe", last) - axle().value("lateral", "left.toe", 0)) /
        6;  // from -3 to 3 kN
    EXPECT_NEAR(rows[1]["gradient"].get<double>(), expected, 0.05 * std::abs(expected));
}

TEST(Measurement, RowsOfUnrequestedBranchesAreCountedByName) {
    const std::string csv =
        "Test,Wheel Travel LH [mm],Lateral Force [kN],Toe LH [deg]\nBounce,10,,0.1\n"
        "Bounce,20,,0.2\nLateral opposed,0,1,0.1\nBounce,500,,1\nBounce,30,,\n";
    const json m = axle().measured(csv, {}, {"parallel"});
    EXPECT_EQ(m["left_out"], (json{"1 row of branch 'lateral', which was not requested (line 4)",
                                   "1 row beyond the range of branch 'parallel' (line 5)",
                                   "1 row without a measured value (line 6)"}));
    EXPECT_EQ(m["readings"].back()[0]["points"], 2);
    EXPECT_THROW((void)axle().measured(csv, {}, {"steering"}), SheetError);
}

TEST(Measurement, EveryOutputOfTheStateCanBeMeasured) {
    const auto value = [](const char* name, std::size_t k) {
        return solved().value("jounce", name, k);
    };
    std::string csv =
        "load_N,caster_deg,scrub_radius_change_mm,track_change_mm,strut.compression_mm\n";
    for (const std::size_t k : {10u, 20u, 40u})
        csv += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", solved().curve("jounce").a[k],
                           value("caster", k), value("scrub_radius", k) - value("scrub_radius", 0),
                           value("track_change", k), value("strut.compression", k));
    const json m = measured(csv);
    ASSERT_EQ(m["readings"][0].size(), 4u);
    for (const auto& row : m["readings"][0]) {
        EXPECT_EQ(row["points"], 3);
        EXPECT_LE(std::abs(row["equilibrium max"].get<double>()), 2e-6) << row;
    }
}

TEST(Measurement, UnknownColumnsAreListedWithTheNearestName) {
    const json plain = measured("travel_mm,toe_deg\n50,-1.8\n");
    json m = measured("time [s],travel_mm,toe_deg,tow_deg,toe_kg\n0,50,-1.8,x,\n");
    EXPECT_EQ(m["left_out"].size(), 3u) << m["left_out"];
    EXPECT_EQ(m["left_out"][0], "time [s]");
    EXPECT_TRUE(m["left_out"][1].get<std::string>().starts_with("tow_deg (did you mean 'toe"))
        << m["left_out"][1];
    EXPECT_EQ(m["readings"].dump(), plain["readings"].dump());
    EXPECT_EQ(plain["left_out"], json::array());
    EXPECT_EQ(measured("\xEF\xBB\xBFtravel_mm,toe_deg\r\n50,-1.8\r\n").dump(), plain.dump())
        << "with a byte order mark";
}

TEST(Measurement, MapGivesNameUnitSignAndOffsetAlsoInArcMinutes) {
    const json plain =
        measured("travel_mm,toe_deg,camber_change_deg\n-50,1.5,0.25\n50,-1.75,-0.5\n");
    const ColumnMap map = read_column_map(R"(columns:
  Case: {output: branch}
  Hub z: {output: travel, unit: cm, sign: -1}
  Toe_L: {output: toe, unit: arcmin, sign: -1, offset: 0.5}
  Gamma: {output: camber, unit: rad, change: true}
branches: {Up: jounce, Down: rebound}
)",
                                          "map.yaml");
    const json mapped = measured(
        fmt::format("Case,Hub z,Toe_L,Gamma,Fx\nDown,5,-60,{:.17g},1\nUp,-5,135,{:.17g},1\n",
                    0.25 / 180 * std::numbers::pi, -0.5 / 180 * std::numbers::pi),
        map);
    EXPECT_EQ(mapped["left_out"], json{"Fx"});
    // the map adds to headings and tests that are known
    const json both = measured("Test,Wheel Travel [mm],Gamma_L [deg]\nUp,50,-1\n",
                               read_column_map("columns: {\"Gamma_L [deg]\": {output: camber}}\n"
                                               "branches: {Up: jounce}\n",
                                               "map.yaml"));
    EXPECT_EQ(both["branch"], json{"jounce"});
    EXPECT_EQ(both["columns"]["travel"], json{50.0});
    EXPECT_EQ(measured("Test,Wheel Travel [mm],Camber [deg]\nUp,50,-1\n",
                       read_column_map("branches: {Up: jounce}\n", "map.yaml"))["columns"],
              both["columns"]);
    EXPECT_EQ(mapped["branch"], plain["branch"]);
    for (const char* column : {"travel", "toe", "camber"})
        for (const int k : {0, 1})
            EXPECT_NEAR(mapped["columns"][column][k].get<double>(),
                        plain["columns"][column][k].get<double>(), 1e-12)
                << column;
    for (const char* heading : {"toe_arcmin", "toe [arcmin]", "toe [']", "toe_′"})
        EXPECT_NEAR(measured(fmt::format("travel_mm,{}\n50,-105\n", heading))["columns"]["toe"][0]
                        .get<double>(),
                    -1.75, 1e-12)
            << heading;
}

// At 40 mm toe was measured and camber was not: its curve has no point there.
TEST(Measurement, MissingValueLeavesAGapInItsCurveOnly) {
    const SceneAnalyses scene = sample_with(
        solved().typed("branch,travel_mm,toe_deg,camber_deg\njounce,20,-0.7,0.1\njounce,40,-1.4,\n"
                       "jounce,60,-2,0.3\n"));
    const auto camber = measured_curves(scene, sweeps_of(scene).front(), "travel", "camber");
    ASSERT_EQ(camber.size(), 1u);
    ASSERT_EQ(camber[0].rows.size(), 3u);
    EXPECT_EQ(camber[0].rows[0], (std::vector{20.0, 0.1}));
    EXPECT_TRUE(std::isnan(camber[0].rows[1][1]));
    EXPECT_EQ(camber[0].rows[2], (std::vector{60.0, 0.3}));
}

TEST(Measurement, PointsAreUsedOnlyOnTheirBranch) {
    // Assigned to rebound but in the range of jounce: no comparison.
    const json misplaced = measured("branch,travel_mm,toe_deg\nrebound,50,-1.8\n");
    EXPECT_TRUE(misplaced["readings"][0].empty());
    EXPECT_EQ(misplaced["left_out"][0], "1 row beyond the range of branch 'rebound' (line 2)");
    const SceneAnalyses scene = sample_with(
        solved().typed("branch,travel_mm,toe_deg\njounce,20,-0.7\njounce,60,-2\nrebound,-60,2\n"));
    Sweep sweep = sweeps_of(scene).front();
    ASSERT_EQ(sweep.branches.size(), 2u);
    EXPECT_EQ(measured_curves(scene, sweep, "travel", "toe").at(0).rows.size(), 3u);
    sweep.branches.pop_back();
    EXPECT_EQ(measured_curves(scene, sweep, "travel", "toe").at(0).rows.size(), 2u);
}

// Without travel the figures use the load as abscissa, with the points.
TEST(Measurement, PointsByLoadAreDrawnOverTheLoad) {
    const SceneAnalyses scene = sample_with(
        solved().typed("load_N,toe_deg,wheel_centre_y_change_mm\n1500,-1,-1\n-1500,1,0\n"));
    int figures = 0, drawn = 0;
    for (const auto& s : sections_of(scene)) {
        if (s.id != "kinematics") continue;
        for (const auto& group : s.figures)
            for (const auto& figure : group.figures) {
                ++figures;
                EXPECT_EQ(figure.x, "load [N]") << figure.title;
                for (const auto& series : figure.series) {
                    if (series.title != "measured") continue;
                    ++drawn;
                    EXPECT_EQ(series.rows.size(), 2u);
                    EXPECT_EQ(std::abs(series.rows[0][0]), 1500);
                }
            }
    }
    EXPECT_GE(figures, 3);
    EXPECT_EQ(drawn, 2);  // toe and lateral movement
}

// An unbalanced scene settles first; a measurement is relative to the design position.
TEST(Measurement, TravelCountsFromTheDesignPosition) {
    Scene heavy = support::scene("chrono_mcpherson");
    heavy.static_loads = {std::get<Load>(heavy.branches[0].drivers.at(0).what)};
    std::get<DeadForce>(heavy.static_loads.at(0).kind).f *= 500;
    const Solved settled(heavy, 20, "series");
    const auto& [scene, model, comparison, defined] = settled;
    const auto& curve = comparison.branches[0].runs[1].curve;
    const auto drawn = compare::evaluate(model, compare::design_state(model));
    const double rest = curve.values[0][2] - drawn[2];  // wheel_centre_z
    ASSERT_GT(std::abs(rest), 1);                       // [mm]: it does settle
    const json m =
        settled.measured(fmt::format("branch,travel_mm,wheel_centre_y_mm\njounce,{:.17g},{:.17g}\n",
                                     curve.values[10][2] - drawn[2], curve.values[10][1]));
    const json& row = m["readings"][0][0];
    EXPECT_EQ(row["points"], 1);
    EXPECT_LE(std::abs(row["equilibrium max"].get<double>()), 1e-9);
}

// As from a test rig: one file, several load cases with their own parameters and names.
const Solved& rig() {
    static const Solved once(support::scene("chrono_mcpherson_travel"), 8);
    return once;
}
ColumnMap cases(std::vector<std::pair<std::string, std::string>> names) {
    ColumnMap map;
    map.columns = {{.theirs = "case", .output = "branch"}};
    map.branches = std::move(names);
    map.file = "map.yaml";
    return map;
}

TEST(Measurement, MapAssignsLoadCasesToBranchesWithTheirDrives) {
    const ColumnMap map = cases({{"Bounce", "travel"}, {"Ride load", "load"}});
    const Measured rig_typed = rig().typed(
        "case,parameter_mm,load_N,toe_deg\nBounce,-20,,0.1\nBounce,20,,-0.2\nRide "
        "load,,500,0.3\nbraking,20,,2\n",
        map);
    const compare::Result result = result_of(rig_typed, rig().comparison);
    const json points = objects(table_json(whole_table(result, "points"))),
               tests = objects(table_json(whole_table(result, "measured")));
    ASSERT_EQ(points.size(), 4u);
    for (const auto& [k, branch, parameter] : {std::tuple{0u, "travel", -20.0},
                                               {1u, "travel", 20.0},
                                               {2u, "load", 500.0},
                                               {3u, "braking", 20.0}}) {
        EXPECT_EQ(points[k]["branch"], branch);
        EXPECT_EQ(points[k]["parameter"], parameter);
    }
    EXPECT_EQ(tests.size(), 3u);  // branches
    EXPECT_EQ(rig_typed.found.compared, 4);
    EXPECT_EQ(tests[0]["reading"], "at equal load or parameter");
}

// A rig's file has a travel column for its ride case and a force for the others: a point is drawn
// over the abscissa of its figure, and omitted without it.
TEST(Measurement, PointsAreDrawnOverTheAbscissaOfTheFigure) {
    const SceneAnalyses scene = sample_with(
        rig().typed(
            "branch,travel_mm,load_N,toe_deg\ntravel,-20,,0.1\ntravel,20,,-0.2\nload,,500,0."
            "3\nload,,700,0.4\n",
            {}),
        "chrono_mcpherson_travel");
    int seen = 0;
    for (const auto& sweep : sweeps_of(scene)) {
        const auto points = measured_curves(
            scene, sweep, measured_over_parameter(scene, sweep) ? "" : "travel", "toe");
        if (sweep.name == "travel") {
            ++seen;
            ASSERT_EQ(points.size(), 1u);
            EXPECT_FALSE(measured_over_parameter(scene, sweep));
            EXPECT_EQ(points[0].rows, (std::vector<std::vector<double>>{{-20, 0.1}, {20, -0.2}}));
        } else if (sweep.name == "load") {
            ++seen;
            ASSERT_EQ(points.size(), 1u);
            EXPECT_TRUE(measured_over_parameter(scene, sweep));
            EXPECT_EQ(points[0].rows, (std::vector<std::vector<double>>{{500, 0.3}, {700, 0.4}}));
        } else {
            EXPECT_TRUE(points.empty()) << sweep.name;
        }
    }
    EXPECT_EQ(seen, 2);
}

TEST(Measurement, PointsOutsideTheRangeAreNotCompared) {
    const Measured m = solved().typed("travel_mm,toe_deg\n1e4,0\n50,\n");
    EXPECT_EQ(m.found.compared, 0);
    EXPECT_EQ(m.left_out, (std::vector<std::string>{"1 row that no branch reaches (line 2)",
                                                    "1 row without a measured value (line 3)"}));
}

}  // namespace
}  // namespace elastocheck::reports
