// What the gate tells people and CI, from hand-made verdicts.
#include "reports/gate/gate_report.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/support/command.hpp"
#include "tests/support/folder.hpp"

namespace elastocheck::reports {
namespace {

using compare::Quantity;
using support::contains;
using support::expect_parts;

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
    return found;
}

bool well_formed(const std::string& xml) {
    const support::Folder folder;
    return support::read_xml(folder.write("junit.xml", xml)).code == 0;
}

compare::Offence offence(double is) {
    return {.branch = "jounce",
            .channel = "toe",
            .unit = "deg",
            .a = 3000,
            .a_unit = "N",
            .was = 1,
            .is = is,
            .tolerance = 0.25,
            .noticeable = 0.5};
}

GatedScene passed() {
    GatedScene scene;
    scene.file = "scenes/good.yaml";
    scene.reason = "as the paper says";
    scene.accepted.series = {{"jounce", Quantity::recursive, "toe", "deg", {1}},
                             {"jounce", Quantity::equilibrium, "toe", "deg", {1}},
                             {"jounce", Quantity::work_recursive, "steps", "count", {1}}};
    scene.verdict.compared = 7;
    return scene;
}

GatedScene failed() {
    GatedScene scene = passed();
    scene.file = "scenes/bad.yaml";
    scene.verdict.offences = {offence(3.5), offence(1.5)};
    return scene;
}

GatedScene unjudged() {
    GatedScene scene;
    scene.file = "scenes/new.yaml";
    scene.verdict.reasons = {"there is no baseline", "<nothing> | \"compared\"\x01"};
    return scene;
}

TEST(GateReport, ExitCodesAreRanked) {
    GatedScene bad = unjudged();
    bad.bad_input = true;
    EXPECT_EQ(exit_code({passed(), passed()}), 0);
    EXPECT_EQ(exit_code({}), 3);
    EXPECT_EQ(exit_code({passed(), unjudged()}), 3);
    EXPECT_EQ(exit_code({unjudged(), bad, passed()}), 2);
    EXPECT_EQ(exit_code({unjudged(), bad, failed(), passed()}), 1);
    GatedScene empty = passed();
    empty.verdict.compared = 0;
    EXPECT_EQ(exit_code({passed(), empty}), 3);
}

TEST(GateReport, OffenceTextHasPlaceOldNewDifferenceAndRatio) {
    EXPECT_EQ(describe(offence(0.5)),
              "branch 'jounce', recursive: toe at 3000 N: accepted 1 deg, measured 0.5 deg, "
              "difference -0.5, "
              "2 times the tolerance of 0.25, 1 times what an engineer notices");
    compare::Offence limit = offence(0.007);
    limit.of_limit = true, limit.a = {}, limit.was = limit.tolerance = 0.005;
    limit.quantity = Quantity::deviation_at_equal_abscissa;
    EXPECT_EQ(describe(limit),
              "branch 'jounce', deviation at equal abscissa: toe: 0.007 deg is over its limit of "
              "0.005 deg");
    const std::string table = gate_table(failed());
    expect_parts(table,
                 {"scenes/bad.yaml: FAILED: 2 of 7 numbers out of tolerance, same-build", " 2.5 ",
                  "        2\n"},
                 {"1.5"});  // of the same channel and not the worst
    expect_parts(gate_conclusion({failed(), passed()}),
                 {"FAILED: 2 of 14 numbers out of tolerance, in 1 of 2 scenes"});
}

TEST(GateReport, JUnitSeparatesFailuresFromErrors) {
    const std::string xml = junit({passed(), failed(), unjudged()});
    EXPECT_TRUE(well_formed(xml)) << xml;
    expect_parts(
        xml,
        {"<testsuite name=\"scenes/good.yaml\" tests=\"2\" failures=\"0\" errors=\"0\">",
         "<testsuite name=\"scenes/bad.yaml\" tests=\"2\" failures=\"1\" errors=\"0\">",
         "<testsuite name=\"scenes/new.yaml\" tests=\"1\" failures=\"0\" errors=\"1\">",
         "<testcase classname=\"scenes/bad.yaml\" name=\"branch jounce\">\n   <failure message=",
         "accepted 1 deg, measured 3.5 deg", "; 2 numbers of it in all\n",
         "<error message=\"there is no baseline\">", "&lt;nothing&gt;"});
    EXPECT_EQ(count(xml, "<testcase"), 5u);
    GatedScene odd = unjudged();
    for (int c = 1; c < 128; ++c) odd.verdict.reasons[0] += static_cast<char>(c);
    odd.file += "<&\"'>]]>";
    EXPECT_TRUE(well_formed(junit({failed(), odd})));
}

TEST(GateReport, ChangedNumbersOfTheSceneAreListedInEveryFormat) {
    GatedScene scene = failed();
    scene.changed = {{Number{"points.tie_rod_inner.z", -0.06, "m"},
                      Number{"points.tie_rod_inner.z", -0.055, "m"}},
                     {std::nullopt, Number{"springs.coil.preload", 300, "N"}},
                     {Number{"factor", 2, ""}, std::nullopt}};
    EXPECT_EQ(describe(scene.changed[1]), "springs.coil.preload: 300 N, is new");
    EXPECT_EQ(describe(scene.changed[2]), "factor: is gone, was 2");
    const std::string first = "points.tie_rod_inner.z: -0.055 m, was -0.06 m";
    expect_parts(gate_table(scene), {"  changed: " + first + "\n"});
    expect_parts(junit({scene}), {"changed: " + first});
    expect_parts(annotations({scene}), {"; changed in the scene: " + first + " and 2 more\n"});
    const std::string page = step_summary({scene});
    expect_parts(page, {"- scenes/bad.yaml: points.tie\\_rod\\_inner.z: -0.055 m, was -0.06 m\n"});
    scene.changed.assign(25, scene.changed[0]);
    expect_parts(gate_table(scene), {"... and 15 more numbers of the scene"});
}

TEST(GateReport, OffencesOfSeveralScenesAreOrderedByTheirNoticeableChange) {
    GatedScene rounding = failed(), moved = failed();
    rounding.verdict.offences = {offence(1.26)};  // 1 tolerance, half of what is noticed
    rounding.verdict.offences[0].channel = "bush.force_z", rounding.verdict.offences[0].unit = "N";
    rounding.verdict.offences[0].tolerance = 1e-9;
    moved.verdict.offences = {offence(1.6)};
    const std::string page = step_summary({rounding, moved});
    EXPECT_LT(page.find("| toe "), page.find("| bush.force")) << page;
    EXPECT_TRUE(annotations({rounding, moved})
                    .starts_with("::error file=scenes/bad.yaml,title=elastocheck gate%3A "
                                 "out of tolerance::branch 'jounce', recursive: toe"));
}

// Every number of every scene is an offence, under names of the maximum length.
TEST(GateReport, JUnitIsLimitedInSizeAndCountsWhatIsOmitted) {
    const auto wrong = [](std::size_t scenes, std::size_t branches, std::size_t numbers,
                          std::size_t length) {
        GatedScene scene = unjudged();
        scene.accepted.series.clear();
        scene.verdict.reasons.assign(numbers, std::string(length, '<'));
        for (std::size_t b = 0; b < branches; ++b)
            for (std::size_t k = 0; k < numbers; ++k) {
                scene.verdict.offences.push_back(offence(2));
                scene.verdict.offences.back().branch = std::to_string(b) + std::string(length, '&');
                scene.verdict.offences.back().channel = std::to_string(k);
            }
        scene.changed.assign(numbers, {Number{std::string(length, 'x'), 1, "m"}, std::nullopt});
        std::vector<GatedScene> all(scenes, scene);
        for (std::size_t k = 0; k < scenes; ++k)
            all[k].file = std::to_string(k) + std::string(length, '"');
        all.insert(all.begin(), passed());
        return all;
    };
    for (const auto& [scenes, branches, numbers, length] : {std::array<std::size_t, 4>{1, 2, 40, 0},
                                                            {1, 9, 400, 5},
                                                            {30, 9, 50, 10},
                                                            {1000, 1, 1, 5},
                                                            {100, 3, 20, 600}}) {
        const auto all = wrong(scenes, branches, numbers, length);
        const std::string xml = junit(all);
        EXPECT_LT(xml.size(), max_junit) << scenes << " scenes";
        EXPECT_TRUE(well_formed(xml));
        const std::size_t shown = count(xml, "<testcase"), tests = 2 + scenes * (1 + branches);
        const std::string left = fmt::format("{} more tests, ", tests - shown);
        EXPECT_GT(shown, 1u);
        EXPECT_EQ(contains(xml, left), shown < tests)
            << scenes << " scenes, " << shown << " shown of " << tests;
        EXPECT_EQ(contains(xml, "scenes/good.yaml"), shown == tests) << "what passes goes first";
        EXPECT_TRUE(contains(xml, "more: elastocheck gate --json") ||
                    scenes * branches * numbers < 100 || shown < tests);
    }
    // What fits is all there: the worst number of each channel, and how many there are.
    GatedScene scene = failed();
    for (int k = 0; k < 40; ++k) {
        scene.verdict.offences.push_back(offence(1.4));
        scene.verdict.offences.back().channel += std::to_string(k % 20);
    }
    const std::string xml = junit({scene});
    EXPECT_EQ(count(xml, "; 2 numbers of it in all"), 1 + 21u) << xml;
    expect_parts(xml, {}, {"more"});
}

TEST(GateReport, SummaryBeginsWithTheVerdictAndFoldsTheRest) {
    const std::string page = step_summary({passed(), failed(), unjudged()});
    EXPECT_TRUE(page.starts_with(
        "# elastocheck gate: FAILED\n\nFAILED: 2 of 14 numbers out of tolerance, in 1 of 3"))
        << page;
    EXPECT_LT(
        page.find(
            "| scenes/bad.yaml | jounce | recursive | toe | deg | 3000 | N | 1 | 3.5 | 2.5 | 5 | "
            "10 | 2 |"),
        page.find("<details>"))
        << page;
    EXPECT_GT(page.find("| scenes/good.yaml | passed | 7 |"), page.find("<details>")) << page;
    expect_parts(page, {"\\<nothing\\> \\| \"compared\""});
    EXPECT_TRUE(step_summary({passed()}).starts_with("# elastocheck gate: passed")) << page;
    expect_parts(step_summary({passed()}), {}, {"accepted |"});
}

TEST(GateReport, SummaryStaysBelowOneMebibyte) {
    GatedScene scene = failed();
    scene.file = std::string(1000, '|');
    scene.reason = scene.class_reason = std::string(1000, '&');
    scene.notes.assign(50, scene.reason);
    std::vector<GatedScene> scenes(400, scene);  // two offences each
    scenes[0].verdict.offences.assign(1200, offence(2));
    for (std::size_t k = 0; k < 1200; ++k)
        scenes[0].verdict.offences[k].channel = std::to_string(k) + std::string(1000, '<');
    scenes[0].verdict.reasons.assign(1000, std::string(1000, '_'));
    const std::string page = step_summary(scenes);
    EXPECT_LT(page.size(), 1u << 20);
    EXPECT_GT(page.size(), 1u << 18);  // the bound was put to the test
    expect_parts(page, {"... and 1499 more channels.", "... and 900 more.", "... and 100 more.",
                        "</details>"});
}

TEST(GateReport, AnnotationsAreAtMostTenWorstFirstAndEscaped) {
    GatedScene scene = failed();
    scene.file = "a:b,c.yaml";
    scene.verdict.offences.clear();
    for (int k = 20; k > 0; --k) {
        scene.verdict.offences.push_back(offence(1 + k));
        if (k < 20) scene.verdict.offences.back().channel += std::to_string(k);
    }
    scene.verdict.offences.push_back(offence(1.5));
    GatedScene other = unjudged();
    other.verdict.reasons = {"100 %\nand a\rline"};
    const std::string lines = annotations({passed(), other, scene});
    EXPECT_EQ(count(lines, "::error "), 10u);
    EXPECT_EQ(count(lines, "\n"), 10u);
    EXPECT_TRUE(lines.starts_with(
        "::error file=a%3Ab%2Cc.yaml,title=elastocheck gate%3A out of tolerance::branch "
        "'jounce', recursive: toe at 3000 N: accepted 1 deg, measured 21 deg, difference "
        "+20, 80 times the tolerance of 0.25, 40 times what an engineer notices; 2 numbers of it "
        "in all\n"))
        << lines;
    expect_parts(annotations({other}), {"::100 %25%0Aand a%0Dline\n"});
    EXPECT_EQ(annotations({passed()}), "");
}

}  // namespace
}  // namespace elastocheck::reports
