// Sections of a report are functions of what was found on a scene.
#include "reports/page/sections.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "reports/files/templates.hpp"
#include "reports/given/wheels.hpp"
#include "reports/page/common.hpp"
#include "reports/text/numbers.hpp"
#include "tests/reports/command.hpp"
#include "tests/reports/result.hpp"

namespace elastocheck::reports {
namespace {

// The section as text: its sentences and its tables.
std::string said(const SceneAnalyses& scene, const std::string& id) {
    std::string text;
    for (const auto& section : sections_of(scene)) {
        if (section.id != id) continue;
        text += render("text/" + id, section.words, Escape::nothing);
        for (const auto& table : section.tables) {
            const auto columns = page_columns(table);
            text += table.caption + "\n";
            for (const auto& column : columns) text += "| " + column.heading + " ";
            for (std::size_t r = 0; r < table.rows.size(); ++r) {
                text += "|\n";
                for (const auto& column : columns) text += "| " + column.cells[r] + " ";
            }
            text += "|\n";
        }
    }
    return text;
}

Figure figure(const SceneAnalyses& scene, const std::string& id) {
    for (const auto& section : sections_of(scene))
        for (const auto& group : section.figures)
            for (const auto& figure : group.figures)
                if (figure.id == id) return figure;
    ADD_FAILURE() << "no figure " << id;
    return {};
}

// A rate at the design position.
double rate(const SceneAnalyses& scene, const std::string& output) {
    for (const auto& row : characteristic_rows(scene.comparison))
        if (row.output == output) return row.value;
    return NAN;
}

TEST(Sections, EveryPartOfTheAnalysesBecomesASection) {
    std::vector<std::string> ids;
    for (const auto& section : sections_of(sample_scene())) ids.push_back(section.id);
    EXPECT_EQ(ids,
              (std::vector<std::string>{"first", "conditions", "drawing", "kinematics", "springs",
                                        "gradients", "rates", "forces", "methods", "references",
                                        "deviation", "price", "convergence", "model"}));
    for (const auto& section : sections_of(sample_scene()))
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
TEST(Sections, EffectsOfHardpointsAndRatesAreDrawnAsBarsArrowsAndAMap) {
    SceneAnalyses scene = sample_scene();
    std::vector<std::string> names;
    for (const auto& point : scene.drawing.points)
        if (point.hardpoint && (names.empty() || names[0] != point.name) && names.size() < 2)
            names.push_back(point.name);
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
        scene.effects = Effects{rows, {}, 10, 1e-12};
        if (!conclusive) scene.effects->reasons = {"two solvers differ"};
        for (auto& section : sections_of(scene))
            if (section.id == "change") return section;
        ADD_FAILURE() << "no section";
        return Section{};
    };
    const Section section = section_with(true);
    EXPECT_EQ(section.part, Part::change);
    EXPECT_EQ(section.mark, Mark::none);

    const Figure bars = figure(scene, "change-left-bump-steer");
    ASSERT_EQ(bars.series.size(), 1u);
    ASSERT_EQ(bars.series[0].rows.size(), 5u);
    EXPECT_EQ(bars.y_ticks[0].second, as_words(names[0]) + " z");
    EXPECT_EQ(bars.y_ticks[2].second, "s5 rate (1 %)");
    EXPECT_EQ(bars.series[0].rows[0][2], -0.4) << "a negative effect is a bar to the left";
    EXPECT_EQ(bars.series[0].rows[0][3], 0);

    // along the gradient (0.3, 0, -0.4), of size 0.5
    const auto arrows = page_columns(section.figures[0].table);
    std::vector<std::string> first;
    for (const auto& column : arrows) first.push_back(column.cells[0]);
    EXPECT_EQ(first,
              (std::vector<std::string>{as_words(names[0]), "+0.300", "0", "−0.400", "0.500"}));
    const auto words = figure(scene, "change-view-front").words;
    EXPECT_EQ(std::ranges::count(words, as_words(names[0]) + " 0.50", &Word::text), 1);
    EXPECT_EQ(std::ranges::count(words, as_words(names[1]), &Word::text), 0)
        << "the names of the points give way to those of the arrows";

    const auto map = page_columns(section.tables.back());
    EXPECT_EQ(map[1].heading, "left bump steer [deg/m]");
    EXPECT_EQ(map[0].cells[0], as_words(names[0]));
    EXPECT_EQ(map[1].cells[0], "0.50");
    EXPECT_EQ(map[1].shades[0], 1);
    EXPECT_NEAR(map[1].shades[1], 0.1, 1e-12);

    EXPECT_EQ(section_with(false).mark, Mark::open);
    expect_parts(said(scene, "change"), {"not confirmed"});
}

TEST(Sections, PartsThatWereNotComputedAreLeftOut) {
    std::vector<std::string> ids;
    for (const auto& section : sections_of(small_scene())) ids.push_back(section.id);
    EXPECT_EQ(ids, (std::vector<std::string>{"first", "drawing", "curves", "forces", "methods",
                                             "references", "deviation", "model"}));
}

// ---- How far the numbers can be trusted.

// The main outputs of a unit differ by this between the references on every branch.
void set_apart(SceneAnalyses& scene, compare::Unit unit, double max) {
    for (auto& branch : scene.comparison.branches)
        for (std::size_t c = 0; c < scene.comparison.channels.size(); ++c)
            if (const auto& channel = scene.comparison.channels[c];
                channel.main && channel.unit == unit)
                branch.uncertainty.equal_parameter.channels[c].max = max;
}

TEST(Sections, TrustSentenceHasTheDistanceOfTheReferencesAndTheProvedPoints) {
    SceneAnalyses scene = sample_scene();
    set_apart(scene, compare::Unit::mm, 9e-12);
    set_apart(scene, compare::Unit::deg, 2e-13);
    EXPECT_TRUE(said(scene, "first")
                    .starts_with("Every number on these pages: two independent solutions agree to "
                                 "9.0\u00a0×\u00a010⁻¹²\u00a0mm "
                                 "and 2.0\u00a0×\u00a010⁻¹³\u00a0deg, proved at "))
        << said(scene, "first");
    set_apart(scene, compare::Unit::mm, NAN);
    expect_parts(said(scene, "first"), {"agree to –\u00a0mm"});
    scene.comparison.branches[0].run(compare::Leg::equilibrium).proved.proved = 0;
    EXPECT_TRUE(
        std::regex_search(said(scene, "first"), std::regex("proved at \\d+ of \\d+ points")))
        << said(scene, "first");
}

TEST(Sections, TrustSentenceBeginsWithWhatCouldNotBeJudged) {
    SceneAnalyses scene = sample_scene();
    scene.reasons = {"jounce: energy leg: branch lost: at load 3"};
    EXPECT_TRUE(
        said(scene, "first")
            .starts_with("Not judged: jounce: energy leg: branch lost: at load 3; the numbers "
                         "below are no basis for a decision."))
        << said(scene, "first");
}

TEST(Sections, TrustSentenceClaimsNoAgreementForAnUnfinishedReference) {
    SceneAnalyses scene = sample_scene();
    for (auto& branch : scene.comparison.branches) {
        branch.run(compare::Leg::energy).curve.a.clear();
        branch.run(compare::Leg::energy).curve.values.clear();
        branch.uncertainty.equal_parameter.channels.clear();
    }
    EXPECT_FALSE(contains(said(scene, "first"), "agree to")) << said(scene, "first");
    for (const auto& section : sections_of(scene))
        if (section.id == "deviation")
            for (const auto& group : section.figures) {
                expect_parts(group.caption, {"Not both references reached the end"});
                expect_parts(group.figures[0].description, {}, {"apart"});
            }
}

// ---- Which fast method is good enough.

TEST(Sections, MethodsSectionHasATableOfErrorsAndTolerances) {
    SceneAnalyses scene = sample_scene();
    scene.judgement->position->max = 2.5;
    scene.judgement->angle_at_abscissa->max = 0.25;
    const std::string text = said(scene, "methods");
    expect_parts(text,
                 {"The cheapest method within 0.01\u00a0mm and 0.001\u00a0deg is series",
                  "The published recursion is off by up to 2.5\u00a0mm and ",
                  "0.25\u00a0deg at equal travel.", "| yes, recommended |",
                  "| published | steps of the scene | no | 2.5 |"},
                 {"| published | 80\u00a0steps | yes"});
}

// A method is within the tolerance by its own numbers; NaN never is.
TEST(Sections, MethodsAreWithinTheToleranceByTheirNumbers) {
    SceneAnalyses scene = sample_scene();
    const auto within = [&](double share) {
        for (auto& point : scene.trade->points)
            if (point.method == "published") point.share = share;
        return std::regex_search(said(scene, "methods"),
                                 std::regex("published . \\d+.*steps . yes"));
    };
    EXPECT_TRUE(within(0.5));
    EXPECT_FALSE(within(1.5));
    EXPECT_FALSE(within(NAN));
}

TEST(Sections, MethodsSectionNamesNoneWithoutARecommendation) {
    SceneAnalyses scene = sample_scene();
    scene.trade->recommendation.reset();
    expect_parts(said(scene, "methods"),
                 {"No fast method that was tried is recommended within 0.01\u00a0mm and "
                  "0.001\u00a0deg."});
}

// "at equal load" does not apply to a branch driven by a motion.
TEST(Sections, DeviationsOfADrivenMechanismAreNotCalledAtEqualLoad) {
    for (const auto& section : sections_of(sample_scene("slider_crank")))
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
TEST(Sections, LeadingBranchIsTheHeaveOfBothWheels) {
    SceneAnalyses scene = compared_scene("front_axle");
    const auto to_front = [&](auto& branches, std::size_t from) {
        std::rotate(branches.begin(), branches.begin() + static_cast<std::ptrdiff_t>(from),
                    branches.begin() + static_cast<std::ptrdiff_t>(from) + 1);
    };
    to_front(scene.model.branches, 1), to_front(scene.comparison.branches, 1);  // opposite travel
    EXPECT_EQ(leading_sweep(scene)->name, "parallel");
    const auto heave = [&](const auto& branch) {
        return branch.name == "parallel" || branch.name == "vertical";
    };
    std::erase_if(scene.comparison.branches,
                  [&](const auto& b) { return b.branch == "parallel" || b.branch == "vertical"; });
    std::erase_if(scene.model.branches, heave);
    EXPECT_EQ(leading_sweep(scene)->name, "opposite") << "else the first travel";
}

TEST(Sections, EveryBranchIsNamedByItsLoadCaseAtTheWheels) {
    const auto cases_of = [](const SceneAnalyses& scene) {
        std::map<std::string, std::string> cases;
        for (const auto& branch : scene.model.branches)
            cases[branch.name] = load_case(scene.model, branch);
        return cases;
    };
    EXPECT_EQ(cases_of(compared_scene("front_axle")),
              (std::map<std::string, std::string>{{"parallel", "heave"},
                                                  {"opposite", "roll"},
                                                  {"vertical", "heave"},
                                                  {"roll", "roll"},
                                                  {"steering", "steering"},
                                                  {"lateral", "lateral force"},
                                                  {"braking", "longitudinal force"},
                                                  {"traction", "longitudinal force"},
                                                  {"aligning", "moment"}}));
    EXPECT_EQ(cases_of(sample_scene("pinned_bar")).begin()->second, "other");
    EXPECT_EQ(cases_of(sample_scene()).begin()->second, "heave") << "by a load";
}

// In roll the right wheel goes the other way: over its own travel its toe is that of the left one.
TEST(Sections, CurvesOfEachWheelInRollAreOverItsOwnTravel) {
    SceneAnalyses scene = compared_scene("front_axle");
    const Figure coincide = figure(scene, "toe-travel");
    EXPECT_EQ(coincide.x, "wheel travel [mm]");
    EXPECT_EQ(coincide.series.size(), 4u) << "one curve a load case for both wheels";
    for (const auto& series : coincide.series)
        if (series.title.starts_with("opposite")) {
            ASSERT_GE(series.rows.size(), 10u);
            EXPECT_GT(series.rows.front()[1], series.rows.back()[1]) << "toe-out in jounce";
        }
    // A right wheel that is another one has a curve of its own.
    for (auto& branch : scene.comparison.branches)
        for (auto& point : truth_of(branch).values) point[channel_of(scene, "right.toe")] += 0.1;
    const Figure apart = figure(scene, "toe-travel");
    EXPECT_EQ(apart.series.size(), 8u);
    std::vector<std::string> legend;
    for (const auto& entry : apart.legend) legend.push_back(entry.title);
    EXPECT_EQ(legend, (std::vector<std::string>{"parallel", "opposite", "vertical", "roll", "left",
                                                "right"}));
}

// y points to the left: outwards for one wheel, inwards for the other.
TEST(Sections, LateralMovementIsPositiveOutwardsForBothWheels) {
    for (const auto& series : figure(compared_scene("front_axle"), "track-change-travel").series) {
        expect_parts(series.title, {}, {"right"});
        EXPECT_LT(series.rows.front()[1], 0) << "inwards in rebound";
    }
}

TEST(Sections, JounceAndReboundAreDrawnAsOneCurve) {
    const Figure toe = figure(sample_scene(), "toe-travel");
    ASSERT_EQ(toe.series.size(), 1u);
    const auto& rows = toe.series[0].rows;
    for (std::size_t k = 1; k < rows.size(); ++k) EXPECT_GT(rows[k][0], rows[k - 1][0]);
    EXPECT_LT(rows.front()[0], -10);
    EXPECT_GT(rows.back()[0], 10);
}

TEST(Sections, WheelLoadOverTravelContainsTheStaticLoad) {
    const Figure load = figure(compared_scene("front_axle"), "wheel-load-travel");
    EXPECT_EQ(load.y, "wheel load [N]");
    for (const auto& series : load.series) {
        const auto design = std::ranges::min_element(
            series.rows, {}, [](const auto& row) { return std::abs(row[0]); });
        EXPECT_NEAR((*design)[1], 3800, 400) << series.title;
    }
}

TEST(Sections, AbscissasAreNamedByTheDriveOfTheirBranch) {
    const SceneAnalyses& scene = compared_scene("front_axle");
    EXPECT_EQ(figure(scene, "toe-steering").x, "rack [mm]");
    EXPECT_EQ(figure(scene, "toe-force").x, "force [N]");
    for (const auto& section : sections_of(scene))
        for (const auto& group : section.figures)
            for (const auto& f : group.figures) expect_parts(f.x, {}, {"parameter"});
    expect_parts(said(scene, "steering"), {"Turning circle at full lock"});
}

TEST(Sections, FirstSectionShowsTheAlignmentAsDrawnAndAfterTheTrim) {
    SceneAnalyses scene = compared_scene("front_axle");
    const std::string text = said(scene, "first");
    expect_parts(text, {"settled after the trim (toe-in, top outwards positive)\n| of the wheel | "
                        "drawn left | drawn right | settled left | settled right ",
                        "| wheel load [N] | – | – | 3800 | 3800 |",
                        "| springs.coil_left.preload | 17.86 | N |"});
    auto& settled = truth_of(scene.comparison.branches[settled_on(scene.model)]);
    settled.values[settled.start][channel_of(scene, "left.toe")] = -0.0125;
    expect_parts(said(scene, "first"), {"| toe [deg] | 0 | 0 | −0.01250 | 0 |"});
}

TEST(Sections, FirstSectionHasKeyFiguresWithUnitsAndNoVerdict) {
    const std::string text = said(compared_scene("front_axle"), "first");
    expect_parts(text,
                 {"| wheel rate | ", "| N/mm |", "| roll centre height | ",
                  "| toe change at −80\u00a0mm | ", "| roll stiffness | "},
                 {"fail", "Fail", "off by", "published"});
}

// K = k t² / 2 for the wheels of an axle in roll. The bar has the part that is missing in heave, except for rubber that
// both deform; preloads that rotate have the rest of the sum.
TEST(Sections, RollStiffnessFollowsFromTheWheelRatesAndIsTheSumOfItsParts) {
    const SceneAnalyses& scene = compared_scene("front_axle");
    const double roll = rate(scene, "left.wheel_rate_in_roll"),
                 heave = rate(scene, "left.wheel_rate");
    ASSERT_GT(roll, heave);
    const double track = 2 * 1.1, stiffness = 1e3 * roll * track * track / 2 * M_PI / 180;
    const std::string text = said(scene, "rates");
    std::smatch found;
    ASSERT_TRUE(std::regex_search(text, found, std::regex("roll stiffness . (\\d+)")));
    EXPECT_NEAR(std::stod(found[1]), stiffness, 0.002 * stiffness);
    std::map<std::string, double> parts;
    for (const char* part : {"springs", "bar", "rubber"}) {
        ASSERT_TRUE(std::regex_search(
            text, found, std::regex(fmt::format("roll stiffness of {} . ([\\d.]+)", part))));
        parts[part] = std::stod(found[1]);
    }
    EXPECT_NEAR(parts["bar"] / stiffness, 1 - heave / roll, 1e-2);
    EXPECT_NEAR((parts["springs"] + parts["bar"] + parts["rubber"]) / stiffness, 1, 0.1);
}

// A force acts on both wheels, on one alone only if it is named so. Curves and figures are positive inwards.
TEST(Sections, CompliancesOfAnAxleAreThoseOfRigTestsWithBothWheelsLoaded) {
    const SceneAnalyses& scene = compared_scene("front_axle");
    expect_parts(said(scene, "first"),
                 {"| lateral force steer, parallel | ", "| lateral force steer, opposed | ",
                  "| braking force steer, both | ", "forces towards the middle of the vehicle"},
                 {"| lateral force steer | ", "alone"});
    expect_parts(said(scene, "rates"),
                 {"| traction force steer, both | ", "| aligning torque steer, opposed | ",
                  "| lateral stiffness, parallel | "},
                 {"alone"});
    const double steer = rate(scene, "left.lateral_force_steer@parallel");
    const Figure toe = figure(scene, "toe-force");
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
}

// Slopes of fitted lines are near the rates at the design position, in the signs of the tests.
TEST(Sections, GradientsOfFittedLinesAreNearTheRatesAndSayTheirRange) {
    const SceneAnalyses& scene = compared_scene("front_axle");
    const std::string text = said(scene, "gradients");
    expect_parts(text, {"parallel, over wheel travel from −16 to 16\u00a0mm",
                        "over roll towards the wheel from ", "lateral inwards, over force from ",
                        "braking to the back, over force from 0 to ",
                        "| gradient of | left | right "
                        "| mean | unit |"});
    const auto gradient = [&](const std::string& test, const std::string& of) {
        const auto from = text.find(test);
        std::smatch found;
        const std::string part = from == text.npos ? "" : text.substr(from);
        if (!std::regex_search(part, found,
                               std::regex("\n\\| " + of + " (?:\\| – )*\\| ((?:−)?)([\\d.]+)")))
            return double(NAN);
        return std::stod(found[2]) * (found[1].length() > 0 ? -1 : 1);
    };
    EXPECT_NEAR(gradient("parallel, over", "camber"), rate(scene, "left.bump_camber"), 0.05);
    EXPECT_NEAR(gradient("parallel, over", "wheel load"), rate(scene, "left.wheel_rate"), 0.1);
    EXPECT_NEAR(gradient("opposite, over", "toe"), rate(scene, "left.roll_steer"), 2e-3);
    EXPECT_NEAR(gradient("opposite, over", "roll moment"), rate(scene, "roll_stiffness"), 20);
    EXPECT_NEAR(gradient("lateral inwards", "toe"),
                rate(scene, "left.lateral_force_steer@parallel"), 2e-3);
    EXPECT_NEAR(gradient("steering, over", "steer angle"), -rate(scene, "left.steer_gradient"),
                5e-3);
}

// A stop touches where its spring has used the clearance, and has no force before.
TEST(Sections, StopsAreMarkedOnTheSpringCurvesWhereTheyTouch) {
    const SceneAnalyses& scene = compared_scene("front_axle");
    const Figure force = figure(scene, "force-springs");
    const auto series = [&](const std::string& title) {
        for (const auto& one : force.series)
            if (one.title.starts_with(title)) return one.rows;
        ADD_FAILURE() << "no curve " << title;
        return decltype(force.series[0].rows){};
    };
    const auto marks = series("a stop touches"), bump = series("coil bump stop");
    ASSERT_EQ(marks.size(), 2u) << "bump and rebound, once for both sides";
    const auto coil = figure(scene, "compression-springs").series.at(0).rows;
    for (const auto& mark : marks) {  // compression there, between two points of the curve
        const auto above =
            std::ranges::find_if(coil, [&](const auto& row) { return row[0] > mark[0]; });
        ASSERT_NE(above, coil.end());
        ASSERT_NE(above, coil.begin());
        const auto &low = *(above - 1), &high = *above;
        const double share = (mark[0] - low[0]) / (high[0] - low[0]);
        EXPECT_NEAR(low[1] + share * (high[1] - low[1]), mark[0] > 0 ? 25 : -30, 0.1);
    }
    const double touches = std::max(marks[0][0], marks[1][0]);
    for (const auto& row : bump) EXPECT_EQ(row[1] > 0, row[0] > touches + 1e-9) << row[0];
}

TEST(Sections, RollMomentAndToeInRollAreDrawnOverTheRollAngle) {
    const SceneAnalyses& scene = compared_scene("front_axle");
    const Figure moment = figure(scene, "roll-moment-roll");
    EXPECT_EQ(moment.x, "roll angle [deg]");
    const double stiffness = rate(scene, "roll_stiffness");
    for (const auto& series : moment.series)
        for (std::size_t k = 1; k < series.rows.size(); ++k) {
            const auto &a = series.rows[k - 1], &b = series.rows[k];
            if (std::abs(b[0]) < 1) {
                EXPECT_NEAR((b[1] - a[1]) / (b[0] - a[0]), stiffness, 0.05 * stiffness) << b[0];
            }
        }
    EXPECT_EQ(figure(scene, "toe-roll").series.size(), 4u) << "of either wheel in both load cases";
}

TEST(Sections, ConditionsSaySupportOfTheWheelsInEachLoadCase) {
    expect_parts(
        said(compared_scene("front_axle"), "conditions"),
        {"| parallel | heave | −80 | 80 | mm |", "| jacks that move |", "| jacks at held height |",
         "| dead forces, free in height |", "the wheel held to its carrier", "wheelbase 2700 mm"});
}

TEST(Sections, MotionRatioOfASpringIsInTheColumnOfItsWheel) {
    const std::string text = said(compared_scene("front_axle"), "rates");
    EXPECT_TRUE(
        std::regex_search(text, std::regex("\\| coil motion ratio \\| 0\\.\\d+ \\| 0\\.\\d+ ")))
        << text;
    expect_parts(text, {}, {"coil right", "coil left"});
}

TEST(Sections, TrackChangeIsFromTheDrawnPositionInSolveOnThePageAndInItsFigure) {
    SceneAnalyses scene = compared_scene("front_axle");
    const std::size_t change = channel_of(scene, "left.track_change");
    auto& values = truth_of(scene.comparison.branches[0]).values;
    for (auto& point : values) point[change] += 0.5;  // settled inwards of the drawn position
    const double at_the_end = values.front()[change];
    expect_parts(said(scene, "first"),
                 {"| track change at −80\u00a0mm | " + number(at_the_end, 4) + " |",
                  "track change from the drawn position"});
    for (const auto& series : figure(scene, "track-change-travel").series)
        if (series.title.ends_with("left") && series.title.starts_with("parallel")) {
            EXPECT_NEAR(series.rows.front()[1], at_the_end, 1e-9);
        }
}

// A quotient of a rounding error and a value that is zero is no percentage.
TEST(Sections, RateThatIsZeroHasNoPercentage) {
    SceneAnalyses scene = compared_scene("front_axle");
    auto& branch = scene.comparison.branches.front();
    const std::size_t rate = channel_of(scene, "left.bump_steer");
    const auto set = [&](compare::Leg leg, double value) {
        auto& curve = branch.run(leg).curve;
        curve.values[curve.start][rate] = value;
    };
    set(compare::Leg::equilibrium, 3.5e-4), set(compare::Leg::recursive, 0.30035);
    expect_parts(said(scene, "deviation"), {"| +0.300 | – |"});
}

// As `inspect` shows it, the details left out.
TEST(Sections, ModelIsThatOfInspect) {
    const std::string text = said(compared_scene("front_axle"), "model");
    expect_parts(text,
                 {"As drawn; condition of eq. (24), equilibrated\n| degrees of freedom | ",
                  "| as solved | ", "| springs.coil_left.preload | 17.86 | N |",
                  "Elastic elements\n| element | between | law "},
                 {"numbers, as --set"});
}

TEST(Sections, ForcesOfAStopAreShownWithItsPenetration) {
    const SceneAnalyses& scene = compared_scene("front_axle");
    double deflection = 0;
    for (const auto& row : force_rows(scene.model, scene.comparison))
        if (row.branch == "parallel" && row.end == 80 &&
            row.output == "coil_left.bump_stop.deflection")
            deflection = row.value;
    ASSERT_GT(deflection, 25);
    std::smatch found;
    const std::string text = said(scene, "forces");
    ASSERT_TRUE(std::regex_search(
        text, found, std::regex("coil_left.bump_stop . \\d+ . parallel, 80 mm . (\\d+)")))
        << text;
    EXPECT_NEAR(std::stod(found[1]), deflection - 25, 0.5);
}

TEST(Sections, LargestForcesAlongABranchAreShownWithTheirParameter) {
    SceneAnalyses scene = compared_scene("twist_beam");
    auto& branch = scene.comparison.branches[0];
    for (auto& force : branch.run(compare::Leg::equilibrium).largest)
        force.a = -12.5, force.value = 1e6;
    expect_parts(said(scene, "forces"),
                 {fmt::format("{}, −12.5 {}", branch.branch, symbol(branch.unit))});
}

TEST(Sections, ForcesOfABeamAreThoseOfItsMostLoadedSegment) {
    const SceneAnalyses& scene = compared_scene("twist_beam");
    std::set<std::string> beams;
    for (const auto& elastic : scene.model.elastics)
        if (elastic.written_as == WrittenAs::beam)
            beams.insert(elastic.name.substr(0, elastic.name.rfind('.')));
    ASSERT_FALSE(beams.empty());
    const std::string text = said(scene, "forces");
    for (const auto& beam : beams) {
        expect_parts(text, {"| " + beam + " | "}, {"| " + beam + ".1 | "});
    }
}

TEST(Sections, WarningsOfTheReaderStandBelowTheFirstSentence) {
    SceneAnalyses scene = sample_scene();
    expect_parts(said(scene, "first"), {}, {"Warning"});
    scene.warnings = {"a.yaml:3: too large", "a.yaml:9: too soft"};
    const std::string text = said(scene, "first");
    expect_parts(text, {"\n\nWarning: a.yaml:3: too large", "\n\nWarning: a.yaml:9: too soft"});
}

}  // namespace
}  // namespace elastocheck::reports
