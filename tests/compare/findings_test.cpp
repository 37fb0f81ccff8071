// Key figures of a comparison, and comparison with measured points.
#include "compare/studies/findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "compare/candidate/judgement.hpp"
#include "compare/candidate/measured.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

const Model& mcpherson() {
    static const Model model = compile(support::scene("chrono_mcpherson"));
    return model;
}
const Comparison& compared() {
    static const Comparison comparison = compare(mcpherson());
    return comparison;
}
std::size_t channel(const std::string& name) {
    return static_cast<std::size_t>(find_channel(compared().channels, name));
}

// An output by a requested definition may be undefined at some point of a branch.
TEST(WorstDisagreement, ConsidersOnlyComparedOutputs) {
    Comparison comparison = compared();
    const auto camber = channel("camber");
    auto& branch = comparison.branches[0];
    branch.determined[camber] = false;
    branch.uncertainty.equal_parameter.channels[camber].max = NAN;
    EXPECT_LT(worst_disagreement(comparison, Unit::deg)->max, 1e-6);
    branch.determined[camber] = true;
    EXPECT_TRUE(std::isnan(worst_disagreement(comparison, Unit::deg)->max));
}

// ---- Wheel rates

TEST(RateErrors, RateErrorIsSignedAndPerBranch) {
    // The published recursion is too soft in jounce, too stiff in rebound.
    const auto errors = rate_errors(mcpherson(), compared());
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_EQ(errors[0].branch, "jounce");
    EXPECT_EQ(errors[0].to, 3000);
    EXPECT_LT(errors[0].off, -0.01);
    EXPECT_EQ(errors[1].branch, "rebound");
    EXPECT_EQ(errors[1].to, -3000);
    EXPECT_GT(errors[1].off, 0.01);
    for (std::size_t b = 0; b < 2; ++b) {
        const auto& runs = compared().branches[b].runs;
        const double fast = runs[0].curve.values.back()[channel("travel")],
                     truth = runs[1].curve.values.back()[channel("travel")];
        EXPECT_NEAR(errors[b].travel, fast - truth, 1e-12);
        EXPECT_NEAR(errors[b].off, truth / fast - 1, 1e-9);  // the design position is at rest
    }
}

TEST(RateErrors, RideRateIsWheelAndTyreRateInSeries) {
    Scene scene = support::scene("chrono_mcpherson");
    for (auto& branch : scene.branches) branch.steps = 10;
    for (const auto& error : rate_errors(compile(scene), compare(compile(scene)))) {
        EXPECT_TRUE(std::isnan(error.ride_rate)) << "no tyre";
        EXPECT_GT(error.wheel_rate, 20) << "[N/mm] of a passenger car";
        EXPECT_LT(error.wheel_rate, 50);
    }
    scene.wheels[0].tyre_rate = 200e3;  // [N/m]
    const auto errors = rate_errors(compile(scene), compare(compile(scene)));
    ASSERT_EQ(errors.size(), 2u);
    for (const auto& error : errors) {
        EXPECT_NEAR(error.ride_rate, error.wheel_rate * 200 / (error.wheel_rate + 200), 1e-9);
        const double fast = error.wheel_rate * (1 + error.off);
        EXPECT_NEAR(error.ride_off, fast * 200 / (fast + 200) / error.ride_rate - 1, 1e-12);
        EXPECT_LT(std::abs(error.ride_off), std::abs(error.off)) << "the tyre is right";
    }
}

// On the road, tyre force over road height is the ride rate, 1 / (1/k_w + 1/k_t).
TEST(RateErrors, RideRateOfAMovingRoadIsWheelAndTyreRateInSeries) {
    const Model model = compile(support::scene("tyre_on_road"));
    const auto errors = rate_errors(model, compare(model));
    ASSERT_EQ(errors.size(), 4u)
        << "both ways on the road and with the wheel; not of a load that the tyre shares";
    for (const auto& error : errors) {
        EXPECT_TRUE(error.branch == "road" || error.branch == "wheel") << error.branch;
        EXPECT_NEAR(error.wheel_rate, 30, 1e-7) << error.branch;
        EXPECT_NEAR(error.ride_rate, 1 / (1 / 30.0 + 1 / 200.0), 1e-7) << error.branch;
        EXPECT_NEAR(error.off, 0, 1e-9) << error.branch << ": it is linear";
        EXPECT_NEAR(error.ride_off, 0, 1e-9) << error.branch;
    }
}

TEST(RateErrors, BranchDrivenByMoreThanAVerticalForceAtTheWheelHasNoRateError) {
    const auto with = [](auto&& change) {
        Scene scene = support::scene("chrono_mcpherson");
        scene.branches.resize(1);
        scene.branches[0].steps = 5;
        change(scene.branches[0], scene);
        const Model model = compile(scene);
        return rate_errors(model, compare(model)).size();
    };
    EXPECT_EQ(with([](Branch&, Scene&) {}), 1u);
    const auto force = [](Branch& branch) -> DeadForce& {
        return std::get<DeadForce>(std::get<Load>(branch.drivers[0].what).kind);
    };
    EXPECT_EQ(with([&](Branch& b, Scene&) { force(b).f = {1, 0, 1}; }), 0u);
    EXPECT_EQ(with([&](Branch& b, Scene&) { force(b).f = {0, 0.1, 0}; }), 0u);
    EXPECT_EQ(with([&](Branch& b, Scene& s) { force(b).at.body = s.wheels[0].body == 0 ? 1 : 0; }),
              0u);
    EXPECT_EQ(with([&](Branch& b, Scene&) {
                  b.drivers.push_back(b.drivers[0]), force(b).f = {0, 1e-3, 0};
              }),
              0u);
    // A driver that is held does not move, so it is not part of the rate.
    EXPECT_EQ(with([&](Branch& b, Scene&) {
                  b.drivers.push_back(b.drivers[0]);
                  b.drivers[1].rate = 0;
                  b.drivers[1].start = 10;
              }),
              1u);
}

// ---- Worst deviation, and its parts

TEST(Findings, TheWorstDeviationIsTheLargestOfAnyBranch) {
    const Assessment found = assess(mcpherson(), compared(), default_tolerance);
    for (const auto& [kind, unit, worst] :
         {std::tuple{ReadingKind::equal_parameter, Unit::mm, found.position},
          {ReadingKind::equal_parameter, Unit::deg, found.angle},
          {ReadingKind::equal_abscissa, Unit::mm, found.position_at_abscissa},
          {ReadingKind::equal_abscissa, Unit::deg, found.angle_at_abscissa}}) {
        ASSERT_TRUE(worst);
        for (const auto& branch : compared().branches)
            for (std::size_t c = 0; c < compared().channels.size(); ++c)
                if (compared().channels[c].main && compared().channels[c].unit == unit) {
                    EXPECT_LE(reading_of(branch.deviation, kind).channels[c].max, worst->max);
                }
    }
    Comparison broken = compared();
    broken.branches[0].deviation.equal_parameter.channels[0].max = std::nan("");
    EXPECT_TRUE(std::isnan(assess(mcpherson(), broken, default_tolerance).position->max));
    EXPECT_LE(worst_disagreement(compared(), Unit::mm)->max, 1e-6);
    EXPECT_FALSE(worst_disagreement({}, Unit::mm));
}

// ---- Measured points

// Points of the equilibrium leg with an error `off`, at a few places of one branch.
Points taken(std::size_t branch, double off, bool by_travel, bool named) {
    Points measured;
    const Curve& truth = compared().branches[branch].runs[1].curve;
    measured.columns.push_back({channel("toe"), false, {}});
    for (const std::size_t k : {30u, 120u, 240u}) {
        (by_travel ? measured.at : measured.a)
            .push_back(by_travel ? truth.values[k][channel("travel")] : truth.a[k]);
        measured.columns[0].values.push_back(truth.values[k][channel("toe")] - off);
        if (named) measured.branch.push_back(compared().branches[branch].branch);
    }
    if (by_travel) measured.abscissa = channel("travel");
    return measured;
}

TEST(MeasuredPoints, AreLocatedOnTheBranchByParameterAndByTravel) {
    for (const std::size_t branch : {0u, 1u})
        for (const bool by_travel : {false, true})
            for (const bool named : {false, true}) {
                const auto found = compare_measured(mcpherson(), compared(),
                                                    taken(branch, 0.25, by_travel, named));
                ASSERT_EQ(found.readings.size(), 1u);
                EXPECT_EQ(found.readings[0].by_parameter, !by_travel);
                const MeasuredRow& row = found.readings[0].rows[0];
                EXPECT_EQ(row.compared(), 3);
                EXPECT_NEAR(row.off[1].signed_max, 0.25, 1e-6);
                EXPECT_NEAR(row.off[1].rms, 0.25, 1e-6);
                EXPECT_EQ(row.branch, compared().branches[branch].branch);
                EXPECT_EQ(found.used, std::vector<bool>(3, true));
            }
}

TEST(MeasuredPoints, LargestDeviationKeepsItsSign) {
    Points measured = taken(0, 0.25, false, true);
    measured.columns[0].values[0] += 1;
    const auto found = compare_measured(mcpherson(), compared(), measured);
    EXPECT_NEAR(found.readings[0].rows[0].off[1].signed_max, -0.75, 1e-6);
}

TEST(MeasuredPoints, AreComparedOnlyWithTheBranchTheyName) {
    Points measured = taken(0, 0, true, true);
    for (auto& name : measured.branch) name = "rebound";  // out of range of the points
    const auto found = compare_measured(mcpherson(), compared(), measured);
    EXPECT_EQ(found.compared, 0);
    EXPECT_TRUE(found.readings[0].rows.empty());
    EXPECT_EQ(found.used, std::vector<bool>(3, false));
    measured.branch[0] = "bump";
    EXPECT_THROW((void)compare_measured(mcpherson(), compared(), measured), std::invalid_argument);
}

TEST(MeasuredPoints, PointsWithoutABranchAreRefusedIfTwoBranchesHaveTheirSide) {
    Scene scene = support::scene("chrono_mcpherson");
    scene.branches[1].to = 1000;
    for (auto& branch : scene.branches) branch.steps = 5;
    const Model model = compile(scene);
    const auto both = compare(model);
    EXPECT_THROW((void)compare_measured(model, both, taken(0, 0, true, false)),
                 std::invalid_argument);
    EXPECT_EQ(compare_measured(model, both, taken(0, 0, true, true)).places[0].branch, 0);
}

TEST(MeasuredPoints, ChangesAreRelativeToTheDesignPositionAndNotToTheSettledStart) {
    // Also with a settled start: its 12 mm of travel are not the zero of a measurement.
    Scene scene = support::scene("chrono_mcpherson");
    scene.branches.resize(1);
    scene.branches[0].steps = 30;
    scene.branches[0].drivers[0].start = 300;
    const Model model = compile(scene);
    const auto comparison = compare(model);
    const auto c = static_cast<std::size_t>(find_channel(comparison.channels, "wheel_centre_y"));
    const auto& truth = comparison.branches[0].runs[1].curve;
    const double drawn = evaluate(model, comparison.channels, design_state(model))[c];
    Points measured;
    measured.a = {truth.a[10]};
    measured.columns.push_back({c, true, {truth.values[10][c] - drawn}});
    const auto found = compare_measured(model, comparison, measured);
    EXPECT_EQ(found.compared, 1);
    EXPECT_NEAR(found.readings[0].rows[0].off[1].signed_max, 0, 1e-9);
    EXPECT_GT(
        truth.values[0][static_cast<std::size_t>(find_channel(comparison.channels, "travel"))], 1);
}

}  // namespace
}  // namespace elastocheck::compare
