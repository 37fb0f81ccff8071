// Three legs side by side: the numbers that must be reached, and when a comparison is not one.
#include "compare/compare.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "models/compile.hpp"
#include "recursive/solve.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

const Comparison& mcpherson() {
    static const Comparison comparison = compare(compile(support::scene("mcpherson")));
    return comparison;
}

TEST(Compare, ReferencesAgreeOnTheMcPhersonAtEveryPointOfTheSweep) {
    for (const auto& branch : mcpherson().branches) {
        ASSERT_EQ(branch.runs[1].curve.load.size(), 301u);
        for (std::size_t c = 0; c < mcpherson().channels.size(); ++c) {
            const auto& channel = mcpherson().channels[c];
            const auto& d = branch.uncertainty.equal_parameter.channels[c];
            EXPECT_EQ(d.compared, 301);
            const double bound = channel.main ? 1e-6 : 1e-5;
            EXPECT_TRUE(std::isfinite(d.max) && d.max <= bound)
                << branch.branch << " " << channel.name << " " << d.max;
        }
    }
}

TEST(Compare, EachReferenceHoldsInTheEquationsOfTheOther) {
    for (const auto& branch : mcpherson().branches) {
        for (const auto& [run, by] : {std::pair{1, Leg::energy}, std::pair{2, Leg::equilibrium},
                                      std::pair{1, Leg::recursive}, std::pair{2, Leg::recursive}}) {
            const auto& r = branch.runs[static_cast<std::size_t>(run)].judged[static_cast<std::size_t>(by)];
            EXPECT_TRUE(r.force <= 1e-6 && r.moment <= 1e-6) << r.force << " " << r.moment;
            EXPECT_TRUE(1e3 * r.length <= 1e-9 && r.direction <= 1e-12) << r.length << " " << r.direction;
        }
    }
}

TEST(Compare, RecursionMeetsTheReferenceForSmallLoads) {
    // At 1 N nothing has turned yet, and where nothing is preloaded
    // eq. (24) is the tangent of the true equations.
    for (const auto& name : support::scene_names()) {
        if (name == "mcpherson_preload") continue;
        Scene scene = support::scene(name);
        // The tangent is off by the order of the rotation: 1 N turns the pendulum by 7e-4 rad and is 0.5 % of
        // what the shallow arch can bear, so for these two it is not small.
        const double load = name == "two_spring_arch" || name == "pendulum" ? 0.01 : 1;
        for (auto& branch : scene.branches) branch.to = std::copysign(load, branch.to), branch.steps = 1;
        const Model model = compile(scene);
        for (const auto& branch : model.branches) {
            const LegRun fast = run(model, branch, Leg::recursive),
                         truth = run(model, branch, Leg::equilibrium);
            double moved = 0, apart = 0;
            for (std::size_t c = 0; c < 3; ++c) {  // wheel centre or first probe
                moved += std::pow(truth.curve.values[1][c] - truth.curve.values[0][c], 2);
                apart += std::pow(truth.curve.values[1][c] - fast.curve.values[1][c], 2);
            }
            EXPECT_LE(std::sqrt(apart / moved), 1e-4) << name << " " << branch.name;
        }
    }
}

TEST(Compare, PreloadMakesTheRecursionWrongEvenForTheSmallestLoad) {
    // What is stored at the design position has a stiffness, which eq. (24) leaves out: the wheel rate is off
    // from the start.
    Scene scene = support::scene("mcpherson_preload");
    for (auto& branch : scene.branches) branch.to = std::copysign(1, branch.to), branch.steps = 1;
    const Model model = compile(scene);
    for (const auto& branch : model.branches) {
        const LegRun fast = run(model, branch, Leg::recursive), truth = run(model, branch, Leg::equilibrium);
        EXPECT_NEAR(fast.curve.travel[1] / truth.curve.travel[1], 1.103, 0.002) << branch.name;
        const auto consistent =
            recursive::solve(model, branch, {.method = *recursive::find_method("tangent"), .steps = 1});
        EXPECT_NEAR(curve(model, branch, consistent.points).travel[1] / truth.curve.travel[1], 1, 1e-4)
            << branch.name;
    }
}

TEST(Compare, RecursionIsOffAlongThePathMuchMoreThanAcrossIt) {
    // What is known of the published method: percents at equal load, a small part of it at equal travel.
    for (const auto& branch : mcpherson().branches) {
        const auto& load = branch.deviation.equal_parameter.channels;
        const auto& travel = branch.deviation.equal_abscissa.channels;
        for (const std::size_t c : {0u, 1u, 3u, 4u})
            EXPECT_LT(travel[c].max, load[c].max / 10) << mcpherson().channels[c].name;
        EXPECT_GT(load[2].max / load[2].range, 0.01);
    }
}

TEST(Compare, DeviationFromOneReferenceIsTheDeviationFromTheOther) {
    for (const auto& branch : mcpherson().branches)
        for (std::size_t c = 0; c < mcpherson().channels.size(); ++c)
            EXPECT_NEAR(branch.deviation.equal_parameter.channels[c].max,
                        branch.cross_check.equal_parameter.channels[c].max, 1e-5);
}

TEST(Compare, ShippedScenesAreConclusiveAndEveryLegConverges) {
    for (const auto& name : support::scene_names()) {
        const auto comparison = compare(compile(support::scene(name)));
        EXPECT_TRUE(comparison.conclusive()) << name;
        EXPECT_GT(comparison.compared, 100) << name;
        for (const auto& branch : comparison.branches)
            for (const auto& reason : branch.inconclusive) ADD_FAILURE() << name << ": " << reason;
    }
}

// ---- When it is not a comparison

TEST(Compare, ALegThatDoesNotConvergeMakesItInconclusive) {
    Scene scene = support::scene("two_spring_arch");
    scene.branches[0].to = -300;  // the limit is at -211.5 N
    const auto comparison = compare(compile(scene));
    EXPECT_FALSE(comparison.conclusive());
    ASSERT_FALSE(comparison.branches[0].inconclusive.empty());
    EXPECT_NE(comparison.branches[0].inconclusive[0].find("equilibrium leg: branch lost"), std::string::npos)
        << comparison.branches[0].inconclusive[0];
    EXPECT_TRUE(comparison.branches[1].inconclusive.empty());
}

TEST(Compare, ReferencesThatDisagreeMakeItInconclusive) {
    Options options;
    options.agreement.length = 0;  // no two solvers agree to the last bit
    const auto comparison = compare(compile(support::scene("pinned_bar")), options);
    ASSERT_FALSE(comparison.conclusive());
    EXPECT_NE(comparison.branches[0].inconclusive.at(0).find("disagree on tip_x"), std::string::npos);
    options = {};
    options.agreement.residual_force = 0;
    EXPECT_FALSE(compare(compile(support::scene("pinned_bar")), options).conclusive());
    options = {};
    options.agreement.length = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(compare(compile(support::scene("pinned_bar")), options).conclusive());
}

TEST(Compare, AReferenceIsJudgedByTheEquationsOfTheOtherNeverByItsOwn) {
    Options options;
    options.agreement.residual_force = 0;  // nobody holds to the last bit
    const auto branch = compare(compile(support::scene("pinned_bar")), options).branches.front();
    ASSERT_EQ(branch.inconclusive.size(), 2u);
    for (const auto& [run, other, reason] :
         {std::tuple{Leg::equilibrium, Leg::energy, branch.inconclusive[0]},
          std::tuple{Leg::energy, Leg::equilibrium, branch.inconclusive[1]}}) {
        const auto& r = branch.runs[static_cast<std::size_t>(run)].judged[static_cast<std::size_t>(other)];
        EXPECT_EQ(
            reason,
            fmt::format("the {} leg's states leave {:.3g} N, {:.3g} N·m, {:.3g} mm in the {} leg's equations",
                        name(run), r.force, r.moment, 1e3 * r.length, name(other)));
    }
}

TEST(Compare, DeviationIsTheRecursionMinusTheReference) {
    for (const auto& branch : mcpherson().branches) {
        EXPECT_EQ(branch.deviation.a, Leg::equilibrium);
        EXPECT_EQ(branch.deviation.b, Leg::recursive);
        for (std::size_t c = 0; c < mcpherson().channels.size(); ++c)
            EXPECT_EQ(branch.deviation.equal_parameter.channels[c].end,
                      branch.runs[0].curve.values.back()[c] - branch.runs[1].curve.values.back()[c])
                << mcpherson().channels[c].name;
    }
}

TEST(Compare, NothingComparedIsNotConclusive) {
    EXPECT_FALSE(Comparison{}.conclusive());
    Model model = compile(support::scene("pinned_bar"));
    model.branches.clear();
    EXPECT_FALSE(compare(model).conclusive());
}

TEST(Compare, ReactionsOfRedundantJointsAreNotCompared) {
    Scene scene = support::scene("pinned_bar");
    scene.joints.push_back(scene.joints.front());
    scene.joints.back().name = "again";
    const auto comparison = compare(compile(scene));
    for (std::size_t c = 0; c < comparison.channels.size(); ++c)
        EXPECT_EQ(comparison.unique[c], comparison.channels[c].main);
    for (const auto& branch : comparison.branches)
        for (const auto& reason : branch.inconclusive) ADD_FAILURE() << reason;
}

TEST(Compare, ProgressIsToldBeforeEachLeg) {
    std::vector<std::string> said;
    Options options;
    options.progress = [&](std::string_view what) { said.emplace_back(what); };
    (void)compare(compile(support::scene("single_bushing")), options);
    EXPECT_EQ(said,
              (std::vector<std::string>{"pull: recursive leg", "pull: equilibrium leg", "pull: energy leg",
                                        "push: recursive leg", "push: equilibrium leg", "push: energy leg"}));
}

}  // namespace
}  // namespace elastocheck::compare
