// Verdict: one rule and one sentence in all outputs.
#include "compare/candidate/judgement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/deviation/tolerance.hpp"
#include "elastocheck/compile.hpp"
#include "reports/tables/judgement.hpp"
#include "tests/reports/command.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

using compare::Assessment;
using compare::Grade;

const Model& mcpherson() {
    static const Model model = compile(support::scene("chrono_mcpherson"));
    return model;
}
const compare::Comparison& compared() {
    static const compare::Comparison comparison = [] {
        compare::Options options;
        options.recursion.steps = 20;
        return compare::compare(mcpherson(), options);
    }();
    return comparison;
}

TEST(Assessment, VanishingDeviationsAreCalledRoundOff) {
    auto j = compare::assess(mcpherson(), compared(), compare::default_tolerance, false);
    j.requested = false, j.verdict = Grade::pass, j.wheel_rate.reset();
    for (auto* worst : {&j.position, &j.angle}) (*worst)->max = 1e-12;
    for (auto* worst :
         {&j.position_at_abscissa, &j.angle_at_abscissa, &j.other, &j.other_at_abscissa})
        worst->reset();
    expect_parts(sentence(j), {"The linear recursion as published is exact to round-off; "},
                 {"nothing"});
    j.requested = true;
    expect_parts(sentence(j), {"off by at most round-off; "}, {"nothing"});
}

TEST(Assessment, VerdictFollowsFromTheLargestDeviationAndTheTolerance) {
    const auto j = compare::assess(mcpherson(), compared(), compare::default_tolerance, false);
    EXPECT_EQ(j.verdict, Grade::fail);
    ASSERT_TRUE(j.position && j.angle && j.wheel_rate);
    // of every position and angle, main or not
    double mm = compare::as_position(*j.wheel_rate), deg = 0;
    for (const auto& branch : compared().branches)
        for (const auto* reading :
             {&branch.deviation.equal_parameter, &branch.deviation.equal_abscissa})
            for (std::size_t c = 0; c < reading->channels.size(); ++c)
                if (const auto& channel = compared().channels[c]; compare::is_motion(channel)) {
                    double& most = channel.unit == compare::Unit::mm ? mm : deg;
                    most = std::max(most, reading->channels[c].max);
                }
    EXPECT_EQ(compare::assess(mcpherson(), compared(), {1.01 * mm, 1.01 * deg}).verdict,
              Grade::pass);
    EXPECT_EQ(compare::assess(mcpherson(), compared(), {0.99 * mm, 1.01 * deg}).verdict,
              Grade::fail);
    EXPECT_EQ(compare::assess(mcpherson(), compared(), {1.01 * mm, 0.99 * deg}).verdict,
              Grade::fail);
    EXPECT_EQ(compare::assess(mcpherson(), compared(), {0.99 * j.position->max, 1}).verdict,
              Grade::fail);
    EXPECT_EQ(compare::assess(mcpherson(), compared(), {10, 0.99 * j.angle->max}).verdict,
              Grade::fail);
    EXPECT_EQ(compare::assess(mcpherson(), compared(), compare::parse_tolerance("10mm")).verdict,
              Grade::pass)
        << "an angle that nobody asked about";
}

// Joint forces, drive forces and rates are judged like positions: a single one with an error of
// `share` of its extent decides the verdict.
TEST(Assessment, WrongForceOrRateFailsEvenIfAllPositionsAreRight) {
    const Model model = compile(support::scene("chrono_mcpherson_travel"));
    compare::Options options;
    options.recursion.method = recursive::find_method("series").value();
    options.recursion.steps = 10;
    const auto right = compare::compare(model, options);
    const auto whole = compare::assess(model, right, compare::default_tolerance, false);
    ASSERT_EQ(whole.verdict, Grade::pass) << sentence(whole);
    expect_parts(sentence(whole), {"is exact to round-off", " outputs compared, "});
    EXPECT_GT(whole.others, 20);
    int spoiled = 0;
    for (std::size_t c = 0; c < right.channels.size(); ++c) {
        const auto& channel = right.channels[c];
        if (compare::is_motion(channel) || !right.branches[0].determined[c]) continue;
        const auto off_by = [&](double share) {
            auto comparison = right;
            auto& branch = comparison.branches[0];
            branch.deviation.equal_parameter.channels[c].max = share * branch.extents[c];
            return compare::assess(model, comparison, compare::default_tolerance, false);
        };
        const auto wrong = off_by(0.07), little = off_by(0.005);
        EXPECT_EQ(wrong.verdict, Grade::fail) << channel.name;
        EXPECT_EQ(little.verdict, Grade::pass) << channel.name;
        EXPECT_FALSE(little.exact) << channel.name;
        std::string name = channel.name;
        std::ranges::replace(name, '_', ' ');
        for (const auto& j : {wrong, little})
            expect_parts(sentence(j), {" of its extent (" + name + ", branch "});
        expect_parts(sentence(wrong), {", 7.0\u00a0% of its extent ("});
        ++spoiled;
    }
    EXPECT_GT(spoiled, 20);
}

// Forces are judged by a tolerance in newtons or by a share of their extents, as given.
TEST(Assessment, ForcesAreJudgedByNewtonsOrShareAsGiven) {
    using compare::parse_tolerance, compare::ToleranceParts;
    const auto verdict = [&](const char* text) {
        return compare::assess(mcpherson(), compared(),
                               parse_tolerance(text, ToleranceParts::with_forces))
            .verdict;
    };
    EXPECT_EQ(verdict("100mm,10deg"), Grade::fail);  // by 1 %
    EXPECT_EQ(verdict("100mm,10deg,1000%"), Grade::pass);
    EXPECT_EQ(verdict("100mm,10deg,1000%,1N"), Grade::fail);
    EXPECT_EQ(verdict("100mm,10deg,1000%,1e5N,1e5Nm"), Grade::pass);
}

// Extents: components of a wrench have that of the largest one; a nearly constant output has a
// tenth of its value; a force that is small beside the acting forces has a thousandth of these.
TEST(OutputExtents, FollowFromTheWrenchTheValueOrTheActingForces) {
    const Model& model = mcpherson();
    const auto all = compare::channels(model);
    compare::Curve curve{.unit = compare::Unit::newton, .a = {0, 1}, .start = 0, .values = {}};
    curve.values.assign(2, std::vector<double>(all.size(), 0));
    std::size_t x = 0;
    while (!all[x].name.ends_with(".force_x")) ++x;
    curve.values[1][x] = 500;                              // one component
    curve.values[0][x + 6] = curve.values[1][x + 6] = 50;  // of the next joint, still
    const auto extents =
        compare::extents_of(all, curve, {.force = 1000, .length = 2, .round_off = 0});
    for (const std::size_t c : {x, x + 1, x + 2}) EXPECT_EQ(extents[c], 500) << all[c].name;
    for (const std::size_t c : {x + 3, x + 4, x + 5}) EXPECT_EQ(extents[c], 2) << all[c].name;
    for (const std::size_t c : {x + 6, x + 7, x + 8}) EXPECT_EQ(extents[c], 5) << all[c].name;
    for (const std::size_t c : {x + 12, x + 13, x + 14}) EXPECT_EQ(extents[c], 1) << all[c].name;
}

// A jack prescribes the travel: every position is correct whatever the force, so a wrong wheel rate
// must fail the verdict by itself.
TEST(Assessment, WrongWheelRateFailsUnderPrescribedTravel) {
    const Model model = compile(support::scene("chrono_mcpherson_travel"));
    compare::Options options;
    options.recursion.steps = 40;
    const auto comparison = compare::compare(model, options);
    auto j = compare::assess(model, comparison, compare::default_tolerance);
    ASSERT_TRUE(j.wheel_rate && j.position && j.angle);
    const double off = compare::as_position(*j.wheel_rate);
    for (const auto& rate : compare::rate_errors(model, comparison))
        EXPECT_NEAR(compare::as_position(rate), std::abs(rate.off) * std::abs(rate.over), 1e-12);
    ASSERT_GT(off, 0.1) << "[mm] under equal load";
    EXPECT_EQ(
        compare::assess(model, comparison, {1.01 * std::max({off, j.position->max, 10.0}), 10})
            .verdict,
        Grade::pass);
    compare::Comparison positions_right = comparison;
    for (auto& branch : positions_right.branches)
        for (auto* reading : {&branch.deviation.equal_parameter, &branch.deviation.equal_abscissa})
            for (auto& d : reading->channels) d.max = 0;
    EXPECT_EQ(compare::assess(model, positions_right, {off / 2, 10}).verdict, Grade::fail);
}

TEST(Assessment, NaNFailsAndAnInconclusiveComparisonIsNotJudged) {
    compare::Comparison broken = compared();
    broken.branches[0].deviation.equal_parameter.channels[0].max = std::nan("");
    EXPECT_EQ(compare::assess(mcpherson(), broken, {1e9, 1e9}).verdict, Grade::fail);
    broken = compared();
    broken.branches[1].inconclusive.add("the references disagree");
    const auto j = compare::assess(mcpherson(), broken, {1e9, 1e9});
    EXPECT_EQ(j.verdict, Grade::not_judged);
    EXPECT_TRUE(sentence(j).starts_with("Not judged: rebound: the references disagree."))
        << sentence(j);
    const auto nothing = compare::assess(mcpherson(), {}, {1, 1});
    EXPECT_EQ(nothing.verdict, Grade::not_judged);
    EXPECT_TRUE(sentence(nothing).starts_with("Not judged: nothing was compared."))
        << sentence(nothing);
}

TEST(Assessment, SentenceSaysWhetherEqualLoadOrEqualTravelExceedsTheTolerance) {
    Assessment j;
    j.verdict = Grade::fail;
    j.tolerance = {2, 1};
    j.position = compare::Worst{"roll", "left.wheel_centre_z", compare::Unit::mm, 1.3, 1.3, 50};
    j.position_at_abscissa =
        compare::Worst{"roll", "right.wheel_centre_z", compare::Unit::mm, 4.8, 4.8, 50};
    expect_parts(sentence(j),
                 {"by up to 4.8\u00a0mm (right.wheel centre z, branch roll, at equal position)"});
    j.position_at_abscissa->max = 1.2;
    expect_parts(sentence(j), {"1.3\u00a0mm (left.wheel centre z, branch roll)"});
    // A small excess, or a value near zero, is shown with enough digits.
    j.tolerance.mm = 1.2999;
    expect_parts(sentence(j), {"by up to 1.3 mm"});
    j.position->max = 1.30004, j.tolerance.mm = 1.3;
    expect_parts(sentence(j), {"by up to 1.30004 mm"});
    j.position->max = 3e-13, j.position_at_abscissa->max = 1e-13, j.tolerance.mm = 1e-300;
    expect_parts(sentence(j), {"by up to 3.0e-13 mm"});
}

TEST(Assessment, SentenceHasOutputErrorPlaceAndTolerance) {
    const auto j = compare::assess(mcpherson(), compared(), compare::default_tolerance, false);
    const std::string text = sentence(j);
    expect_parts(text,
                 {"Fail: the linear recursion as published is off", "wheel centre", ", branch ",
                  "\u00a0deg (", "its wheel rate is up to ",
                  "The tolerance is 0.01\u00a0mm, 0.001\u00a0deg and 1\u00a0% of the extent of "
                  "forces, moments and rates (the default)."});
    const std::string given = sentence(compare::assess(mcpherson(), compared(), {100, 100}));
    EXPECT_TRUE(given.starts_with("Pass: ")) << given;
    expect_parts(given, {"within 100\u00a0mm and 100\u00a0deg of the full solution"}, {"default"});
}

}  // namespace
}  // namespace elastocheck::reports
