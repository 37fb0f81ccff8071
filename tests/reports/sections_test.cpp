// Sections of a report are functions of result.json, and errors name the broken field.
#include "reports/page/sections.hpp"

#include <gtest/gtest.h>

#include "reports/files/templates.hpp"
#include "reports/page/report/report.hpp"
#include "tests/reports/result.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

const std::string file = "result.json";

std::vector<Section> sections(const json& result) {
    return sections_of(JsonCursor{&result["scenes"][0], "scenes[0]", &file});
}

std::string said(const json& result) {
    for (const auto& section : sections(result))
        if (section.id == "verdict") return render("text/verdict", section.words, Escape::nothing);
    return {};
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
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
    EXPECT_EQ(ids, (std::vector<std::string>{"first", "drawing", "characteristics", "curves",
                                             "forces", "verdict", "deviation", "price",
                                             "convergence", "attribution", "orders", "arithmetic",
                                             "references", "model"}));
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

TEST(Sections, PartsThatWereNotComputedAreLeftOut) {
    json result = sample_result();
    for (const char* part : {"convergence", "trade", "precision", "drawing"})
        result["scenes"][0].erase(part);
    result["scenes"][0]["findings"].erase("gap");
    for (const auto& section : sections(result))
        EXPECT_TRUE(section.id != "price" && section.id != "convergence" &&
                    section.id != "arithmetic" && section.id != "drawing");
    const std::string text = said(result);
    EXPECT_TRUE(contains(text, " at the end of rebound.")) << text;  // no statement about the gap
    EXPECT_FALSE(contains(text, "The method ‘")) << text;
}

TEST(Sections, ADamagedDocumentIsReadOrRefusedWithItsPlace) {
    const json whole = sample_result("pinned_bar");
    int refused = 0, read = 0;
    for_each_place(
        whole["scenes"][0], json::json_pointer("/scenes/0"), [&](const json::json_pointer& place) {
            if (place.back() == "0" && place.parent_pointer().to_string() == "/scenes") return;
            for (const json& instead :
                 {json(), json("text"), json(7.5), json::array(), json::object(), json("gone")}) {
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
    EXPECT_GT(refused, 500);
    EXPECT_GT(read, 100);
}

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

TEST(Verdict, IsMadeOfTheNumbers) {
    json result = sample_result();
    auto& scene = result["scenes"][0];
    const std::string before = said(result);
    EXPECT_TRUE(contains(before, "The published recursion with 20 steps is within")) << before;
    EXPECT_TRUE(contains(before, "too soft at the end of jounce")) << before;
    scene["findings"]["worst_at_equal_abscissa"]["deg"]["max"] = 0.25;
    scene["findings"]["worst_at_equal_abscissa"]["deg"]["channel"] = "toe";
    EXPECT_TRUE(contains(said(result), "within 0.25\u00a0deg (toe) at equal travel"))
        << said(result);
    scene["rate_errors"][0]["off"] = 0.25;
    EXPECT_TRUE(
        contains(said(result), "its wheel rate is 25\u00a0% too stiff at the end of jounce"))
        << said(result);
}

// compare classifies the role; this tests the text of each.
TEST(Verdict, SaysHowMuchOfTheErrorStepsCannotRemove) {
    struct Case {
        const char *role, *words;
    };
    for (const auto& [role, words] :
         {Case{"nearly_all", "nearly all of it formulation gap that more steps cannot remove"},
          Case{"part", "50\u00a0% of it formulation gap that more steps cannot remove"},
          Case{"hardly_any", "nearly all of it step error that more steps remove"},
          Case{"hidden",
               "the formulation gap alone, which more steps cannot remove, is larger "
               "(0.50\u00a0mm)"},
          Case{"opposite", "step error and formulation gap (0.50\u00a0mm) have opposite signs"},
          Case{"none", "none of it formulation gap: more steps remove it"}}) {
        json result = sample_result();
        auto& gap = result["scenes"][0]["findings"]["gap"];
        gap["deviation"] = 1.0, gap["gap"] = 0.5, gap["role"] = role;
        EXPECT_TRUE(contains(said(result), words)) << role << ": " << said(result);
    }
}

// Where a motion prescribes every position, the error is in the force.
TEST(Verdict, PositionsThatAreDictatedAreNotCalledExactInAll) {
    const std::string text = said(sample_result("arch_driven"));
    EXPECT_TRUE(contains(
        text,
        "is exact in its positions and angles, but the error of its guide.drive force is up to"))
        << text;
    EXPECT_TRUE(contains(said(sample_result("slider_crank")),
                         "The error of its crank.drive moment is up to"))
        << said(sample_result("slider_crank"));
}

// "at equal load" does not apply to a branch driven by a motion.
TEST(Verdict, NamesTheReadingsByWhatTheBranchMoves) {
    const std::string text = said(sample_result("slider_crank"));
    EXPECT_TRUE(contains(text, "at equal parameter")) << text;
    EXPECT_FALSE(contains(text, "load")) << text;
    for (const auto& section : sections(sample_result("slider_crank")))
        for (const auto& group : section.figures) {
            EXPECT_FALSE(contains(group.caption, "equal load")) << group.caption;
            for (const auto& figure : group.figures) {
                EXPECT_FALSE(contains(figure.title + figure.x + figure.description, "load"))
                    << figure.id;
                // No figure has a non-monotonic abscissa.
                EXPECT_TRUE(section.id != "curves" || figure.x == "parameter [deg]") << figure.id;
            }
        }
}

// Both ends of a two-sided branch, and the force where the travel is prescribed.
TEST(Verdict, TellsTheWheelRateOfEveryEnd) {
    const json result = sample_result("chrono_mcpherson_travel");
    const std::string text = said(result);
    for (const char* end :
         {"at the end of travel at −80\u00a0mm", "at the end of travel at 80\u00a0mm",
          "at the end of braking", "at the end of load"})
        EXPECT_TRUE(contains(text, end)) << end << ": " << text;
    bool force = false;
    for (const auto& section : sections(result))
        for (const auto& group : section.figures)
            for (const auto& figure : group.figures)
                force = force || (figure.y == "jack.drive force [N]" && figure.x == "travel [mm]");
    EXPECT_TRUE(force);
}

TEST(Verdict, InconclusiveIsSaidFirst) {
    json result = sample_result();
    result["scenes"][0]["verdict"] = {{"conclusive", false},
                                      {"numbers_compared", 3},
                                      {"reasons", {"jounce: energy leg: branch lost: at load 3"}}};
    EXPECT_TRUE(
        said(result).starts_with("Inconclusive: jounce: energy leg: branch lost: at load 3; "))
        << said(result);
}

TEST(Verdict, WhatCouldNotBeJudgedIsNotSaidToHaveFailed) {
    json result = sample_result();
    auto& trade = result["scenes"][0]["trade"];
    trade["recommendation"] = nullptr;
    trade["inconclusive"] = {"jounce: energy leg: branch lost"};
    EXPECT_TRUE(contains(said(result), "The cost of accuracy could not be judged."))
        << said(result);
    EXPECT_FALSE(contains(said(result), "No configuration tried")) << said(result);
    for (const auto& section : sections(result))
        if (section.id == "price") {
            const std::string text = render("text/price", section.words, Escape::nothing);
            EXPECT_TRUE(
                contains(text, "No configuration is recommended. Inconclusive: jounce: energy leg"))
                << text;
        }
}

TEST(Verdict, AReferenceThatStoppedIsNotSaidToAgree) {
    json result = sample_result();
    for (auto& branch : result["scenes"][0]["branches"]) {
        auto& curve = branch["legs"][2]["curve"];
        curve["a"] = json::array();
        for (auto& [name, values] : curve["values"].items()) values = json::array();
        branch["reference_uncertainty"]["at_equal_parameter"]["channels"] = json::object();
        branch["profiles"]["references"] = {{"mm", json::array()}, {"deg", json::array()}};
    }
    result["scenes"][0]["findings"]["references_apart"] = {{"mm", nullptr}, {"deg", nullptr}};
    EXPECT_FALSE(contains(said(result), "agree to")) << said(result);
    for (const auto& section : sections(result))
        if (section.id == "deviation")
            for (const auto& group : section.figures) {
                EXPECT_TRUE(contains(group.caption, "Not both references reached the end"))
                    << group.caption;
                EXPECT_FALSE(contains(group.figures[0].description, "apart"))
                    << group.figures[0].description;
            }
}

TEST(Verdict, ARecursionThatStoppedIsSaidToHaveStopped) {
    json result = sample_result();
    result["scenes"][0]["branches"][1]["legs"][0]["outcome"] = "diverged";
    EXPECT_TRUE(contains(said(result),
                         "The published recursion with 20 steps does not reach the end of branch "
                         "rebound: diverged."))
        << said(result);
    EXPECT_FALSE(contains(said(result), "within")) << said(result);
}

TEST(Verdict, WithoutARecommendationItSaysThatNothingReaches) {
    json result = sample_result();
    result["scenes"][0]["trade"]["recommendation"] = nullptr;
    EXPECT_TRUE(contains(
        said(result),
        "No configuration tried reaches 0.01\u00a0mm and 0.001\u00a0deg over the whole range"))
        << said(result);
}

TEST(Verdict, NaNIsNeverASmallDeviation) {
    json result = sample_result();
    result["scenes"][0]["findings"]["worst_at_equal_abscissa"]["deg"]["max"] = nullptr;
    EXPECT_TRUE(contains(said(result), "within – deg") ||
                contains(said(result), "within –\u00a0deg"))
        << said(result);
}

TEST(ParseResult, RefusesWhatItCannotRead) {
    const auto refusal = [](const std::string& text) {
        try {
            (void)parse_result(text, file);
        } catch (const ResultError& error) {
            return std::string(error.what());
        }
        return std::string("read");
    };
    EXPECT_EQ(refusal("{\"schema\": \"elastocheck/result/2\", \"scene\": {}}").substr(0, 63),
              "result.json: schema: 'elastocheck/result/2' is not a document t");
    const std::string whole = sample_result().dump();
    EXPECT_EQ(refusal(whole), "read");
    for (const std::string& text : {whole.substr(0, whole.size() / 2), std::string()})
        EXPECT_TRUE(refusal(text).starts_with("result.json: is no JSON, or was cut off ("))
            << refusal(text);
    EXPECT_EQ(refusal("[]"), "result.json: expected an object, found array");
    EXPECT_EQ(refusal("{}"), "result.json: schema: missing");
    EXPECT_EQ(refusal("{\"schema\": \"elastocheck/result/3\"}"), "result.json: scenes: missing");
    EXPECT_EQ(refusal("{\"schema\": \"elastocheck/result/3\", \"scenes\": []}"),
              "result.json: scenes: it has no scene");
}

}  // namespace
}  // namespace elastocheck::reports
