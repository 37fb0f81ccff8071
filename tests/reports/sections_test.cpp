// Sections of a report are functions of result.json, and errors name the broken field.
#include "reports/page/sections.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "compare/tables/rows.hpp"
#include "reports/files/templates.hpp"
#include "reports/page/common.hpp"
#include "reports/page/report/report.hpp"
#include "reports/render/render.hpp"
#include "reports/text/numbers.hpp"
#include "tests/reports/command.hpp"
#include "tests/reports/result.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

const std::string file = "result.json";

std::vector<Section> sections(const json& result) {
    return sections_of(JsonCursor{&result["scenes"][0], "scenes[0]", &file});
}

// The section as text: its sentences and its tables.
std::string said(const json& result, const std::string& id) {
    std::string text;
    for (const auto& section : sections(result)) {
        if (section.id != id) continue;
        text += render("text/" + id, section.words, Escape::nothing);
        for (const auto& table : section.tables) {
            text += table.caption + "\n";
            for (const auto& column : table.columns) text += "| " + column.name + " ";
            for (const auto& row : table.rows) {
                text += "|\n";
                for (const auto& cell : row) text += "| " + cell + " ";
            }
            text += "|\n";
        }
    }
    return text;
}

Figure figure(const json& result, const std::string& id) {
    for (const auto& section : sections(result))
        for (const auto& group : section.figures)
            for (const auto& figure : group.figures)
                if (figure.id == id) return figure;
    ADD_FAILURE() << "no figure " << id;
    return {};
}

// Calls f on every value of the document; in a list only on the first.
template <class F>
void for_each_place(const json& value, const json::json_pointer& place, F&& f) {
    if (!place.empty()) f(place);
    if (value.is_object())
        for (const auto& [key, entry] : value.items()) for_each_place(entry, place / key, f);
    if (value.is_array())
        for (std::size_t k = 0; k < std::min<std::size_t>(1, value.size()); ++k)
            for_each_place(value[k], place / k, f);
}

TEST(Sections, EveryPartOfADocumentBecomesASection) {
    std::vector<std::string> ids;
    for (const auto& section : sections(sample_result())) ids.push_back(section.id);
    EXPECT_EQ(ids, (std::vector<std::string>{"first", "drawing", "kinematics", "rates", "forces",
                                             "methods", "references", "deviation", "price",
                                             "convergence", "attribution", "matrices", "model"}));
    for (const auto& section : sections(sample_result()))
        for (const auto& group : section.figures) {
            EXPECT_FALSE(group.caption.empty());
            EXPECT_FALSE(group.table.rows.empty())
                << section.id << ": no table under " << group.caption;
            for (const auto& row : group.table.rows)
                EXPECT_EQ(row.size(), group.table.columns.size());
            for (const auto& figure : group.figures) {
                EXPECT_GT(figure.description.size(), 40u) << figure.id;
                EXPECT_FALSE(figure.series.empty()) << figure.id;
            }
        }
}

// Bars, arrows and map of handmade effects of two hardpoints and six rates on one figure.
TEST(Sections, EffectsOfNumbersAreBarsArrowsAndAMap) {
    json result = sample_result();
    std::vector<std::string> names;
    for (const auto& point : result["scenes"][0]["drawing"]["points"])
        if (point["hardpoint"] == true && (names.empty() || names[0] != point["name"]))
            if (names.size() < 2) names.push_back(point["name"]);
    ASSERT_EQ(names.size(), 2u);
    std::vector<compare::EffectRow> rows;
    const auto add = [&](const std::string& number, const char* step, double effect) {
        rows.push_back({"travel", 0, "mm", "left.bump_steer", "deg/m", number, step, effect, ""});
    };
    add("points." + names[0] + ".x", "1 mm", 0.3);
    add("points." + names[0] + ".z", "1 mm", -0.4);
    add("points." + names[1] + ".y", "1 mm", 0.05);
    for (int k = 0; k < 6; ++k) add(fmt::format("springs.s{}.rate", k), "1 %", 0.01 * (k + 1));
    rows.push_back({"travel", 0, "mm", "left.bump_steer", "deg/m", "springs.s7.rate", "1 %",
                    compare::nan, "corner of a law"});
    const auto section_with = [&](bool conclusive) {
        result["scenes"][0]["sensitivity"] = {{"conclusive", conclusive},
                                              {"reasons", json::array()},
                                              {"compared", 10},
                                              {"apart", 1e-12},
                                              {"effects", table_json(rows)}};
        result = json::parse(result.dump());
        for (auto& section : sections(result))
            if (section.id == "change") return section;
        ADD_FAILURE() << "no section";
        return Section{};
    };
    const Section section = section_with(true);
    EXPECT_EQ(section.part, Part::change);
    EXPECT_EQ(section.mark, Mark::none);

    const Figure bars = figure(result, "change-left-bump-steer");
    ASSERT_EQ(bars.series.size(), 1u);
    ASSERT_EQ(bars.series[0].rows.size(), 5u);
    EXPECT_EQ(bars.y_ticks[0].second, as_words(names[0]) + " z");
    EXPECT_EQ(bars.y_ticks[2].second, "s5 rate (1 %)");
    EXPECT_EQ(bars.series[0].rows[0][2], -0.4) << "a negative effect is a bar to the left";
    EXPECT_EQ(bars.series[0].rows[0][3], 0);

    // along the gradient (0.3, 0, -0.4), of size 0.5
    const auto& arrows = section.figures[0].table;
    EXPECT_EQ(arrows.rows[0],
              (std::vector<std::string>{as_words(names[0]), "+0.300", "0", "−0.400", "0.500"}));
    const auto words = figure(result, "change-view-front").words;
    EXPECT_EQ(std::ranges::count(words, as_words(names[0]) + " 0.50", &Word::text), 1);
    EXPECT_EQ(std::ranges::count(words, as_words(names[1]), &Word::text), 0)
        << "the names of the points give way to those of the arrows";

    const auto& map = section.figures.back();
    EXPECT_EQ(map.table.columns[1].name, "left bump steer [deg/m]");
    EXPECT_EQ(map.table.rows[0], (std::vector<std::string>{as_words(names[0]), "0.500"}));
    EXPECT_EQ(map.figures[0].series.size(), 2u);
    EXPECT_NEAR(map.figures[0].series[1].opacity, 0.1 * map.figures[0].series[0].opacity, 1e-12);

    EXPECT_EQ(section_with(false).mark, Mark::open);
    expect_parts(said(result, "change"), {"not confirmed"});
}

TEST(Sections, PartsThatWereNotComputedAreLeftOut) {
    json result = sample_result();
    for (const char* part : {"convergence", "trade", "drawing", "judgement", "findings", "forces",
                             "largest_forces", "characteristics", "rate_errors"})
        result["scenes"][0].erase(part);
    for (auto& branch : result["scenes"][0]["branches"])
        for (const char* part : {"deviation", "profiles", "reference_uncertainty", "cross_check"})
            branch.erase(part);
    std::vector<std::string> ids;
    for (const auto& section : sections(result)) ids.push_back(section.id);
    EXPECT_EQ(ids, (std::vector<std::string>{"first", "kinematics", "references", "model"}));
    expect_parts(said(result, "first"), {"is from one solution of the full equations"});
}

// Replaces each value of a document by others: by all of them, or by every so many.
void expect_places_of_damage(std::size_t every) {
    std::size_t count = 0;
    const json whole = sample_result("pinned_bar");
    int refused = 0, read = 0;
    for_each_place(
        whole["scenes"][0], json::json_pointer("/scenes/0"), [&](const json::json_pointer& place) {
            if (place.back() == "0" && place.parent_pointer().to_string() == "/scenes") return;
            for (const json& instead :
                 {json(), json("text"), json(7.5), json::array(), json::object(), json("gone")}) {
                if (count++ % every != 0) continue;
                json damaged = whole;
                if (instead == "gone" && damaged[place.parent_pointer()].is_object())
                    damaged[place.parent_pointer()].erase(place.back());
                else if (instead == "gone")
                    damaged[place.parent_pointer()].erase(std::stoul(place.back()));
                else
                    damaged[place] = instead;
                try {
                    (void)sections(damaged);
                    ++read;
                } catch (const ResultError& error) {
                    ++refused;
                    EXPECT_TRUE(std::string(error.what()).starts_with("result.json: scenes[0]"))
                        << error.what();
                } catch (const std::exception& error) {
                    ADD_FAILURE() << place.to_string() << " = " << instead << ": " << error.what();
                }
            }
        });
    EXPECT_GT(refused, 500 / static_cast<int>(every));
    EXPECT_GT(read, 100 / static_cast<int>(every));
}

TEST(Sections, ADamagedDocumentIsReadOrRefusedWithItsPlace) { expect_places_of_damage(5); }
TEST(NightlySections, ADamagedDocumentIsReadOrRefusedWithItsPlace) { expect_places_of_damage(1); }

TEST(Sections, AMissingFieldIsNamed) {
    json result = sample_result();
    result["scenes"][0]["branches"][1]["legs"][0]["curve"].erase("a");
    try {
        (void)sections(result);
        FAIL();
    } catch (const ResultError& error) {
        EXPECT_STREQ(error.what(), "result.json: scenes[0].branches[1].legs[0].curve.a: missing");
    }
}

// ---- How far the numbers can be trusted.

TEST(Sections, TrustIsTheDistanceOfTheReferencesAndTheProvedPoints) {
    json result = sample_result();
    result["scenes"][0]["findings"]["references_apart"]["mm"]["max"] = 9e-12;
    result["scenes"][0]["findings"]["references_apart"]["deg"]["max"] = 2e-13;
    EXPECT_TRUE(said(result, "first")
                    .starts_with("Every number on these pages: two independent solutions agree to "
                                 "9.0\u00a0×\u00a010⁻¹²\u00a0mm "
                                 "and 2.0\u00a0×\u00a010⁻¹³\u00a0deg, proved at "))
        << said(result, "first");
    result["scenes"][0]["findings"]["references_apart"]["mm"]["max"] = nullptr;  // NaN
    EXPECT_TRUE(contains(said(result, "first"), "agree to –\u00a0mm")) << said(result, "first");
    for (auto& leg : result["scenes"][0]["branches"][0]["legs"])
        if (leg["leg"] == "equilibrium") leg["proof"]["proved"] = 0;
    EXPECT_TRUE(
        std::regex_search(said(result, "first"), std::regex("proved at \\d+ of \\d+ points")))
        << said(result, "first");
}

TEST(Sections, TrustWhatCannotBeJudgedIsSaidFirst) {
    json result = sample_result();
    result["scenes"][0]["verdict"] = {{"conclusive", false},
                                      {"numbers_compared", 3},
                                      {"reasons", {"jounce: energy leg: branch lost: at load 3"}}};
    EXPECT_TRUE(
        said(result, "first")
            .starts_with("Not judged: jounce: energy leg: branch lost: at load 3; the numbers "
                         "below are no basis for a decision."))
        << said(result, "first");
}

TEST(Sections, TrustAReferenceThatStoppedIsNotSaidToAgree) {
    json result = sample_result();
    for (auto& branch : result["scenes"][0]["branches"]) {
        auto& curve = branch["legs"][2]["curve"];
        curve["a"] = json::array();
        for (auto& [name, values] : curve["values"].items()) values = json::array();
        branch["reference_uncertainty"]["at_equal_parameter"]["channels"] = json::object();
        branch["profiles"]["references"] = {{"mm", json::array()}, {"deg", json::array()}};
    }
    result["scenes"][0]["findings"]["references_apart"] = {{"mm", nullptr}, {"deg", nullptr}};
    EXPECT_FALSE(contains(said(result, "first"), "agree to")) << said(result, "first");
    for (const auto& section : sections(result))
        if (section.id == "deviation")
            for (const auto& group : section.figures) {
                expect_parts(group.caption, {"Not both references reached the end"});
                expect_parts(group.figures[0].description, {}, {"apart"});
            }
}

// ---- Which fast method is good enough.

TEST(Sections, MethodsAreATableOfErrorAndWork) {
    json result = sample_result();
    auto& judgement = result["scenes"][0]["judgement"];
    judgement["position"]["max"] = 2.5;
    judgement["angle_across"]["max"] = 0.25;
    const std::string text = said(result, "methods");
    expect_parts(text,
                 {"The cheapest method within 0.01\u00a0mm and 0.001\u00a0deg is series",
                  "The published recursion is off by up to 2.5\u00a0mm and ",
                  "0.25\u00a0deg at equal travel.", "| yes, recommended |",
                  "| published | steps of the scene | no | 2.5 |"},
                 {"| published | 80\u00a0steps | yes"});
}

// A method is within the tolerance by its own numbers; NaN never is.
TEST(Sections, MethodsAreWithinTheToleranceByTheirNumbers) {
    json result = sample_result();
    auto& table = result["scenes"][0]["trade"]["points"];
    const auto column = [&](const char* name) {
        for (std::size_t c = 0; c < table["columns"].size(); ++c)
            if (table["columns"][c]["name"] == name) return c;
        return std::size_t{0};
    };
    const auto set_published = [&](const json& share) {
        for (auto& row : table["rows"])
            if (row[column("method")] == "published") row[column("share")] = share;
        return said(result, "methods");
    };
    EXPECT_TRUE(std::regex_search(set_published(0.5), std::regex("published . \\d+.*steps . yes")));
    EXPECT_FALSE(
        std::regex_search(set_published(1.5), std::regex("published . \\d+.*steps . yes")));
    EXPECT_FALSE(
        std::regex_search(set_published(nullptr), std::regex("published . \\d+.*steps . yes")));
}

TEST(Sections, MethodsWithoutARecommendationNoneIsNamed) {
    json result = sample_result();
    result["scenes"][0]["trade"]["recommendation"] = nullptr;
    auto& table = result["scenes"][0]["trade"]["points"];
    for (auto& row : table["rows"])
        for (auto& cell : row)
            if (cell == "yes") cell = "";
    EXPECT_TRUE(contains(said(result, "methods"),
                         "No fast method that was tried is recommended within 0.01\u00a0mm and "
                         "0.001\u00a0deg."))
        << said(result, "methods");
}

// "at equal load" does not apply to a branch driven by a motion.
TEST(Sections, NameTheReadingsByWhatTheBranchMoves) {
    for (const auto& section : sections(sample_result("slider_crank")))
        for (const auto& group : section.figures) {
            expect_parts(group.caption, {}, {"equal load"});
            for (const auto& figure : group.figures) {
                expect_parts(figure.title + figure.x + figure.description, {}, {"load"});
                EXPECT_TRUE(section.id != "curves" || figure.x == "crank [deg]") << figure.x;
            }
        }
}

// ---- Kinematics and compliance.

// The first branch of the scene lifts one wheel, and it alone has rate errors.
TEST(Sections, KinematicsLeadsWithHeaveOfBothWheels) {
    json result = compared_result("front_axle");
    auto& branches = result["scenes"][0]["branches"];
    json single = branches[1];  // opposite travel
    single["name"] = "single_wheel", single["case"] = "travel";
    branches.insert(branches.begin(), single);
    const auto leading = [&] {
        return leading_sweep(JsonCursor{&result["scenes"][0], "scenes[0]", &file})->name;
    };
    EXPECT_EQ(leading(), "parallel");
    for (auto& branch : branches)
        if (branch["case"] == "heave") branch["case"] = "other";
    EXPECT_EQ(leading(), "single_wheel") << "else the first travel that is declared";
}

TEST(Sections, KinematicsNamesWhatEachBranchDoesToTheWheels) {
    std::map<std::string, std::string> cases;
    for (const auto& branch : compared_result("front_axle")["scenes"][0]["branches"])
        cases[branch["name"]] = branch["case"];
    EXPECT_EQ(cases, (std::map<std::string, std::string>{{"parallel", "heave"},
                                                         {"opposite", "roll"},
                                                         {"vertical", "heave"},
                                                         {"roll", "roll"},
                                                         {"steering", "steering"},
                                                         {"lateral", "lateral force"},
                                                         {"braking", "longitudinal force"},
                                                         {"traction", "longitudinal force"},
                                                         {"aligning", "moment"}}));
    EXPECT_EQ(sample_result("pinned_bar")["scenes"][0]["branches"][0]["case"], "other");
    EXPECT_EQ(sample_result()["scenes"][0]["branches"][0]["case"], "heave") << "by a load";
}

// In roll the right wheel goes the other way: over its own travel its toe is that of the left one.
TEST(Sections, KinematicsEachWheelGoesOverItsOwnTravel) {
    json result = compared_result("front_axle");
    const Figure coincide = figure(result, "toe-travel");
    EXPECT_EQ(coincide.x, "wheel travel [mm]");
    EXPECT_EQ(coincide.series.size(), 4u) << "one curve a load case for both wheels";
    for (const auto& series : coincide.series)
        if (series.title.starts_with("opposite")) {
            ASSERT_GE(series.rows.size(), 10u);
            EXPECT_GT(series.rows.front()[1], series.rows.back()[1]) << "toe-out in jounce";
        }
    // A right wheel that is another one has a curve of its own.
    for (auto& branch : result["scenes"][0]["branches"])
        for (auto& leg : branch["legs"])
            for (auto& toe : leg["curve"]["values"]["right.toe"]) toe = toe.get<double>() + 0.1;
    const Figure apart = figure(result, "toe-travel");
    EXPECT_EQ(apart.series.size(), 8u);
    std::vector<std::string> legend;
    for (const auto& entry : apart.legend) legend.push_back(entry.title);
    EXPECT_EQ(legend, (std::vector<std::string>{"parallel", "opposite", "vertical", "roll", "left",
                                                "right"}));
}

// y points to the left: outwards for one wheel, inwards for the other.
TEST(Sections, KinematicsLateralMovementIsPositiveOutwardsOnBothSides) {
    for (const auto& series : figure(compared_result("front_axle"), "track-change-travel").series) {
        expect_parts(series.title, {}, {"right"});
        EXPECT_LT(series.rows.front()[1], 0) << "inwards in rebound";
    }
}

// Both sides of the design position are one curve.
TEST(Sections, KinematicsJounceAndReboundAreOneCurve) {
    const Figure toe = figure(sample_result(), "toe-travel");
    ASSERT_EQ(toe.series.size(), 1u);
    const auto& rows = toe.series[0].rows;
    for (std::size_t k = 1; k < rows.size(); ++k) EXPECT_GT(rows[k][0], rows[k - 1][0]);
    EXPECT_LT(rows.front()[0], -10);
    EXPECT_GT(rows.back()[0], 10);
}

TEST(Sections, KinematicsTheWheelLoadHasTheStaticPart) {
    const Figure load = figure(compared_result("front_axle"), "wheel-load-travel");
    EXPECT_EQ(load.y, "wheel load [N]");
    for (const auto& series : load.series) {
        const auto design = std::ranges::min_element(
            series.rows, {}, [](const auto& row) { return std::abs(row[0]); });
        EXPECT_NEAR((*design)[1], 3800, 400) << series.title;
    }
}

TEST(Sections, KinematicsAxesHaveTheDrivesOwnNames) {
    const json& result = compared_result("front_axle");
    EXPECT_EQ(figure(result, "toe-steering").x, "rack [mm]");
    EXPECT_EQ(figure(result, "toe-force").x, "force [N]");
    for (const auto& section : sections(result))
        for (const auto& group : section.figures)
            for (const auto& f : group.figures) expect_parts(f.x, {}, {"parameter"});
    expect_parts(said(result, "steering"), {"| rack [mm] | steer angle left [deg] |",
                                            "rack.drive force [N]", "Turning circle at full lock"});
}

// Row by row against the document: what is drawn, and what the trim makes of it.
TEST(Sections, FirstShowsTheStaticAlignmentAsDrawnAndAsSettled) {
    json result = compared_result("front_axle");
    const std::string text = said(result, "first");
    expect_parts(text, {"settled after the trim (toe-in, top outwards positive)\n| of the wheel | "
                        "drawn left | drawn right | settled left | settled right ",
                        "| wheel load [N] | – | – | 3800 | 3800 |",
                        "| springs.coil_left.preload | +17.86 N |"});
    auto& rows = result["scenes"][0]["wheels"]["static"]["rows"];
    for (auto& row : rows)
        if (row[0] == "left" && row[1] == "toe") row[3] = 0.1, row[4] = -0.0125;
    EXPECT_TRUE(contains(said(result, "first"), "| toe [deg] | 0.1000 | 0 | −0.01250 | 0 |"))
        << said(result, "first");
}

TEST(Sections, FirstHasKeyFiguresWithUnitsAndNoVerdict) {
    const std::string text = said(compared_result("front_axle"), "first");
    expect_parts(text,
                 {"| wheel rate | ", "| N/mm |", "| roll centre height | ",
                  "| toe change at −80\u00a0mm | ", "| roll stiffness at the wheels | "},
                 {"fail", "Fail", "off by", "published"});
}

// The wheels of an axle in roll: K = k t² / 2, of which what heave lacks is the bar's.
TEST(Sections, RatesRollStiffnessFollowsFromTheWheelRates) {
    const json& result = compared_result("front_axle");
    double roll = 0, heave = 0;
    const auto& design = result["scenes"][0]["characteristics"]["design"];
    for (const auto& row : design["rows"]) {
        if (row[0] == "left.wheel_rate_in_roll") roll = row[2];
        if (row[0] == "left.wheel_rate") heave = row[2];
    }
    ASSERT_GT(roll, heave);
    const double track = 2 * 1.1, stiffness = 1e3 * roll * track * track / 2 * M_PI / 180;
    const std::string text = said(result, "rates");
    std::smatch found;
    ASSERT_TRUE(
        std::regex_search(text, found, std::regex("roll stiffness at the wheels . (\\d+)")));
    EXPECT_NEAR(std::stod(found[1]), stiffness, 0.002 * stiffness);
    ASSERT_TRUE(std::regex_search(text, found, std::regex("anti-roll bar . ([\\d.]+)")));
    EXPECT_NEAR(std::stod(found[1]), 100 * (1 - heave / roll), 0.1);
}

// Both wheels loaded; one alone only by name. And one sign for a curve and its figure: inwards.
TEST(Sections, RatesOfAnAxleAreTheTestsOfARigInOneDirection) {
    const json& result = compared_result("front_axle");
    expect_parts(said(result, "first"),
                 {"| lateral force steer, parallel | ", "| lateral force steer, opposed | ",
                  "| braking force steer, both | ", "forces towards the middle of the vehicle"},
                 {"| lateral force steer | ", "alone"});
    expect_parts(said(result, "rates"),
                 {"| traction force steer, both | ", "| aligning torque steer, opposed | ",
                  "| lateral stiffness, parallel | "},
                 {"alone"});
    double steer = NAN;
    for (const auto& row : result["scenes"][0]["characteristics"]["design"]["rows"])
        if (row[0] == "left.lateral_force_steer@parallel") steer = row[2];
    const Figure toe = figure(result, "toe-force");
    const auto named = [](const std::vector<Series>& list, const std::string& title) {
        return std::ranges::any_of(list, [&](const Series& s) { return s.title == title; });
    };
    EXPECT_TRUE(named(toe.legend, "lateral, inwards"));
    EXPECT_TRUE(named(toe.legend, "braking, to the back"));
    EXPECT_TRUE(named(toe.legend, "traction, forward"));
    for (const auto& series : toe.series) {
        if (!series.title.starts_with("lateral")) continue;
        double slope = 0, nearest = INFINITY;
        for (const auto& row : series.rows)
            if (row[0] > 0 && row[0] < nearest) nearest = row[0], slope = 1e3 * row[1] / row[0];
        EXPECT_NEAR(slope, steer, 0.15 * std::abs(steer)) << series.title;
    }
    expect_parts(said(result, "compliance"),
                 {"lateral, inwards: changes", "| left, 3000 N | right, −3000 N |",
                  "braking, to the back: changes", "aligning, towards toe-in: changes"});
}

TEST(Sections, RatesOfASpringAreInTheColumnOfItsWheel) {
    const std::string text = said(compared_result("front_axle"), "rates");
    EXPECT_TRUE(
        std::regex_search(text, std::regex("\\| coil motion ratio \\| 0\\.\\d+ \\| 0\\.\\d+ ")))
        << text;
    expect_parts(text, {}, {"coil right", "coil left"});
}

// In solve, on the page and in its figure: from the drawn position.
TEST(Sections, FirstTheTrackChangeIsThatOfTheOutput) {
    json result = compared_result("front_axle");
    auto& branch = result["scenes"][0]["branches"][0];
    auto& values = branch["legs"][1]["curve"]["values"]["left.track_change"];
    for (auto& value : values)
        value = value.get<double>() + 0.5;  // settled inwards of the drawn position
    const double at_the_end = values.front();
    expect_parts(said(result, "first"),
                 {"| track change at −80\u00a0mm | " + number(at_the_end, 4) + " |",
                  "track change from the drawn position"});
    for (const auto& series : figure(result, "track-change-travel").series)
        if (series.title.ends_with("left") && series.title.starts_with("parallel")) {
            EXPECT_NEAR(series.rows.front()[1], at_the_end, 1e-9);
        }
}

// A quotient of a rounding error and a value that is zero is no percentage.
TEST(Sections, RatesHaveNoPercentageOfZero) {
    json result = compared_result("front_axle");
    auto& row = result["scenes"][0]["characteristics"]["design"]["rows"][0];
    row[5] = 0.3, row[6] = 85519.0;
    EXPECT_FALSE(contains(said(result, "matrices"), "85519")) << said(result, "matrices");
    EXPECT_TRUE(contains(said(result, "matrices"), "| +0.300 | – |")) << said(result, "matrices");
}

TEST(Sections, ForcesOfAStopAreShownWithItsPenetration) {
    const json& result = compared_result("front_axle");
    double deflection = 0;
    for (const auto& row : result["scenes"][0]["forces"]["rows"])
        if (row[0] == "parallel" && row[1] == 80.0 && row[4] == "coil_left.bump_stop.deflection")
            deflection = row[6];
    ASSERT_GT(deflection, 25);
    std::smatch found;
    const std::string text = said(result, "forces");
    ASSERT_TRUE(std::regex_search(
        text, found, std::regex("coil_left.bump_stop . \\d+ . parallel, 80 mm . (\\d+)")))
        << text;
    EXPECT_NEAR(std::stod(found[1]), deflection - 25, 0.5);
}

TEST(Sections, ForcesAreTheLargestAlongTheBranchAndSayWhere) {
    json result = compared_result("twist_beam");
    const json& branch = result["scenes"][0]["branches"][0];
    for (auto& row : result["scenes"][0]["largest_forces"]["rows"]) {
        row[0] = branch["name"], row[1] = -12.5, row[2] = branch["unit"];
        row[5] = 4321.0;
    }
    EXPECT_TRUE(contains(said(result, "forces"),
                         fmt::format("{}, −12.5 {}", branch["name"].get<std::string>(),
                                     branch["unit"].get<std::string>())))
        << said(result, "forces");
}

TEST(Sections, ForcesOfABeamAreThoseOfItsMostLoadedSegment) {
    const json& result = compared_result("twist_beam");
    std::set<std::string> beams;
    for (const auto& element : result["scenes"][0]["elements"])
        if (element["kind"] == "beam") beams.insert(element["beam"].get<std::string>());
    ASSERT_FALSE(beams.empty());
    const std::string text = said(result, "forces");
    for (const auto& beam : beams) {
        expect_parts(text, {"| " + beam + " | "}, {"| " + beam + ".1 | "});
    }
}

TEST(Sections, WarningsOfTheReaderStandBelowTheFirstSentence) {
    json result = sample_result();
    expect_parts(said(result, "first"), {}, {"Warning"});
    result["scenes"][0]["warnings"] = {"a.yaml:3: too large", "a.yaml:9: too soft"};
    const std::string text = said(result, "first");
    expect_parts(text, {"\n\nWarning: a.yaml:3: too large", "\n\nWarning: a.yaml:9: too soft"});
}

}  // namespace
}  // namespace elastocheck::reports
