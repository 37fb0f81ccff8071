// Judgement of external candidates: same criteria as for the recursion, typical faults are named,
// missing data never passes.
#include "compare/candidate/candidate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/command.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Kind = Explanation::Kind;

struct Solved {
    Model model = compile(support::scene("chrono_mcpherson"));
    Comparison comparison;
    Solved() {
        Options options;
        options.recursion.steps = 40;
        options.prove = false;
        comparison = compare(model, options);
    }
    std::size_t channel(const char* name) const {
        return static_cast<std::size_t>(find_channel(comparison.channels, name));
    }
};
const Solved& solved() {
    static const Solved once;
    return once;
}

// Result of a leg, as a table of the main outputs and travel.
Candidate table_of(Leg leg) {
    const auto& all = solved().comparison;
    Candidate candidate;
    candidate.name = "mysolver";
    for (std::size_t c = 0; c < all.channels.size(); ++c)
        if (all.channels[c].main || all.channels[c].name == "travel")
            candidate.points.columns.push_back({c, false, {}});
    for (const auto& branch : all.branches) {
        const Curve& curve = branch.run(leg).curve;
        for (std::size_t k = 0; k < curve.a.size(); ++k) {
            candidate.points.branch.push_back(branch.branch);
            candidate.points.a.push_back(curve.a[k]);
            for (auto& column : candidate.points.columns)
                column.values.push_back(curve.values[k][column.channel]);
        }
    }
    return candidate;
}

// The points for which `keep` holds.
Candidate only(const Candidate& all, const std::function<bool(std::size_t)>& keep) {
    Candidate part = all;
    part.points.a.clear(), part.points.branch.clear();
    for (auto& column : part.points.columns) column.values.clear();
    for (std::size_t k = 0; k < all.points.a.size(); ++k) {
        if (!keep(k)) continue;
        part.points.a.push_back(all.points.a[k]);
        part.points.branch.push_back(all.points.branch[k]);
        for (std::size_t c = 0; c < part.points.columns.size(); ++c)
            part.points.columns[c].values.push_back(all.points.columns[c].values[k]);
    }
    return part;
}

std::vector<double>& values(Candidate& candidate, const char* name) {
    return std::ranges::find(candidate.points.columns, solved().channel(name),
                             &PointColumn::channel)
        ->values;
}

CandidateJudgement judged(const Candidate& candidate) {
    return judge_candidate(solved().model, solved().comparison, candidate);
}

std::string texts(const CandidateJudgement& judgement) {
    std::string text = name(judgement.verdict);
    for (const auto* list : {&judgement.reasons, &judgement.hints, &judgement.not_given})
        for (const auto& one : *list) text += "; " + one;
    return text;
}

// Explanation of this kind for one column, or null.
const Explanation* explained(const CandidateJudgement& judgement, const char* name, Kind kind) {
    for (const auto& one : judgement.explanations)
        if (one.kind == kind && judgement.columns[one.column].channel == solved().channel(name))
            return &one;
    return nullptr;
}

TEST(Candidate, ReferenceAsCandidatePassesWithoutDeviation) {
    for (const Leg leg : {Leg::equilibrium, Leg::energy}) {
        const auto judgement = judged(table_of(leg));
        EXPECT_EQ(judgement.verdict, Grade::pass) << texts(judgement);
        EXPECT_TRUE(judgement.hints.empty() && judgement.not_given.empty()) << texts(judgement);
        ASSERT_EQ(judgement.branches.size(), 2u);
        for (const auto& branch : judgement.branches)
            for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa})
                for (const auto& d : branch.reading(kind).columns) {
                    EXPECT_GE(d.compared, 40);
                    EXPECT_LE(d.max, 1e-8);
                }
    }
}

TEST(Candidate, RecursionAsCandidateHasTheDeviationsOfTheRecursion) {
    const auto judgement = judged(table_of(Leg::recursive));
    EXPECT_EQ(judgement.verdict, Grade::fail);
    int compared = 0;
    for (std::size_t b = 0; b < judgement.branches.size(); ++b) {
        const auto& ours = solved().comparison.branches[b].deviation;
        const auto& theirs = judgement.branches[b];
        for (std::size_t c = 0; c < judgement.columns.size(); ++c) {
            const auto& expected = ours.equal_parameter.channels[judgement.columns[c].channel];
            const auto& got = theirs.equal_parameter.columns[c];
            EXPECT_EQ(got.signed_max, expected.signed_max);
            EXPECT_EQ(got.at, expected.at);
            EXPECT_EQ(got.rms, expected.rms);
            EXPECT_EQ(got.range, expected.range);
            EXPECT_EQ(got.compared, expected.compared);
            compared += got.compared;
            // At equal travel the recursion's reading is interpolated, this one is not. The last
            // common points differ by half a step: one of the recursion, one of the reference.
            if (judgement.columns[c].channel == solved().channel("toe")) {
                const double there =
                    ours.equal_abscissa.channels[judgement.columns[c].channel].signed_max;
                EXPECT_NEAR(theirs.equal_abscissa.columns[c].signed_max, there,
                            0.05 * std::abs(there));
            }
        }
    }
    EXPECT_GT(compared, 400);
}

// A column that is negated, scaled, shifted or converted fails, and the change is named in numbers and words.
TEST(Candidate, TransformedColumnFailsAndItsTransformIsNamed) {
    const double drawn_z =
        evaluate(solved().model, solved().comparison.channels,
                 design_state(solved().model))[solved().channel("wheel_centre_z")];
    const struct {
        const char* column;
        double factor, offset, about;  // about + factor (v - about) + offset
        Kind kind;
        const char* unit_word;
        const char* hint;  // begin of the hint; empty: not compared
    } cases[] = {
        {"toe", -1, 0, 0, Kind::sign, "", "toe agrees to "},
        {"camber", 1, 0.5, 0, Kind::offset, "", ""},
        {"wheel_centre_y", -1, 12, 0, Kind::sign_and_offset, "", ""},
        {"wheel_centre_z", 1.001, 0, drawn_z, Kind::factor, "",
         "wheel_centre_z is 0.1 % too large throughout"},
        {"toe", std::numbers::pi / 180, 0, 0, Kind::factor, "radians for degrees", ""},
        {"toe", -std::numbers::pi / 180, 0, 0, Kind::factor, "radians for degrees", ""},
        {"camber", 60, 0, 0, Kind::factor, "minutes of arc for degrees", ""},
        {"camber", -60, 0, 0, Kind::factor, "minutes of arc for degrees", ""},
        {"wheel_centre_y", 1e-3, 0, 0, Kind::factor, "metres for millimetres, or the like", ""},
        {"wheel_centre_y", -1e-3, 0, 0, Kind::factor, "metres for millimetres, or the like", ""},
        {"wheel_centre_z", 1 / 25.4, 0, 0, Kind::factor, "inches for millimetres", ""},
        {"wheel_centre_z", -1 / 25.4, 0, 0, Kind::factor, "inches for millimetres", ""}};
    for (const auto& [column, factor, offset, about, kind, unit_word, hint] : cases) {
        Candidate candidate = table_of(Leg::equilibrium);
        for (double& v : values(candidate, column)) v = about + factor * (v - about) + offset;
        const auto judgement = judged(candidate);
        EXPECT_EQ(judgement.verdict, Grade::fail) << column << factor;
        const auto* found = explained(judgement, column, kind);
        ASSERT_NE(found, nullptr) << column << factor << texts(judgement);
        EXPECT_LE(found->left, about == 0 ? 1e-8 : 1e-4);
        EXPECT_EQ(found->unit_word, unit_word);
        EXPECT_NEAR(found->offset, offset, 1e-8);
        if (kind == Kind::factor) {
            EXPECT_NEAR(found->factor, factor, 1e-6 * std::abs(factor)) << column;
        }
        ASSERT_EQ(judgement.hints.size(), 1u) << texts(judgement);
        EXPECT_TRUE(judgement.hints[0].starts_with(hint)) << judgement.hints[0];
    }
}

TEST(Candidate, TwoExchangedColumnsAreNamed) {
    Candidate candidate = table_of(Leg::equilibrium);
    std::swap(values(candidate, "toe"), values(candidate, "camber"));
    const auto judgement = judged(candidate);
    EXPECT_EQ(judgement.verdict, Grade::fail);
    ASSERT_EQ(judgement.hints.size(), 1u) << texts(judgement);
    EXPECT_TRUE(judgement.hints[0].starts_with("toe and camber are changed over"))
        << judgement.hints[0];
}

TEST(Candidate, ColumnWrongFromAPointOnIsReportedWithItsLastRightPoint) {
    Candidate candidate = table_of(Leg::equilibrium);
    auto& toe = values(candidate, "toe");
    double last_right = 0;
    for (std::size_t k = 0; k < toe.size(); ++k) {
        if (candidate.points.branch[k] != "jounce") continue;
        if (candidate.points.a[k] > 1600)
            toe[k] += 1e-5 * (candidate.points.a[k] - 1400);
        else
            last_right = candidate.points.a[k];
    }
    const auto judgement = judged(candidate);
    EXPECT_EQ(judgement.verdict, Grade::fail);
    const auto* found = explained(judgement, "toe", Kind::from_there_on);
    ASSERT_NE(found, nullptr) << texts(judgement);
    EXPECT_EQ(found->branch, "jounce");
    EXPECT_EQ(found->at, last_right);
}

TEST(Candidate, SmoothErrorOfToeFailsWithoutANamedCause) {
    for (const double power : {1.5, 2., 3., 4., 5., 6.}) {
        Candidate candidate = table_of(Leg::equilibrium);
        auto& toe = values(candidate, "toe");
        for (std::size_t k = 0; k < toe.size(); ++k)
            toe[k] += 0.02 * std::pow(std::abs(candidate.points.a[k]) / 3000, power);
        const auto judgement = judged(candidate);
        EXPECT_EQ(judgement.verdict, Grade::fail);
        EXPECT_TRUE(judgement.hints.empty()) << power << texts(judgement);
    }
}

TEST(Candidate, CandidateWithAnInfiniteOutputOrParameterIsNotJudged) {
    for (const char* name : {"toe", "wheel_centre_x", "travel"}) {
        Candidate candidate = table_of(Leg::equilibrium);
        values(candidate, name)[7] = INFINITY;  // as a reader passes a value that is not a number
        const auto judgement = judged(candidate);
        EXPECT_EQ(judgement.verdict, Grade::not_judged) << name << texts(judgement);
    }
    Candidate candidate = table_of(Leg::equilibrium);
    candidate.points.a[7] = INFINITY;
    EXPECT_EQ(judged(candidate).verdict, Grade::not_judged);
}

TEST(Candidate, CandidateOfSomeBranchesIsJudgedOnTheseAndTheOthersAreReportedAsMissing) {
    const Candidate all = table_of(Leg::equilibrium);
    Candidate part = only(all, [&](std::size_t k) {
        return all.points.branch[k] == "jounce" && all.points.a[k] <= 1500;
    });
    auto judgement = judged(part);
    EXPECT_EQ(judgement.verdict, Grade::pass) << texts(judgement);
    EXPECT_EQ(judgement.not_given, (std::vector<std::string>{"branch 'jounce' from 1500 to 3000 N",
                                                             "branch 'rebound'"}));
    part.complete = true;  // whole branches were requested, so a missing part is a failure
    judgement = judged(part);
    EXPECT_EQ(judgement.verdict, Grade::not_judged);
    EXPECT_EQ(judgement.reasons.size(), 2u) << texts(judgement);
}

// Missing data never counts as correct: points without loads that end early, a gap in one column,
// points at the ends alone, a point beyond the end.
TEST(Candidate, MissingPointsColumnsAndEndsAreReported) {
    const Candidate all = table_of(Leg::equilibrium);
    const std::size_t travel = solved().channel("travel");
    const auto without_loads = [&](double share) {
        Candidate part = all;
        part.points.a.clear();
        part.points.abscissa = travel;
        const auto& at =
            std::ranges::find(part.points.columns, travel, &PointColumn::channel)->values;
        part.points.at = at;
        for (std::size_t k = 0; k < at.size(); ++k)
            if (std::abs(all.points.a[k]) > share * 3000)
                for (auto& column : part.points.columns) column.values[k] = std::nan("");
        return part;
    };
    EXPECT_TRUE(judged(without_loads(1)).not_given.empty()) << texts(judged(without_loads(1)));
    auto judgement = judged(without_loads(0.5));
    EXPECT_EQ(judgement.verdict, Grade::pass);
    ASSERT_EQ(judgement.not_given.size(), 2u) << texts(judgement);
    EXPECT_TRUE(judgement.not_given[0].starts_with("branch 'jounce' from "))
        << judgement.not_given[0];
    EXPECT_TRUE(judgement.not_given[0].ends_with(" mm"));

    Candidate column = all;
    for (std::size_t k = 0; k < all.points.a.size(); ++k)
        if (all.points.a[k] > 750) values(column, "camber")[k] = std::nan("");
    judgement = judged(column);
    EXPECT_EQ(judgement.not_given,
              std::vector<std::string>{"camber on branch 'jounce' from 750 to 3000 N"});
    column.complete = true;
    EXPECT_EQ(judged(column).verdict, Grade::not_judged);

    Candidate ends = all;  // both ends of every branch
    for (std::size_t k = 0; k < all.points.a.size(); ++k)
        if (all.points.a[k] != 0 && std::abs(all.points.a[k]) != 3000)
            for (auto& c : ends.points.columns) c.values[k] = std::nan("");
    EXPECT_EQ(judged(ends).not_given,
              (std::vector<std::string>{"branch 'jounce' from 0 to 3000 N",
                                        "branch 'rebound' from -3000 to 0 N"}));

    Candidate beyond = all;
    beyond.points.branch.push_back("jounce");
    beyond.points.a.push_back(6000);
    for (auto& c : beyond.points.columns) c.values.push_back(7);
    EXPECT_EQ(judged(beyond).outside, 1);
    EXPECT_EQ(judged(all).outside, 0);
}

// With the default tolerance a given force is judged by a share of its extent; a force that is not
// given does not count as correct.
TEST(Candidate, WrongForceFailsEvenIfAllPositionsAreRight) {
    const auto without = judged(table_of(Leg::equilibrium));
    EXPECT_EQ(without.others, 0);
    EXPECT_TRUE(without.has_forces);
    const auto c = solved().channel("tie_rod.force_y");
    const auto with = [&](double share) {
        Candidate candidate = table_of(Leg::equilibrium);
        auto& column = candidate.points.columns.emplace_back(PointColumn{c, false, {}});
        for (const auto& branch : solved().comparison.branches)
            for (const auto& row : branch.run(Leg::equilibrium).curve.values)
                column.values.push_back(row[c] + share * branch.extents[c]);
        return judged(candidate);
    };
    const auto wrong = with(0.07), right = with(0.005);
    EXPECT_EQ(wrong.verdict, Grade::fail) << texts(wrong);
    EXPECT_EQ(wrong.others, 1);
    ASSERT_EQ(wrong.worst.size(), 3u);
    EXPECT_EQ(wrong.worst.back().channel, "tie_rod.force_y");
    EXPECT_NEAR(wrong.worst.back().max / wrong.worst.back().extent, 0.07, 1e-9);
    EXPECT_EQ(right.verdict, Grade::pass) << texts(right);
}

TEST(Candidate, CandidateOfConstantColumnsIsNotJudgedAndASingleConstantColumnFails) {
    Candidate candidate = table_of(Leg::equilibrium);
    const double all_over[] = {1, 2, 3, 4, 5, 6};
    std::size_t c = 0;
    for (auto& column : candidate.points.columns) {
        std::ranges::fill(column.values, all_over[c++ % 6]);
    }
    const auto judgement = judged(candidate);
    EXPECT_EQ(judgement.verdict, Grade::not_judged);
    support::expect_parts(texts(judgement), {"nothing moves in it"});
    // A single constant output is a wrong output.
    Candidate one = table_of(Leg::equilibrium);
    std::ranges::fill(values(one, "toe"), values(one, "toe").front());
    const auto still = judged(one);
    EXPECT_EQ(still.verdict, Grade::fail);
    EXPECT_NE(explained(still, "toe", Kind::still), nullptr) << texts(still);
}

// Ackermann's percentage is undefined straight ahead: the reason names the output, not its points.
TEST(Candidate, CandidateWhoseOnlyOutputIsUndefinedIsNotJudged) {
    Comparison comparison = solved().comparison;
    const std::size_t toe = solved().channel("toe");
    for (auto& branch : comparison.branches) branch.determined[toe] = false;
    Candidate candidate = table_of(Leg::equilibrium);
    std::erase_if(candidate.points.columns, [&](const auto& c) { return c.channel != toe; });
    const auto judgement = judge_candidate(solved().model, comparison, candidate);
    EXPECT_EQ(judgement.verdict, Grade::not_judged);
    support::expect_parts(texts(judgement), {"its 'toe' is not compared"});
    EXPECT_EQ(texts(judgement).find("all where the branches begin"), std::string::npos);
}

// Points at a = 0 alone agree with the reference by definition, so that they prove nothing.
TEST(Candidate, PointsAtZeroParameterAloneAreNotJudged) {
    const Candidate all = table_of(Leg::equilibrium);
    const Candidate right = only(all, [&](std::size_t k) { return all.points.a[k] == 0; });
    ASSERT_FALSE(right.points.a.empty());
    const auto judgement = judged(right);
    EXPECT_EQ(judgement.verdict, Grade::not_judged);
    support::expect_parts(texts(judgement), {"its points are all where the branches begin"});
    Candidate wrong = right;
    for (double& v : values(wrong, "toe")) v += 1;
    EXPECT_EQ(judged(wrong).verdict, Grade::fail);
}

TEST(Candidate, CandidateWithoutComparableNumbersIsNotJudged) {
    Candidate nowhere = table_of(Leg::equilibrium);
    for (double& a : nowhere.points.a) a += 1e6;
    for (double& t : values(nowhere, "travel")) t += 1e6;
    EXPECT_EQ(judged(nowhere).verdict, Grade::not_judged);
    Candidate empty = table_of(Leg::equilibrium);
    for (auto& column : empty.points.columns) std::ranges::fill(column.values, std::nan(""));
    EXPECT_EQ(judged(empty).verdict, Grade::not_judged);
    // Numbers without a tolerance.
    EXPECT_EQ(judge_candidate(solved().model, solved().comparison, table_of(Leg::equilibrium),
                              parse_tolerance("1N", ToleranceParts::with_forces))
                  .verdict,
              Grade::not_judged);
}

TEST(Candidate, CandidateAtOtherLoadsIsComparedWithTheReferenceSolvedThere) {
    // Every third point, and others between the recursion's points; the reference is solved there.
    Candidate candidate;
    candidate.name = "mysolver";
    const auto toe = solved().channel("toe"), travel = solved().channel("travel");
    candidate.points.columns = {{toe, false, {}}, {travel, false, {}}};
    const BranchSide side = sides_of(solved().model, solved().model.branches[0], 7).front();
    const auto path = solve_branch(side, {.leg = Leg::energy});
    for (const auto& point : path.points) {
        const auto row = evaluate(solved().model, solved().comparison.channels, point);
        candidate.points.branch.push_back("jounce");
        candidate.points.a.push_back(point.load);
        candidate.points.columns[0].values.push_back(row[toe]);
        candidate.points.columns[1].values.push_back(row[travel]);
    }
    const auto judgement = judged(candidate);
    EXPECT_EQ(judgement.verdict, Grade::pass) << texts(judgement);
    for (const auto kind : {ReadingKind::equal_parameter, ReadingKind::equal_abscissa}) {
        EXPECT_EQ(judgement.branches[0].reading(kind).columns[0].compared, 8);
        EXPECT_LE(judgement.branches[0].reading(kind).columns[0].max, 1e-9);
    }
    candidate.points.a.clear();  // placed by travel only
    candidate.points.abscissa = travel, candidate.points.at = candidate.points.columns[1].values;
    const auto over_travel = judged(candidate);
    EXPECT_EQ(over_travel.verdict, Grade::pass) << texts(over_travel);
    EXPECT_FALSE(over_travel.branches[0].equal_parameter.not_compared.empty());
}

// ---- States and solvers.

TEST(Candidate, LegAsASolverFunctionIsJudgedAsThatLeg) {
    const auto& all = solved().comparison;
    const auto run = [&](Leg leg) {
        const CandidateSolver solver = [&](const Model& model, const Branch& branch,
                                           std::span<const double>) {
            return solve_branch(BranchSide{branch.name, model, branch}, {.leg = leg});
        };
        return judged(candidate_of(solved().model, all, "mine", solver));
    };
    const auto exact = run(Leg::energy), off = run(Leg::recursive);
    EXPECT_EQ(exact.verdict, Grade::pass) << texts(exact);
    EXPECT_EQ(off.verdict, Grade::fail) << texts(off);
    ASSERT_EQ(exact.state_residuals.size(), 2u);
    for (std::size_t b = 0; b < 2; ++b) {
        const Bounds& bounds = all.branches[b].bounds;
        double by_energy = 0, length = 0;
        for (std::size_t k = 0; k < exact.state_residuals[b].truth.size(); ++k) {
            EXPECT_LE(exact.state_residuals[b].truth[k].force, bounds.residual_force);
            EXPECT_LE(exact.state_residuals[b].truth[k].moment, bounds.residual_moment);
            EXPECT_LE(1e3 * exact.state_residuals[b].truth[k].length, bounds.residual_length);
            EXPECT_LE(exact.state_residuals[b].by_second[k].force, bounds.residual_force);
        }
        // The energy leg uses no reactions: its residuals are the same for the recursion and
        // for a candidate.
        for (std::size_t k = 0; k < off.state_residuals[b].truth.size(); ++k) {
            by_energy = std::max(by_energy, off.state_residuals[b].by_second[k].force);
            length = std::max(length, off.state_residuals[b].truth[k].length);
        }
        const auto& judged_then = all.branches[b].runs[0].judged;
        EXPECT_NEAR(by_energy, judged_then[2].force, 1e-6 * by_energy);
        EXPECT_NEAR(length, judged_then[1].length, 1e-12);
    }
}

TEST(Candidate, StateDisplacedByATenthOfAMillimetreHasAForceResidual) {
    const auto& all = solved().comparison;
    const BranchSide side = sides_of(solved().model, solved().model.branches[0], 4).front();
    const auto path = solve_branch(side, {.leg = Leg::equilibrium});
    std::vector<CandidateState> states;
    for (const auto& point : path.points) states.push_back({"jounce", point.load, point.poses});
    const auto at_rest = candidate_of(solved().model, all, "mine", states);
    for (auto& pose : states.back().poses)
        pose.r += Eigen::Vector3d(0, 0, 1e-4);  // all bodies by 0.1 mm: bushings and springs deform
    const auto moved = candidate_of(solved().model, all, "mine", states);
    ASSERT_EQ(moved.state_residuals.size(), 1u);
    EXPECT_LE(at_rest.state_residuals[0].truth.back().force, 1e-6);
    EXPECT_GE(moved.state_residuals[0].truth.back().force, 1);
    EXPECT_GE(moved.state_residuals[0].by_second.back().force, 1);
    EXPECT_EQ(moved.state_residuals[0].truth.front().force,
              at_rest.state_residuals[0].truth.front().force);
}

TEST(Candidate, CandidateOfAFailedSolverIsNotJudged) {
    const CandidateSolver nothing = [](const Model&, const Branch&, std::span<const double>) {
        return EquilibriumPath{Outcome::iteration_limit, "gave up", {}, {}};
    };
    const auto judgement =
        judged(candidate_of(solved().model, solved().comparison, "mine", nothing));
    EXPECT_EQ(judgement.verdict, Grade::not_judged) << texts(judgement);
    const CandidateSolver no_numbers = [](const Model& model, const Branch& branch,
                                          std::span<const double>) {
        auto path = solve_branch(BranchSide{branch.name, model, branch}, {.leg = Leg::equilibrium});
        path.points.back().poses.front().r.y() = std::nan("");
        return path;
    };
    const auto nan = judged(candidate_of(solved().model, solved().comparison, "mine", no_numbers));
    EXPECT_EQ(nan.verdict, Grade::not_judged) << texts(nan);
}

TEST(Candidate, TolerancesInNewtonsAreAcceptedOnlyWithForces) {
    const Tolerance all = parse_tolerance("0.01mm,0.001deg,1N,2Nm", ToleranceParts::with_forces);
    EXPECT_EQ(all.newton, 1);
    EXPECT_EQ(all.newton_metre, 2);
    EXPECT_THROW((void)parse_tolerance("0.01mm,1N"), std::invalid_argument);
    EXPECT_THROW((void)parse_tolerance("1N,2N", ToleranceParts::with_forces),
                 std::invalid_argument);
}

}  // namespace
}  // namespace elastocheck::compare
