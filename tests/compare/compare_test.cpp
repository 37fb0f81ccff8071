// Comparison of the three legs: required accuracy, and the conditions of an inconclusive result.
#include "compare/comparison/compare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compare/candidate/judgement.hpp"
#include "compare/gate/gate.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "models/overloaded.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

const Comparison& mcpherson() {
    static const Comparison comparison = compare(compile(support::scene("chrono_mcpherson")));
    return comparison;
}

// Channels without a value somewhere on the branch, such as an infinite swing arm, are
// not compared there.
bool is_undefined(const Comparison& all, const BranchComparison& branch, std::size_t c) {
    return all.channels[c].may_be_undefined() && !branch.determined[c];
}

// Allowed error of a rate of the equilibrium leg; 0 for other channels.
double share_of_rate(const Comparison& all, const BranchComparison& branch, std::size_t c) {
    if (all.channels[c].kind() != ChannelKind::characteristic) return 0;
    double largest = 1e-3;
    for (const double value : branch.runs[1].curve.channel(c))
        largest = std::max(largest, std::abs(value));
    return 1e-6 * largest;
}

TEST(Compare, StatesOfEachReferenceSatisfyTheEquationsOfTheOther) {
    for (const auto& branch : mcpherson().branches) {
        for (const auto& [run, by] : {std::pair{1, Leg::energy}, std::pair{2, Leg::equilibrium},
                                      std::pair{1, Leg::recursive}, std::pair{2, Leg::recursive}}) {
            const auto& r =
                branch.runs[static_cast<std::size_t>(run)].judged[static_cast<std::size_t>(by)];
            EXPECT_TRUE(r.force <= 1e-6 && r.moment <= 1e-6) << r.force << " " << r.moment;
            EXPECT_TRUE(1e3 * r.length <= 1e-9 && r.direction <= 1e-12)
                << r.length << " " << r.direction;
        }
    }
}

TEST(Compare, RecursionEqualsTheReferenceForSmallLoads) {
    // At 1 N rotations are negligible, and without preload eq. (24) is the tangent of
    // the true equations.
    for (const auto& name : support::small_scene_names()) {
        if (name == "chrono_mcpherson_preload") continue;
        Scene scene = support::scene(name);
        // The tangent's error is of the order of the rotation: 1 N turns the pendulum by 7e-4 rad
        // and is 0.5 % of the shallow arch's limit load, so for these two it is not small.
        const double load = name == "two_spring_arch" || name == "pendulum" ? 0.01 : 1;
        for (auto& branch : scene.branches) {
            const bool force = branch.unit == ParameterUnit::newton;
            branch.from = 0;
            branch.to = std::copysign(force ? load : 1e-5, branch.to);  // [N], or [m] and [rad]
            branch.steps = 1;
        }
        // Loads held from the start add a stiffness that eq. (24) leaves out, like a preload.
        std::erase_if(scene.branches, [](const Branch& branch) {
            return std::ranges::any_of(branch.drivers,
                                       [](const Driver& d) { return d.start != 0; });
        });
        const Model model = compile(scene);
        for (const auto& branch : model.branches) {
            const LegRun fast = run(model, branch, Leg::recursive),
                         truth = run(model, branch, Leg::equilibrium);
            ASSERT_EQ(fast.outcome, Outcome::converged) << name << " " << fast.detail;
            ASSERT_EQ(truth.outcome, Outcome::converged) << name << " " << truth.detail;
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
    // Preload adds a geometric stiffness that eq. (24) leaves out: the wheel rate is wrong
    // from the start.
    Scene scene = support::scene("chrono_mcpherson_preload");
    for (auto& branch : scene.branches) {
        branch.to = std::copysign(1, branch.to);
        branch.steps = 1;
    }
    const Model model = compile(scene);
    for (const auto& branch : model.branches) {
        const LegRun fast = run(model, branch, Leg::recursive),
                     truth = run(model, branch, Leg::equilibrium);
        const auto consistent = run(model, branch, Leg::recursive,
                                    {.method = *recursive::find_method("tangent"), .steps = 1});
        const auto travelled = [&](const LegRun& leg) {
            const auto travel = leg.curve.channel(
                static_cast<std::size_t>(find_channel(channels(model), "travel")));
            return travel[1] - travel[0];
        };
        EXPECT_NEAR(travelled(fast) / travelled(truth), 1.103, 0.002) << branch.name;
        EXPECT_NEAR(travelled(consistent) / travelled(truth), 1, 1e-4) << branch.name;
    }
}

TEST(Compare, RecursionErrorIsLargerAlongThePathThanAcrossIt) {
    // Known errors of the published method: per cents at equal load, a small part of that
    // at equal travel.
    for (const auto& branch : mcpherson().branches) {
        const auto& load = branch.deviation.equal_parameter.channels;
        const auto& travel = branch.deviation.equal_abscissa.channels;
        for (const std::size_t c : {0u, 1u, 3u, 4u})
            EXPECT_LT(travel[c].max, load[c].max / 10) << mcpherson().channels[c].name;
        EXPECT_GT(load[2].max / load[2].range, 0.01);
    }
}

// ---- Inconclusive comparisons

TEST(Compare, ReferencesThatDisagreeMakeTheComparisonInconclusive) {
    Options options;
    options.agreement.length = 0;  // no two solvers agree to the last bit
    const auto comparison = compare(compile(support::scene("pinned_bar")), options);
    ASSERT_FALSE(comparison.conclusive());
    EXPECT_NE(comparison.branches[0].inconclusive.texts().at(0).find("disagree on tip_"),
              std::string::npos);
    options = {};
    options.agreement.residual_length = 0;  // nor do they close many joints to the last bit
    options.recursion.steps = 10;
    EXPECT_FALSE(compare(compile(support::scene("chrono_mcpherson")), options).conclusive());
    options = {};
    options.agreement.length = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(compare(compile(support::scene("pinned_bar")), options).conclusive());
}

TEST(Compare, ReferenceIsJudgedOnlyByTheEquationsOfTheOther) {
    Options options;
    options.agreement.residual_force = -1;  // no residual is below zero
    const auto branch = compare(compile(support::scene("pinned_bar")), options).branches.front();
    const auto reasons = branch.inconclusive.texts();
    ASSERT_EQ(reasons.size(), 2u);
    for (const auto& [run, other] :
         {std::pair{Leg::equilibrium, Leg::energy}, std::pair{Leg::energy, Leg::equilibrium}}) {
        const auto& r =
            branch.runs[static_cast<std::size_t>(run)].judged[static_cast<std::size_t>(other)];
        const auto said = fmt::format(
            "the {} leg's states have residuals of {:.3g} N, {:.3g} N·m, {:.3g} mm in the {} leg's "
            "equations",
            name(run), r.force, r.moment, 1e3 * r.length, name(other));
        EXPECT_TRUE(reasons[0].starts_with(said) || reasons[1].starts_with(said)) << said;
    }
}

TEST(Compare, DeviationIsTheRecursionMinusTheReference) {
    for (const auto& branch : mcpherson().branches) {
        EXPECT_EQ(branch.deviation.a, Leg::equilibrium);
        EXPECT_EQ(branch.deviation.b, Leg::recursive);
        for (std::size_t c = 0; c < mcpherson().channels.size(); ++c)
            if (!is_undefined(mcpherson(), branch, c)) {
                EXPECT_EQ(
                    branch.deviation.equal_parameter.channels[c].end,
                    branch.runs[0].curve.values.back()[c] - branch.runs[1].curve.values.back()[c])
                    << mcpherson().channels[c].name;
            }
    }
}

TEST(Compare, ComparisonWithoutBranchesIsNotConclusive) {
    EXPECT_FALSE(Comparison{}.conclusive());
    Model model = compile(support::scene("pinned_bar"));
    model.branches.clear();
    EXPECT_FALSE(compare(model).conclusive());
}

TEST(Compare, ReactionsOfRedundantJointsAreComparedAsTheirTotal) {
    // The bar's hinge duplicated; the joints of a second bar stay determined.
    Scene scene = support::scene("pinned_bar");
    const auto bodies = scene.bodies.size();
    scene.joints.push_back(scene.joints.front());
    scene.joints.back().name = "again";
    Scene other = support::scene("pinned_bar");
    ASSERT_EQ(bodies, 1u);
    scene.bodies.push_back(other.bodies.front());
    scene.bodies.back().name = "beside";
    const auto shift = [](auto& x) {
        if (x.body == 0) x.body = 1;
    };
    for (Joint joint : other.joints) {
        std::visit([&](auto& k) { shift(k.i), shift(k.j); }, joint.kind);
        std::visit(overloaded{[&](Revolute& k) { shift(k.axis_i), shift(k.axis_j); }, [](auto&) {}},
                   joint.kind);
        joint.name += "_beside";
        scene.joints.push_back(joint);
    }
    for (Elastic elastic : other.elastics) {
        std::visit([&](auto& e) { shift(e.i), shift(e.j); }, elastic.kind);
        elastic.name += "_beside";
        scene.elastics.push_back(elastic);
    }
    for (Probe probe : other.probes) {
        shift(probe.at);
        probe.name += "_beside";
        scene.probes.push_back(probe);
    }
    const auto comparison = compare(compile(scene, Detail::everything));
    const std::string pin = other.joints.front().name;
    int totals_seen = 0;
    for (const auto& branch : comparison.branches) {
        for (const auto& reason : branch.inconclusive.texts()) ADD_FAILURE() << reason;
        for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
            const auto& channel = comparison.channels[c];
            // Two hinges on one axis share all but the moment about it.
            const bool shared =
                (channel.name.starts_with(pin + ".") || channel.name.starts_with("again.")) &&
                !channel.name.ends_with(".moment_y");
            EXPECT_EQ(branch.determined[c], !shared) << channel.name;
            const bool total = channel.name.starts_with(pin + "+again.");
            totals_seen += total;
            if (total) {
                EXPECT_GT(branch.uncertainty.equal_parameter.channels[c].compared, 0)
                    << channel.name;
            }
        }
    }
    EXPECT_EQ(totals_seen, 6 * static_cast<int>(comparison.branches.size()));
    // Together they carry the reaction of the single hinge.
    const auto single = compare(compile(other));
    const int all = find_channel(comparison.channels, pin + "+again.force_z"),
              one = find_channel(single.channels, pin + ".force_z");
    const double
        together =
            comparison.branches[0].runs[1].curve.values.back()[static_cast<std::size_t>(all)],
        alone = single.branches[0].runs[1].curve.values.back()[static_cast<std::size_t>(one)];
    EXPECT_NEAR(together, alone, 1e-6 * std::abs(alone) + 1e-6);
}

TEST(Compare, ProgressIsReportedBeforeEachLeg) {
    std::vector<std::string> said;
    Options options;
    double last = 0;
    options.progress = [&](std::string_view what, double done) {
        EXPECT_GE(done, last);
        last = done;
        said.emplace_back(what);
    };
    (void)compare(compile(support::scene("single_bushing")), options);
    EXPECT_EQ(said, (std::vector<std::string>{"pull: energy leg", "push: energy leg",
                                              "pull: equilibrium leg", "push: equilibrium leg",
                                              "pull: recursive leg", "push: recursive leg",
                                              "pull: deviations", "push: deviations"}));
    EXPECT_LT(last, 1);
}

// ---- Exact results are conclusive, wrong ones are not

// An arm on a revolute at the origin, with its end at 0.5 m on a bushing of this stiffness under an
// upward load.
Scene one_arm(double k, double load) {
    Scene scene;
    scene.name = "one arm";
    scene.bodies.push_back({"arm", {}});
    scene.joints.push_back(
        {"pin", Revolute{Point{0}, Point{}, {0, {1, 0, 0}}, {ground, {1, 0, 0}}}});
    Bushing bushing{{0, {0, 0.5, 0}}, {ground, {0, 0.5, 0}}, LinearStiffness{}};
    std::get<LinearStiffness>(bushing.law).K.diagonal() << k, k, k, 0, 0, 0;
    scene.elastics.push_back({"mount", bushing});
    scene.probes.push_back({"tip", {0, {0, 0.5, 0}}});
    scene.branches.push_back(
        {.name = "up",
         .to = load,
         .steps = 5,
         .drivers = {{Load{"pull", DeadForce{{0, {0, 0.5, 0}}, {0, 0, 1}}}, 0, 1}}});
    return scene;
}

TEST(Judgement, VanishingReactionIsComparedRelativeToTheActingForces) {
    // The bushing carries the load at its point of action: the pin force is only rounding.
    for (const double load : {1e-2, 1e3, 5e4}) {
        const auto comparison = compare(compile(one_arm(1e5, load)));
        for (const auto& reason : comparison.branches[0].inconclusive.texts())
            ADD_FAILURE() << reason << "; " << describe(comparison.branches[0].bounds);
        EXPECT_TRUE(comparison.conclusive());
    }
}

TEST(Judgement, ForceOfAStiffMountIsJudgedByTheRoundingOfPositions) {
    for (const double k : {1e7, 1e9, 1e11}) {
        const auto comparison = compare(compile(one_arm(k, 1000)));
        for (const auto& reason : comparison.branches[0].inconclusive.texts())
            ADD_FAILURE() << k << ": " << reason << "; " << describe(comparison.branches[0].bounds);
    }
}

TEST(Judgement, BoundsAreFractionsOfTheActingForces) {
    const Model model = compile(one_arm(1e5, 1000));
    const auto bounds = compare(model).branches[0].bounds;
    EXPECT_NEAR(bounds.scale.force, 1000, 20);  // the load, and the mount's force that balances it
    EXPECT_NEAR(bounds.scale.length, 0.5, 1e-12);
    EXPECT_NEAR(bounds.force, 1e-7 * bounds.scale.force, 1e-3 * bounds.force);
    EXPECT_DOUBLE_EQ(bounds.length, 1e-6);  // of a metre at least
    EXPECT_NE(describe(bounds).find("0.5 m"), std::string::npos) << describe(bounds);
    // Ten times the load gives ten times the bound.
    EXPECT_NEAR(compare(compile(one_arm(1e5, 1e4))).branches[0].bounds.force / bounds.force, 10,
                0.5);
    // The last digit of half a metre on a mount of 1e11 N/m exceeds any share of the load.
    const auto stiff = compare(compile(one_arm(1e11, 1000))).branches[0].bounds;
    EXPECT_GE(stiff.residual_force, 0.5 * 1e11 * std::numeric_limits<double>::epsilon());
}

TEST(Judgement, DisagreementOfTenTimesItsBoundIsNeverConclusive) {
    // The references' own numbers, one of them changed by ten times its bound.
    const Model model = compile(support::scene("chrono_mcpherson"));
    const auto comparison = compare(model);
    for (const auto& branch : comparison.branches)
        for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
            const Channel& channel = comparison.channels[c];
            if (is_undefined(comparison, branch, c)) continue;
            const double rate = share_of_rate(comparison, branch, c);
            const double bound = rate > 0                       ? rate
                                 : channel.unit == Unit::mm     ? branch.bounds.length
                                 : channel.unit == Unit::deg    ? branch.bounds.angle
                                 : channel.unit == Unit::newton ? branch.bounds.force
                                                                : branch.bounds.moment;
            BranchComparison wrong = branch;
            wrong.uncertainty.equal_parameter.channels[c].max += 10 * bound;
            const auto found = disagreements(model, comparison.channels, model.branches[0], wrong);
            ASSERT_EQ(found.count, 1) << channel.name;
            EXPECT_NE(found.worst[0].what.find(channel.name), std::string::npos);
            EXPECT_GT(found.worst[0].share, 9.9);
        }
    for (const Leg leg : {Leg::equilibrium, Leg::energy})
        for (double Residuals::*part :
             {&Residuals::force, &Residuals::moment, &Residuals::length}) {
            BranchComparison wrong = comparison.branches[0];
            const Leg other = leg == Leg::energy ? Leg::equilibrium : Leg::energy;
            const Bounds& b = wrong.bounds;
            wrong.run(leg).judged[static_cast<std::size_t>(other)].*part +=
                10 * (part == &Residuals::force    ? b.residual_force
                      : part == &Residuals::moment ? b.residual_moment
                                                   : 1e-3 * b.residual_length);
            EXPECT_EQ(disagreements(model, comparison.channels, model.branches[0], wrong).count, 1);
        }
}

TEST(Judgement, OutputUndefinedInOneReferenceOnlyIsADisagreement) {
    const auto& comparison = mcpherson();
    const Model model = compile(support::scene("chrono_mcpherson"));
    const auto c = std::ranges::find_if(comparison.channels, &Channel::may_be_undefined) -
                   comparison.channels.begin();
    ASSERT_LT(c, std::ssize(comparison.channels));
    for (const Leg leg : {Leg::equilibrium, Leg::energy}) {
        BranchComparison wrong = comparison.branches[0];
        auto& value = wrong.run(leg).curve.values[3][static_cast<std::size_t>(c)];
        value = value == undefined ? 1 : undefined;
        const auto found = disagreements(model, comparison.channels, model.branches[0], wrong);
        ASSERT_EQ(found.count, 1) << name(leg);
        EXPECT_NE(
            found.worst[0].what.find(
                "whether " + comparison.channels[static_cast<std::size_t>(c)].name + " is defined"),
            std::string::npos)
            << found.worst[0].what;
    }
}

TEST(Judgement, LegThatIsOffByTenTimesTheBoundIsNamed) {
    // The energy leg solves a spring that is stiffer by 1e-6.
    const Scene right = support::scene("pinned_bar");
    Scene wrong = right;
    const auto stiffer =
        overloaded{[](AxialSpring& e) { std::get<LinearRate>(e.law).k *= 1 + 1e-6; },
                   [](Bushing& e) { std::get<LinearStiffness>(e.law).K *= 1 + 1e-6; }};
    std::visit(stiffer, wrong.elastics.front().kind);
    const Model a = compile(right), b = compile(wrong);
    auto comparison = compare(a);
    const auto odd = run(b, b.branches[0], Leg::energy);
    BranchComparison branch = comparison.branches[0];
    branch.uncertainty.equal_parameter = at_equal_parameter(branch.runs[1].curve, odd.curve);
    EXPECT_GT(disagreements(a, comparison.channels, a.branches[0], branch).count, 0);
}

TEST(Judgement, ManyDisagreementsAreShownAsTheWorstThreeAndACount) {
    Objections all;
    for (int k = 0; k < 440; ++k) all.add(std::to_string(k), 2 + (k * 37) % 440);
    all.add("no number");
    EXPECT_EQ(all.count, 441);
    ASSERT_EQ(all.worst.size(), 3u);
    EXPECT_EQ(all.worst[0].what, "no number");
    EXPECT_GT(all.worst[1].share, all.worst[2].share);
    EXPECT_EQ(all.worst[1].share, 441);
    ASSERT_EQ(all.texts().size(), 4u);
    EXPECT_EQ(all.texts()[3], "and 438 more with smaller differences");
    EXPECT_TRUE(Objections{}.empty() && Objections{}.texts().empty());
}

// ---- Branches without information

TEST(Judgement, BranchWhoseLoadWasLeftOutIsInconclusiveAndNotJudgedByTheGate) {
    Scene scene = one_arm(1e5, 1000);
    scene.bodies.push_back({"far away", {}});
    for (auto& driver : scene.branches[0].drivers)
        std::get<DeadForce>(std::get<Load>(driver.what).kind).at.body = 1;
    const auto comparison = compare(compile(scene));
    EXPECT_FALSE(comparison.conclusive());
    const auto why = comparison.branches[0].inconclusive.texts();
    ASSERT_FALSE(why.empty());
    EXPECT_EQ(why[0],
              "nothing drives branch 'up': load 'pull': its body is left out (branch 'up')");
    // The gate must not pass it either, though every number is unchanged.
    Baseline baseline;
    baseline.accepted = measure(compile(scene), comparison);
    baseline.reason = "all zeros";
    for (const auto kind : tolerance_classes) baseline.tolerances[kind] = default_tolerances(kind);
    const auto verdict = judge(baseline, baseline.accepted, ToleranceClass::same_build);
    EXPECT_GT(verdict.compared, 0);
    EXPECT_EQ(verdict.grade(), Grade::not_judged);
}

TEST(Judgement, BranchWhoseLoadMovesNothingIsConclusiveAndPasses) {
    Scene scene = one_arm(1e5, 1000);
    // The load acts on the pin, which carries all of it.
    std::get<DeadForce>(std::get<Load>(scene.branches[0].drivers[0].what).kind) = {{0, {0, 0, 0}},
                                                                                   {1, 0, 0}};
    const Model model = compile(scene);
    const auto comparison = compare(model);
    EXPECT_TRUE(comparison.conclusive());
    EXPECT_GT(comparison.compared, 0);
    EXPECT_EQ(assess(model, comparison, default_tolerance, true).verdict, Grade::pass);
}

// ---- Two-sided branches

TEST(BranchSides, TwoSidesAreJoinedIntoOneCurve) {
    Scene both = support::scene("chrono_mcpherson");
    ASSERT_EQ(both.branches.size(), 2u);
    const Scene halves = both;
    both.branches.resize(1);
    both.branches[0].name = "bounce";
    both.branches[0].from = halves.branches[1].to;
    both.branches[0].to = halves.branches[0].to;
    both.branches[0].steps = 60;
    Scene short_halves = halves;
    for (auto& branch : short_halves.branches) branch.steps = 30;
    const Model whole = compile(both), apart = compile(short_halves);
    for (const Leg leg : legs) {
        const auto one = run(whole, whole.branches[0], leg);
        const auto up = run(apart, apart.branches[0], leg),
                   down = run(apart, apart.branches[1], leg);
        ASSERT_EQ(one.outcome, Outcome::converged) << one.detail;
        ASSERT_EQ(one.curve.a.size(), 61u);
        EXPECT_EQ(one.curve.start, 30u);
        EXPECT_EQ(one.curve.a.front(), halves.branches[1].to);
        EXPECT_TRUE(trend(one.curve.a).course == Course::rising);
        for (std::size_t k = 0; k <= 30; ++k) {
            EXPECT_EQ(one.curve.values[30 + k], up.curve.values[k]) << name(leg);
            EXPECT_EQ(one.curve.values[30 - k], down.curve.values[k]) << name(leg);
        }
        EXPECT_EQ(one.counts.factorisations, up.counts.factorisations + down.counts.factorisations);
    }
    const auto comparison = compare(whole);
    EXPECT_TRUE(comparison.conclusive());
    EXPECT_EQ(comparison.branches[0].deviation.equal_parameter.channels[0].compared, 61);
    EXPECT_EQ(comparison.branches[0].deviation.equal_abscissa.not_compared, "");
}

TEST(BranchSides, AnyMonotonicChannelCanBeTheAbscissa) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    Options options;
    options.abscissa = "camber";
    const auto comparison = compare(model, options);
    for (const auto& branch : comparison.branches) {
        const auto& reading = branch.deviation.equal_abscissa;
        if (!reading.not_compared.empty()) {
            EXPECT_TRUE(reading.not_compared.starts_with("camber turns back at "))
                << reading.not_compared;
            continue;
        }
        EXPECT_LE(reading.channels[4].max, 1e-9);
    }
    options.abscissa = "cambre";
    EXPECT_THROW((void)compare(model, options), std::invalid_argument);
}

// ---- Start of a branch

TEST(SettledPosition, DisplacementFromTheDesignPositionEqualsItsClosedForm) {
    // The arm of the test above with half its load held from the start: 5 mm by closed form.
    Scene scene = one_arm(1e5, 10);
    scene.branches[0].drivers[0].start = 500;
    const Model model = compile(scene);
    const auto all = channels(model);
    const auto found = settled(model, all, model.branches[0]);
    ASSERT_EQ(found.outcome, Outcome::converged) << found.detail;
    EXPECT_NEAR(found.displacement[static_cast<std::size_t>(find_channel(all, "tip_z"))], 5, 0.01);
    const Model balanced = compile(support::scene("chrono_mcpherson"));
    const auto outputs = channels(balanced);
    const auto moved = settled(balanced, outputs, balanced.branches[0]).displacement;
    for (std::size_t c = 0; c < outputs.size(); ++c)
        if (outputs[c].kind() != ChannelKind::element) {  // which a state alone does not have
            EXPECT_NEAR(moved[c], 0, 1e-8) << outputs[c].name;
        }
}

}  // namespace
}  // namespace elastocheck::compare
