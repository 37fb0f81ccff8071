// The gate's judgement on hand-made numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "compare/comparison/changes.hpp"
#include "compare/gate/gate.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"

namespace elastocheck::compare {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// Two branches; tolerances that are exact in binary.
Measurement measurement() {
    Measurement m;
    m.scene = "s";
    for (const char* branch : {"in", "out"}) {
        m.branches.push_back({branch, "N", {0, 10, 20}});
        m.series.push_back({branch, Quantity::recursive, "toe", "deg", {0, 1, 4}});
        m.series.push_back({branch, Quantity::equilibrium, "toe", "deg", {0, 1, 2}});
        m.series.push_back({branch, Quantity::deviation_at_equal_abscissa, "toe", "deg", {0.5}});
        m.series.push_back({branch, Quantity::recursive, "travel", "mm", {0, 16, 32}});
        m.series.push_back({branch, Quantity::work_recursive, "steps", "count", {100}});
    }
    return m;
}

Baseline baseline() {
    Baseline b;
    b.accepted = measurement();
    b.reason = "a test";
    for (const auto kind : tolerance_classes)
        b.tolerances[kind] = {{"deg", {0.125, 0}}, {"mm", {0, 0.25}}, {"count", {0, 0.125}}};
    return b;
}

GateVerdict judged(const Baseline& b, const Measurement& m) {
    return judge(b, m, ToleranceClass::same_build);
}

double& value(Measurement& m, Quantity quantity, const std::string& channel, std::size_t k) {
    for (auto& s : m.series)
        if (s.quantity == quantity && s.channel == channel) return s.values.at(k);
    throw std::logic_error(channel);
}

TEST(Gate, AcceptedMeasurementPassesAndEveryNumberIsCounted) {
    const GateVerdict verdict = judged(baseline(), measurement());
    EXPECT_EQ(verdict.grade(), Grade::pass);
    EXPECT_EQ(verdict.compared, 2 * (3 + 3 + 1 + 3 + 1));
}

// The tolerance is that of the channel, else of its unit, in the class, relative to the range of the accepted curve, for
// a deviation to the range of the reference.
TEST(Gate, DifferenceOfTheTolerancePassesAndOneUlpMoreFails) {
    struct Edge {
        Quantity quantity;
        const char* channel;
        std::size_t k;
        double was, tolerance;
        std::function<void(Tolerances&)> adapt = {};
        ToleranceClass kind = ToleranceClass::same_build;
    };
    const auto with = [](const char* key, Allowance allowance) {
        return [=](Tolerances& tolerances) { tolerances[key] = allowance; };
    };
    constexpr auto deviation = Quantity::deviation_at_equal_abscissa;
    for (const auto& [quantity, channel, k, was, tolerance, adapt, kind] :
         {Edge{Quantity::recursive, "toe", 1, 1, 0.125},  // atol
          Edge{Quantity::recursive, "travel", 0, 0, 8},   // rtol × range 32
          Edge{deviation, "toe", 0, 0.5, 0.125},
          Edge{deviation, "toe", 0, 0.5, 0.0625,
               with("deg", {0, 0.03125})},  // × range 2 of the reference
          Edge{Quantity::recursive, "toe", 1, 1, 0.25, with("toe", {0.25, 0})},
          Edge{Quantity::recursive, "toe", 1, 1, 0.375, with("deg", {0.375, 0}),
               ToleranceClass::physical},
          Edge{Quantity::work_recursive, "steps", 0, 100, 12.5}})  // rtol × 100
        for (const double sign : {1.0, -1.0}) {
            Baseline b = baseline();
            if (adapt) adapt(b.tolerances[kind]);
            Measurement m = measurement();
            const double edge = was + sign * tolerance;
            value(m, quantity, channel, k) = edge;
            EXPECT_EQ(judge(b, m, kind).grade(), Grade::pass) << name(quantity) << channel << sign;
            value(m, quantity, channel, k) = std::nextafter(edge, sign * infinity);
            const GateVerdict verdict = judge(b, m, kind);
            EXPECT_EQ(verdict.grade(), Grade::fail) << name(quantity) << channel << sign;
            ASSERT_EQ(verdict.offences.size(), 1u);
            const Offence& offence = verdict.offences[0];
            EXPECT_EQ(offence.branch, "in");
            EXPECT_EQ(offence.channel, channel);
            EXPECT_EQ(offence.was, was);
            EXPECT_EQ(offence.tolerance, tolerance);
            EXPECT_GT(sign * offence.difference(), tolerance);
            EXPECT_EQ(offence.a.has_value(), quantity == Quantity::recursive);
            EXPECT_EQ(offence.a.value_or(0), offence.a ? 10.0 * static_cast<double>(k) : 0);
            EXPECT_EQ(offence.a_unit, offence.a ? "N" : "");
        }
}

TEST(Gate, IncomparableNumbersNeverPass) {
    struct Damage {
        const char* what;
        std::function<void(Baseline&, Measurement&)> inflict;
    };
    const std::vector<Damage> damages{
        {"not a finite number",
         [](auto&, auto& m) { value(m, Quantity::recursive, "toe", 1) = nan; }},
        {"not a finite number",
         [](auto&, auto& m) { value(m, Quantity::recursive, "toe", 1) = infinity; }},
        {"not a finite number in the baseline",
         [](auto& b, auto&) { value(b.accepted, Quantity::recursive, "toe", 1) = nan; }},
        {"not a finite number in the baseline",
         [](auto& b, auto& m) {
             value(b.accepted, Quantity::recursive, "toe", 1) = nan;
             value(m, Quantity::recursive, "toe", 1) = nan;
         }},
        {"was not measured", [](auto&, auto& m) { m.series.erase(m.series.begin()); }},
        {"toe is new", [](auto& b, auto&) { b.accepted.series.erase(b.accepted.series.begin()); }},
        {"3 numbers in the baseline, 2 were measured",
         [](auto&, auto& m) { m.series[0].values.pop_back(); }},
        {"2 numbers in the baseline, 3 were measured",
         [](auto& b, auto&) { b.accepted.series[0].values.pop_back(); }},
        {"no numbers in the baseline",
         [](auto& b, auto& m) { b.accepted.series[0].values.clear(), m.series[0].values.clear(); }},
        {"not as many numbers as its branch has points",
         [](auto& b, auto& m) { b.accepted.branches[0].a.pop_back(), m.branches[0].a.pop_back(); }},
        {"elsewhere than the accepted one", [](auto&, auto& m) { m.branches[0].a.back() = 21; }},
        {"is driven in mm and was in N", [](auto&, auto& m) { m.branches[0].unit = "mm"; }},
        {"elsewhere than the accepted one (2 points, 0 to 10 N instead of 3 points, 0 to 20 N)",
         [](auto&, auto& m) { m.branches[0].a.pop_back(); }},
        {"branch 'out' is in the baseline", [](auto&, auto& m) { m.branches.pop_back(); }},
        {"branch 'out' is new", [](auto& b, auto&) { b.accepted.branches.pop_back(); }},
        {"was in deg and is in mm", [](auto&, auto& m) { m.series[0].unit = "mm"; }},
        {"nothing was compared",
         [](auto& b, auto& m) { b.accepted.series.clear(), m.series.clear(); }},
        {"the references disagree",
         [](auto&, auto& m) { m.inconclusive = {"the references disagree"}; }},
        {"no reason for its acceptance", [](auto& b, auto&) { b.reason = " \n"; }},
        {"of scene 's', this is 't'", [](auto&, auto& m) { m.scene = "t"; }},
        {"no usable tolerance", [](auto& b, auto&) { b.tolerances.clear(); }},
        {"no usable tolerance",
         [](auto& b, auto&) { b.tolerances[ToleranceClass::same_build].erase("mm"); }},
        {"no usable tolerance",
         [](auto& b, auto&) { b.tolerances[ToleranceClass::same_build]["mm"].atol = nan; }},
        {"no usable tolerance",
         [](auto& b, auto&) { b.tolerances[ToleranceClass::same_build]["mm"].rtol = infinity; }},
        {"no usable tolerance",
         [](auto& b, auto&) { b.tolerances[ToleranceClass::same_build]["mm"].atol = -1; }},
        {"nothing of that name was measured",
         [](auto& b, auto&) {
             b.limits.push_back({Quantity::deviation_at_equal_abscissa, "to", 1});
         }},
        {"nothing of that name was measured",
         [](auto& b, auto&) {
             b.limits.push_back({Quantity::deviation_at_equal_parameter, "toe", 1});
         }},
        {"nothing finite to compare",
         [](auto& b, auto&) {
             b.limits.push_back({Quantity::deviation_at_equal_abscissa, "toe", nan});
         }},
        {"nothing finite to compare",
         [](auto& b, auto&) {
             b.limits.push_back({Quantity::deviation_at_equal_abscissa, "toe", infinity});
         }},
    };
    for (const auto& [what, inflict] : damages) {
        Baseline b = baseline();
        Measurement m = measurement();
        inflict(b, m);
        const GateVerdict verdict = judged(b, m);
        EXPECT_EQ(verdict.grade(), Grade::not_judged) << what;
        bool said = false;
        for (const auto& reason : verdict.reasons)
            said = said || reason.find(what) != std::string::npos;
        EXPECT_TRUE(said) << what << ": " << (verdict.reasons.empty() ? "" : verdict.reasons[0]);
    }
}

TEST(Gate, NumbersAtOtherParametersAreNotCompared) {
    Measurement m = measurement();
    m.branches[0].a.back() = 30;
    value(m, Quantity::recursive, "toe", 2) = 9;
    const GateVerdict verdict = judged(baseline(), m);
    EXPECT_EQ(verdict.grade(), Grade::not_judged);
    EXPECT_EQ(verdict.compared, 11);  // the other branch
    EXPECT_EQ(verdict.reasons.size(), 1u);
    EXPECT_TRUE(verdict.offences.empty());
}

TEST(Gate, SeriesOfAnUnlistedBranchIsNotJudged) {
    Baseline b = baseline();
    b.accepted.series[0].branch = "nowhere";
    EXPECT_EQ(judged(b, measurement()).grade(), Grade::not_judged);
    Measurement m = measurement();
    m.series.push_back({"nowhere", Quantity::recursive, "toe", "deg", {0, 1, 4}});
    EXPECT_EQ(judged(baseline(), m).grade(), Grade::not_judged);
}

TEST(Gate, ExceededLimitFailsBesideIncomparableNumbers) {
    Measurement m = measurement();
    value(m, Quantity::recursive, "toe", 1) = 7;
    value(m, Quantity::recursive, "travel", 1) = nan;
    const GateVerdict verdict = judged(baseline(), m);
    EXPECT_EQ(verdict.grade(), Grade::fail);
    EXPECT_EQ(verdict.reasons.size(), 1u);
    m = measurement();
    std::swap(m.series[0].values, m.series[1].values);
    EXPECT_EQ(judged(baseline(), m).grade(), Grade::fail) << "exchanged channels";
}

TEST(Gate, AbsoluteLimitFailsOnUnchangedNumbers) {
    Baseline b = baseline();
    b.limits.push_back({Quantity::deviation_at_equal_abscissa, "toe", 0.5});
    GateVerdict verdict = judged(b, measurement());
    EXPECT_EQ(verdict.grade(), Grade::pass);
    EXPECT_EQ(verdict.compared, 2 * 11 + 2);
    b.limits[0].max = std::nextafter(0.5, 0);
    verdict = judged(b, measurement());
    EXPECT_EQ(verdict.grade(), Grade::fail);
    ASSERT_EQ(verdict.offences.size(), 2u);  // in both branches
    EXPECT_TRUE(verdict.offences[0].of_limit);
    EXPECT_EQ(verdict.offences[0].is, 0.5);
}

// Channels of the offences, in their order.
std::vector<std::string> order(const GateVerdict& verdict) {
    std::vector<std::string> channels;
    for (const auto& o : verdict.offences) channels.push_back(o.channel);
    return channels;
}

TEST(Gate, OffencesAreOrderedByTheirNoticeableChange) {
    Baseline b = baseline();
    for (const char* channel : {"bush.force_z", "coil.force_z"})
        for (const char* branch : {"in", "out"})
            b.accepted.series.push_back(
                {branch, Quantity::equilibrium, channel, "N", {0, 100, 200}});
    b.tolerances[ToleranceClass::same_build] = {
        {"deg", {1e-9, 0}}, {"mm", {1e-9, 0}}, {"N", {1e-9, 0}}, {"count", {0, 0}}};
    b.tolerances[ToleranceClass::physical] = {
        {"deg", {0.001, 0}}, {"mm", {0.01, 0}}, {"N", {1, 0}}, {"count", {2, 0}}};
    Measurement m = b.accepted;
    value(m, Quantity::equilibrium, "toe", 1) += 0.002;          // 2 times what is noticed
    value(m, Quantity::recursive, "travel", 1) += 0.005;         // with of it
    value(m, Quantity::equilibrium, "bush.force_z", 1) += 0.9;   // 9e8 tolerances, and not noticed
    value(m, Quantity::equilibrium, "coil.force_z", 1) += 1000;  // noticed, within the suspension
    value(m, Quantity::work_recursive, "steps", 0) += 1;  // nothing is tolerated, and not noticed
    const GateVerdict verdict = judged(b, m);
    EXPECT_EQ(order(verdict),
              (std::vector<std::string>{"toe", "coil.force_z", "travel", "bush.force_z", "steps"}));
    EXPECT_GT(verdict.offences[3].share(), 1e8);
    EXPECT_NEAR(verdict.offences[3].noticed(), 0.9, 1e-9);
    b.limits.push_back({Quantity::deviation_at_equal_abscissa, "toe", 0.499});
    const GateVerdict limited = judged(b, m);  // broken in both branches
    EXPECT_TRUE(limited.offences[0].of_limit && limited.offences[1].of_limit);
    EXPECT_EQ(limited.offences[2].channel, "toe");
}

// One branch from -10 to 10 with the design position in the middle.
Baseline car() {
    Baseline b;
    auto& m = b.accepted;
    m.scene = "car", b.reason = "a test";
    m.branches = {{"travel", "mm", {-10, -5, 0, 5, 10}}};
    const auto add = [&](Quantity quantity, const char* channel, const char* unit,
                         std::vector<double> values) {
        m.series.push_back({"travel", quantity, channel, unit, std::move(values)});
    };
    for (const char* wheel : {"left.", "right."}) {
        const std::string name = std::string(wheel) + "bump_steer";
        add(Quantity::characteristic_equilibrium, name.c_str(), "deg/m", {1, 2, 3, 4, 5});
        add(Quantity::range_characteristic_equilibrium, name.c_str(), "deg/m", {1, 5.5});
    }
    add(Quantity::equilibrium, "left.toe", "deg", {-2, -1, 0, 1, 2});
    add(Quantity::range_equilibrium, "left.toe", "deg", {-2, 2.5});
    for (const auto kind : tolerance_classes)
        b.tolerances[kind] = {{"deg", {0.001, 0}}, {"characteristic", {0.001, 0}}};
    return b;
}

TEST(Gate, FigureHasTwoSidedLimitsAtDesignOrOverABranch) {
    struct Case {
        Limit limit;
        std::size_t broken;
        int compared;
    };
    const auto figure = [](const char* name, double min, double max, const char* over = "") {
        return Limit{.of = Quantity::equilibrium,
                     .channel = name,
                     .max = max,
                     .min = min,
                     .unit = std::string(name).ends_with("toe") ? "deg" : "deg/m",
                     .over = over};
    };
    Baseline b = car();
    const int all = judged(b, b.accepted).compared;
    EXPECT_EQ(all, 2 * (5 + 2) + 5 + 2);
    for (const auto& [limit, broken, compared] :
         {Case{figure("bump_steer", -3, 3), 0, 2},  // of both wheels, on the limit
          Case{figure("bump_steer", -3, std::nextafter(3, 0)), 2, 2},
          Case{figure("left.bump_steer", -3, 2), 1, 1},
          Case{figure("bump_steer", std::nextafter(3, 9), infinity), 2, 2},
          Case{figure("bump_steer", -6, 5, "travel"), 2, 4},  // 5.5 between the stations
          Case{figure("bump_steer", 0, 5.5, "travel"), 0, 4},
          Case{figure("toe", -2, 2, "travel"), 1, 2}, Case{figure("toe", -2, 2), 0, 1}}) {
        b.limits = {limit};
        const GateVerdict verdict = judged(b, b.accepted);
        EXPECT_EQ(verdict.compared, all + compared) << limit.channel << limit.max;
        EXPECT_EQ(verdict.offences.size(), broken) << limit.channel << limit.max;
        EXPECT_EQ(verdict.grade(), broken > 0 ? Grade::fail : Grade::pass);
        for (const auto& offence : verdict.offences) {
            EXPECT_TRUE(offence.of_limit && offence.share() > 1) << offence.channel;
            EXPECT_EQ(offence.was, offence.is > limit.max ? limit.max : limit.min);
        }
    }
}

TEST(Gate, InvalidOrUnmatchedLimitIsNotJudged) {
    for (const Limit& limit :
         {Limit{Quantity::equilibrium, "bump_steer", nan, 0, "deg/m"},
          Limit{Quantity::equilibrium, "bump_steer", 1, nan, "deg/m"},
          Limit{Quantity::equilibrium, "bump_steer", 1, 2, "deg/m"},
          Limit{Quantity::equilibrium, "bump_steer", infinity, -infinity, "deg/m"},
          Limit{Quantity::equilibrium, "bump_steer", 9, 0, "deg"},
          Limit{Quantity::equilibrium, "steer", 9, 0, "deg/m"},
          Limit{Quantity::equilibrium, "bump_steer", 9, 0, "deg/m", "lateral"}}) {
        Baseline b = car();
        b.limits = {limit};
        EXPECT_EQ(judged(b, b.accepted).grade(), Grade::not_judged)
            << limit.channel << limit.min << limit.max << limit.unit;
    }
    // a branch that does not pass through the design position has no figure there
    Baseline b = car();
    b.accepted.branches[0].a = {1, 2, 3, 4, 5};
    b.limits = {{Quantity::equilibrium, "bump_steer", 9, 0, "deg/m"}};
    EXPECT_EQ(judged(b, b.accepted).grade(), Grade::not_judged);
}

TEST(Gate, FiguresAtTheDesignPositionComeBeforeCurves) {
    const Baseline b = car();
    Measurement m = b.accepted;
    value(m, Quantity::equilibrium, "left.toe", 4) += 1;  // 1000 times what is noticed
    value(m, Quantity::range_characteristic_equilibrium, "right.bump_steer", 1) += 0.5;
    value(m, Quantity::characteristic_equilibrium, "left.bump_steer", 2) += 0.01;  // 10 times
    EXPECT_EQ(order(judged(b, m)),
              (std::vector<std::string>{"left.bump_steer", "left.toe", "right.bump_steer"}));
}

TEST(Gate, StationsAreFiveEvenlySpacedAndTheDesignPosition) {
    using Places = std::vector<std::size_t>;
    EXPECT_EQ(stations({-5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5}), (Places{0, 3, 5, 7, 10}));
    EXPECT_EQ(stations({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}), (Places{0, 3, 5, 7, 10}));
    EXPECT_EQ(stations({-1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9}), (Places{0, 1, 3, 5, 7, 10}));
    EXPECT_EQ(stations({0}), Places{0});
    EXPECT_EQ(stations({}), Places{});
}

// A swing arm that changes from -110 m to -476 m has hardly moved.
TEST(Gate, SwingArmIsStoredAsItsReciprocalAndAnInfiniteOneAsZero) {
    const Model model = compile(read_scene(ELASTOCHECK_SCENES "/trailing_arm.yaml"));
    Comparison comparison = compare(model);
    const auto channel = [&](const char* name) {
        return static_cast<std::size_t>(find_channel(comparison.channels, name));
    };
    auto& branch = comparison.branches[0];
    for (auto& run : branch.runs)  // as for a wheel guided by parallel links
        for (auto& point : run.curve.values) point[channel("front_view_swing_arm")] = undefined;
    branch.determined[channel("front_view_swing_arm")] = false;
    const auto& curve = branch.run(Leg::equilibrium).curve;
    const Measurement m = measure(model, comparison);
    int arms = 0;
    for (const auto& s : m.series) {
        if (s.branch != branch.branch) continue;
        const bool side = s.channel == "side_view_swing_arm";
        if (!side && s.channel != "front_view_swing_arm") continue;
        ++arms;
        EXPECT_EQ(s.unit, per_metre);
        if (!side) {
            EXPECT_EQ(s.values, std::vector<double>(s.values.size(), 0.0));
        } else if (s.quantity == Quantity::characteristic_equilibrium) {
            const double arm = curve.values.front()[channel("side_view_swing_arm")];  // [mm]
            EXPECT_NEAR(s.values.front() * arm, 1e3, 1e-3);
        }
    }
    EXPECT_EQ(arms, 2 * 3);  // of each leg, and the range
}

TEST(Gate, MissingPhysicalToleranceHasItsDefault) {
    Baseline b = baseline();
    b.tolerances[ToleranceClass::physical].erase("deg");
    b.tolerances[ToleranceClass::physical]["mm"] = {nan, 0};
    Measurement m = measurement();
    value(m, Quantity::equilibrium, "toe", 1) = 1.5;
    value(m, Quantity::recursive, "travel", 1) = 0;
    const GateVerdict verdict = judged(b, m);
    ASSERT_EQ(verdict.offences.size(), 2u);
    EXPECT_DOUBLE_EQ(verdict.offences[0].noticeable, 0.01 + 1e-3 * 32)
        << verdict.offences[0].channel;
    EXPECT_DOUBLE_EQ(verdict.offences[1].noticeable, 0.001 + 1e-3 * 2)
        << verdict.offences[1].channel;
}

TEST(Changes, ChangedAddedAndRemovedNumbersAreListed) {
    const std::vector<Number> was{
        {"points.a.z", -0.06, "m"}, {"springs.coil.rate", 28, "N/mm"}, {"left", 3, ""}},
        is{{"new", 7, "N"}, {"points.a.z", -0.055, "m"}, {"springs.coil.rate", 28, "N/mm"}};
    EXPECT_TRUE(changes(is, is).empty());
    const auto found = changes(was, is);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_TRUE(!found[0].was && found[0].is->path == "new");
    EXPECT_TRUE(found[1].was->value == -0.06 && found[1].is->value == -0.055);
    EXPECT_TRUE(found[2].was->path == "left" && !found[2].is);
    EXPECT_EQ(changes({{{"x", 1, "mm"}}}, {{{"x", 1, "m"}}}).size(), 1u) << "another unit";
    EXPECT_EQ(changes({{{"x", nan, "m"}}}, {{{"x", nan, "m"}}}).size(), 0u);
    EXPECT_EQ(changes({{{"x", nan, "m"}}}, {{{"x", 1, "m"}}}).size(), 1u);
}

}  // namespace
}  // namespace elastocheck::compare
