// Work-precision comparison: recommendations hold, and unjudgeable configurations are not ranked.
#include "compare/studies/work_precision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "compare/studies/solves.hpp"
#include "compare/studies/timing.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/recursive.hpp"
#include "tests/support/command.hpp"
#include "tests/support/mistakes.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Model shipped(const std::string& name, double load = 1) {
    Scene scene = support::scene(name);
    for (auto& branch : scene.branches) branch.to *= load;
    return compile(scene);
}

// Errors, counts and recommendations do not depend on the timing rounds, each of which repeats the
// whole work: only tests of times and their front ask for some.
TradeOptions quick(Tolerance tolerance, int max_steps = 160, int rounds = 0) {
    return {.tolerance = tolerance, .max_steps = max_steps, .rounds = rounds};
}

const TradePoint* find(const Trade& trade, std::string_view method, int steps) {
    for (const auto& point : trade.points)
        if (point.method == method && point.steps == steps) return &point;
    return nullptr;
}

// Error of a recommendation in a new solve with ten times the steps and output points, without code
// of work_precision.cpp.
Accuracy solved_anew(const Model& model, const Trade& trade) {
    const TradePoint& point = trade.points[trade.recommendation->point];
    const int outputs = 10 * trade.points_per_branch;
    recursive::Options options;
    options.method = *recursive::find_method(point.method);
    options.steps = point.steps > 0 ? 10 * point.steps : outputs;
    options.record = outputs;
    if (auto* adaptive = std::get_if<recursive::Adaptive>(&options.method.kind))
        *adaptive = {point.own_tolerance, 1.745 * point.own_tolerance};
    if (auto* series = std::get_if<recursive::Series>(&options.method.kind))
        series->tolerance = point.own_tolerance;
    const auto all = channels(model);
    Accuracy worst;
    for (const auto& branch : model.branches) {
        std::vector<double> loads;
        for (int k = 0; k <= outputs; ++k) loads.push_back(branch.to * k / outputs);
        const auto fast = point.leg == Leg::recursive ? recursive::solve(model, branch, options)
                          : point.leg == Leg::energy
                              ? reference::energy::solve(model, branch, loads)
                              : reference::equilibrium::solve(model, branch, loads);
        const auto truth = point.leg == Leg::equilibrium
                               ? reference::energy::solve(model, branch, loads)
                               : reference::equilibrium::solve(model, branch, loads);
        EXPECT_EQ(fast.points.size(), truth.points.size());
        for (std::size_t k = 0; k < std::min(fast.points.size(), truth.points.size()); ++k) {
            const auto a = evaluate(model, fast.points[k]), b = evaluate(model, truth.points[k]);
            for (std::size_t c = 0; c < all.size(); ++c)
                if (all[c].main) {
                    double& side = all[c].unit == Unit::deg ? worst.deg : worst.mm;
                    if (!(std::abs(a[c] - b[c]) <= side)) side = std::abs(a[c] - b[c]);
                }
        }
    }
    return worst;
}

// ---- the tolerance

TEST(Tolerance, LengthAndAngleAreReadInAnyOrderAndAlone) {
    for (const std::string text :
         {"0.01mm,0.001deg", "0.001deg,0.01mm", " 1e-2 mm , 1e-3 deg ", "0.01 mm,.001deg"}) {
        const Tolerance tolerance = parse_tolerance(text);
        EXPECT_EQ(tolerance.mm, 0.01) << text;
        EXPECT_EQ(tolerance.deg, 0.001) << text;
    }
    EXPECT_EQ(parse_tolerance("1e-2 mm").mm, 0.01);
    EXPECT_EQ(parse_tolerance("1e-2 mm").deg, infinity);
    EXPECT_EQ(parse_tolerance("2deg").deg, 2);
    EXPECT_EQ(parse_tolerance("2deg").mm, infinity);
}

TEST(Tolerance, InvalidTextIsRejectedWithTheAllowedForm) {
    const auto file = std::filesystem::path(ELASTOCHECK_SCENES) / "../../tests/compare";
    support::expect_refusals(file / "tolerance.mistakes", "1mm", "", [](const std::string& text) {
        try {
            (void)parse_tolerance(text);
        } catch (const std::invalid_argument& error) {
            const std::string allowed = "allowed: a length in mm, an angle in deg or both";
            EXPECT_NE(std::string(error.what()).find(allowed), std::string::npos) << text;
            return std::string(error.what());
        }
        return std::string("accepted");
    });
}

TEST(Tolerance, ForcesAreJudgedByAShareByDefault) {
    EXPECT_EQ(parse_tolerance("0.01mm,0.001deg", ToleranceParts::with_shares).share, default_share);
    EXPECT_EQ(parse_tolerance("0.01mm, 5 %", ToleranceParts::with_shares).share, 0.05);
    EXPECT_EQ(parse_tolerance("2%", ToleranceParts::with_forces).mm, infinity);
    EXPECT_EQ(parse_tolerance("0.01mm").share, infinity);
    EXPECT_THROW((void)parse_tolerance("1%"), std::invalid_argument);
    EXPECT_THROW((void)parse_tolerance("1N", ToleranceParts::with_shares), std::invalid_argument);
    EXPECT_THROW((void)parse_tolerance("1%,2%", ToleranceParts::with_forces),
                 std::invalid_argument);
}

TEST(Tolerance, ShareOfNaNIsNaN) {
    for (const Tolerance tolerance :
         {Tolerance{1, 1}, Tolerance{1, infinity}, Tolerance{infinity, 1}})
        for (const Accuracy error : {Accuracy{nan, 0}, Accuracy{0, nan}, Accuracy{nan, nan}})
            EXPECT_TRUE(std::isnan(share_of(tolerance, error)))
                << tolerance.mm << " " << error.mm << " " << error.deg;
    EXPECT_EQ(share_of({0.5, 2}, {1, 1}), 2);
    EXPECT_EQ(share_of({0.5, infinity}, {1, 1e9}), 2);
}

// ---- the front

TEST(ParetoFront, ContainsExactlyTheNondominatedMembers) {
    std::mt19937 random(20);
    for (int trial = 0; trial < 500; ++trial) {
        std::vector<WorkError> points(1 + random() % 20);
        const auto value = [&]() -> double {  // few distinct values, so that ties occur
            const auto k = random() % 10;
            return k == 0 ? nan : k == 1 ? infinity : static_cast<double>(k);
        };
        for (auto& point : points) point = {value(), value()};
        const auto front = pareto_front(points);
        ASSERT_EQ(front.size(), points.size());
        for (std::size_t k = 0; k < points.size(); ++k) {
            const bool finite = std::isfinite(points[k].work) && std::isfinite(points[k].error);
            bool dominated = false, by_member = false;
            for (std::size_t l = 0; l < points.size(); ++l) {
                const auto &a = points[l], &b = points[k];
                const bool better = a.work <= b.work && a.error <= b.error &&
                                    (a.work < b.work || a.error < b.error) &&
                                    std::isfinite(a.work) && std::isfinite(a.error);
                dominated = dominated || better;
                by_member = by_member || (better && front[l]);
            }
            EXPECT_EQ(front[k], finite && !dominated) << "trial " << trial << " point " << k;
            EXPECT_EQ(finite && !front[k], finite && by_member)
                << "trial " << trial << " point " << k;
        }
    }
}

TEST(ParetoFront, KeepsEqualMembersAndNaNDominatesNothing) {
    EXPECT_EQ(pareto_front(std::vector<WorkError>{
                  {1, 1}, {1, 1}, {2, 1}, {nan, 0}, {0, nan}, {0, infinity}}),
              (std::vector<bool>{true, true, false, false, false, false}));
    EXPECT_TRUE(pareto_front({}).empty());
}

// ---- times

TEST(Timing, JobsTakeTurnsInEveryRound) {
    std::string order;
    const std::vector<std::function<void()>> jobs{[&] { order += 'a'; }, [&] { order += 'b'; },
                                                  [&] { order += 'c'; }};
    const Times times = take_turns(jobs, 3);
    EXPECT_EQ(order, "abcabcabc");
    ASSERT_EQ(times.size(), 3u);
    for (const auto& job : times) EXPECT_EQ(job.size(), 3u);
}

TEST(Timing, MedianRatiosAndNoiseOfTimesEqualHandCalculation) {
    EXPECT_EQ(median({3, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
    EXPECT_TRUE(std::isnan(median({})));
    EXPECT_EQ(ratios({2, 6}, {1, 3}), (std::vector<double>{2, 2}));
    EXPECT_EQ(noise_of({1, 1, 1}), 0);
    EXPECT_DOUBLE_EQ(noise_of({1.25, 1.25, 1.25}),
                     0.25);  // always slower in second place: an offset counts as noise
    EXPECT_DOUBLE_EQ(noise_of({0.5, 1, 1.5}), 0.5);
    EXPECT_TRUE(std::isnan(noise_of({})));
}

// ---- the trade

TEST(Trade, RecommendationMeetsItsToleranceAtTenTimesThePoints) {
    int recommended = 0;
    for (const auto& name : {"pinned_bar", "pendulum", "two_spring_arch", "bushing_pair"})
        for (const double mm : {1.0, 1e-2, 1e-4, 1e-6}) {
            const Model model = shipped(name);
            const Trade result = trade(model, quick({mm}));
            if (!result.recommendation) continue;
            const Accuracy found = solved_anew(model, result);
            EXPECT_TRUE(std::isfinite(found.mm) && found.mm <= mm)
                << name << " " << mm
                << " mm: " << describe(result.points[result.recommendation->point]) << " "
                << found.mm;
            const auto& r = *result.recommendation;
            EXPECT_TRUE(r.confirmed.mm <= mm && r.confirmed.mm <= r.high.mm)
                << r.confirmed.mm << " " << r.high.mm;
            EXPECT_LE(r.high.mm, mm) << name;
            EXPECT_TRUE(r.low.mm <= r.expected.mm && r.expected.mm <= r.high.mm)
                << r.low.mm << " " << r.expected.mm;
            EXPECT_GT(result.recommendation->confirmed_numbers, 100);
            ++recommended;
        }
    EXPECT_EQ(recommended, 16);
}

TEST(Trade, RecommendationForTheMcPhersonMeetsLengthAndAngle) {
    const Model model = shipped("chrono_mcpherson");
    for (const Tolerance tolerance :
         {Tolerance{0.01, 0.001}, Tolerance{1, 1e-4}, Tolerance{1e-3, 1}}) {
        const Trade result = trade(model, quick(tolerance, 320, 2));
        ASSERT_TRUE(result.recommendation);
        const Accuracy found = solved_anew(model, result);
        EXPECT_TRUE(found.mm <= tolerance.mm && found.deg <= tolerance.deg)
            << found.mm << " " << found.deg;
        const auto& r = *result.recommendation;
        EXPECT_TRUE(r.low.mm <= r.expected.mm && r.expected.mm <= r.high.mm)
            << r.low.mm << " " << r.expected.mm << " " << r.high.mm;
        EXPECT_TRUE(r.low.deg <= r.expected.deg && r.expected.deg <= r.high.deg);
        EXPECT_LT(result.points[r.point].ratio, 1);
    }
}

// The published method meets the tolerance of positions with ten steps, but that of forces with no
// number of steps: their error stays 39 %.
TEST(Trade, RecommendationHasForcesWithinTheTolerance) {
    const Model model = shipped("chrono_mcpherson");
    const Tolerance by_positions{100, 10}, by_all{.mm = 100, .deg = 10, .share = 0.01};
    const auto of_two = [](const Tolerance& tolerance) {
        TradeOptions options = quick(tolerance, 80);
        options.methods = {"published", "midpoint"};
        return options;
    };
    const Trade loose = trade(model, of_two(by_positions)), strict = trade(model, of_two(by_all));
    ASSERT_TRUE(loose.recommendation && strict.recommendation);
    const auto& chosen = loose.points[loose.recommendation->point];
    EXPECT_GT(chosen.error.share, 0.01) << describe(chosen);
    EXPECT_LE(strict.recommendation->confirmed.share, 0.01);
    EXPECT_LE(strict.recommendation->high.share, 0.01);
    EXPECT_GT(strict.recommendation->confirmed.share, 0);
    EXPECT_GT(strict.points[strict.recommendation->point].work.price, chosen.work.price);
}

TEST(Trade, NothingIsRecommendedForAnImpossibleTolerance) {
    for (const auto& name : {"pinned_bar", "chrono_mcpherson", "single_bushing"}) {
        const Trade result = trade(shipped(name), quick({1e-15}, 40));
        EXPECT_FALSE(result.recommendation) << name;
        EXPECT_TRUE(result.inconclusive.empty());
    }
    const Trade angle = trade(shipped("chrono_mcpherson"), quick({1, 1e-16}, 40));
    EXPECT_FALSE(angle.recommendation);
}

// Under twice the load the published method diverges with many steps.
const Trade& of_a_pendulum_that_diverges() {
    static const Trade result = trade(shipped("pendulum", 2), quick({50}, 640, 2));
    return result;
}

TEST(Trade, UnconvergedConfigurationIsListedAndNotRanked) {
    const Trade& result = of_a_pendulum_that_diverges();
    for (const auto& method : {"published", "closed", "balanced"}) {
        const TradePoint* point = find(result, method, 640);
        ASSERT_NE(point, nullptr);
        EXPECT_EQ(point->outcome, Outcome::diverged) << method;
        EXPECT_FALSE(point->detail.empty());
    }
    int listed = 0;
    for (const auto& point : result.points) {
        if (point.outcome == Outcome::converged) continue;
        ++listed;
        EXPECT_FALSE(point.ranked || point.on_front[0] || point.on_front[1] || point.on_front[2])
            << describe(point);
        EXPECT_EQ(point.not_ranked, name(point.outcome));
        EXPECT_TRUE(std::isnan(point.error.mm) && std::isnan(point.ratio)) << describe(point);
    }
    EXPECT_GE(listed, 3);
}

TEST(Trade, MethodDivergingAtMoreStepsIsNotRecommendedAtFewer) {
    const Trade& result = of_a_pendulum_that_diverges();
    EXPECT_LT(find(result, "published", 10)->error.mm, 50);  // meets the tolerance by chance
    ASSERT_TRUE(result.recommendation);
    const TradePoint& chosen = result.points[result.recommendation->point];
    for (const auto& method : {"published", "closed", "balanced"}) EXPECT_NE(chosen.method, method);
}

TEST(Trade, ConfigurationWithCancellingErrorsIsNotRecommended) {
    // The published method's step error compensates half of its formulation gap at ten steps, and
    // nothing at many.
    const Trade result = trade(shipped("pinned_bar"), quick({4}));
    EXPECT_LT(find(result, "published", 10)->error.mm, 4);
    EXPECT_GT(find(result, "published", 160)->error.mm, 4);
    ASSERT_TRUE(result.recommendation);
    EXPECT_NE(result.points[result.recommendation->point].method, "published");
    EXPECT_NE(result.points[result.recommendation->point].method, "closed");
}

TEST(Trade, ErrorsBelowTheReferenceUncertaintyAreNotRanked) {
    // One bushing along its axis is linear: every method is exact, and their ranking
    // would be noise.
    const Trade linear = trade(shipped("single_bushing"), quick({0.001}, 40));
    for (const auto& point : linear.points) {
        EXPECT_FALSE(point.ranked) << describe(point) << " " << point.error.mm;
        EXPECT_LE(point.error.mm, linear.uncertainty.mm);
    }
    ASSERT_TRUE(linear.recommendation);  // meeting the tolerance needs no ranking
    EXPECT_GE(linear.recommendation->high.mm, linear.uncertainty.mm);

    for (const auto& name : {"pinned_bar", "chrono_mcpherson"}) {
        const Trade result = trade(shipped(name), quick({0.01, 0.001}, 40));
        for (const auto& point : result.points)
            EXPECT_FALSE(point.ranked &&
                         !(point.share > share_of(result.tolerance, result.uncertainty)))
                << describe(point);
    }
}

TEST(Trade, ToleranceBelowTheReferenceUncertaintyHasNoRecommendation) {
    // Every method is exact here, but the references are only known to their own distance.
    const Model model = shipped("single_bushing");
    const double known = trade(model, quick({1}, 20)).uncertainty.mm;
    const Trade result = trade(model, quick({known / 2}, 20));
    EXPECT_LT(find(result, "tangent", 20)->error.mm, known / 2);
    EXPECT_FALSE(result.recommendation);
}

// A recommendation whose error by `worse` exceeds that of its rung, and the recommendation at a
// tolerance between the two.
std::optional<std::pair<Recommendation, Trade>> squeezed(const Model& model, int points,
                                                         double Accuracy::*mm,
                                                         Accuracy Recommendation::*worse_than) {
    for (const char* method : {"tangent", "chord", "midpoint", "balanced"})
        for (const double tolerance : {3.0, 1.0, 0.3, 0.1, 0.03, 0.01}) {
            TradeOptions options = quick({tolerance}, 160);
            options.methods = {method};
            options.points = points;
            const Trade first = trade(model, options);
            if (!first.recommendation) continue;
            const Recommendation& r = *first.recommendation;
            const double low = worse_than == &Recommendation::high
                                   ? std::max(r.expected.*mm, r.confirmed.*mm)
                                   : r.expected.*mm,
                         high = r.*worse_than.*mm;
            if (!(high > 1.002 * low)) continue;
            options.tolerance.mm = std::sqrt(low * high);
            return std::pair{r, trade(model, options)};
        }
    return std::nullopt;
}

TEST(Trade, ConfigurationFailingItsConfirmationIsListedAndNotRecommended) {
    // With one output point at the end, only the confirming run sees the worst error between.
    std::optional<std::pair<Recommendation, Trade>> found;
    for (const auto& name :
         {"pendulum", "two_spring_arch", "bushing_pair", "pinned_bar", "chrono_mcpherson"})
        if (!found) found = squeezed(shipped(name), 1, &Accuracy::mm, &Recommendation::confirmed);
    ASSERT_TRUE(found);
    const auto& [first, result] = *found;
    ASSERT_FALSE(result.rejected.empty());
    support::expect_parts(result.rejected.front(), {"when run again"});
    if (result.recommendation) {
        EXPECT_NE(result.recommendation->point, first.point);
        EXPECT_LE(result.recommendation->confirmed.mm, result.tolerance.mm);
    }
}

TEST(Trade, ConfigurationWhoseErrorBandExceedsTheToleranceIsNotRecommended) {
    const auto found =
        squeezed(shipped("chrono_mcpherson_preload"), 10, &Accuracy::mm, &Recommendation::high);
    ASSERT_TRUE(found);
    const auto& [first, result] = *found;
    const auto up_to = [](const std::string& line) {
        return line.find(": up to ") != std::string::npos;
    };
    EXPECT_TRUE(std::ranges::any_of(result.rejected, up_to));
    if (result.recommendation) {
        EXPECT_NE(result.recommendation->point, first.point);
        EXPECT_LE(result.recommendation->high.mm, result.tolerance.mm);
    }
}

TEST(Trade, FailedReferencesMakeTheStudyInconclusive) {
    // the limit is at -211.5 N
    const Trade result = trade(shipped("two_spring_arch", 1.5), quick({1}, 20));
    ASSERT_FALSE(result.inconclusive.empty());
    support::expect_parts(result.inconclusive.front(), {"equilibrium leg: limit point"});
    EXPECT_FALSE(result.recommendation);
    for (const auto& point : result.points) EXPECT_FALSE(point.ranked) << describe(point);
}

// With one output point at the end, only the confirming run meets the end of the spring's table in
// the middle of the branch, where the arch is flat.
TEST(Trade, MissingReferenceForTheConfirmationMakesTheStudyInconclusive) {
    Scene scene = support::scene("arch_driven");
    scene.branches.resize(1);
    scene.branches[0].from = 0;
    scene.branches[0].to = -0.16;
    for (auto& elastic : scene.elastics) {
        auto& spring = std::get<AxialSpring>(elastic.kind);
        const double k = std::get<LinearRate>(spring.law).k, end = 5e-3;
        spring.law = elastocheck::Curve{
            {-end, end}, {{{-k * end, k, 0, 0}, {-k * end, k, 0, 0}, {k * end, k, 0, 0}}}, false};
    }
    TradeOptions options = quick({1}, 40);
    options.points = 1;
    const Trade result = trade(compile(scene), options);
    ASSERT_EQ(result.inconclusive.size(), 1u);
    support::expect_parts(result.inconclusive[0], {"cannot be confirmed: no reference"});
    support::expect_parts(result.inconclusive[0], {"equilibrium leg: outside"});
    EXPECT_FALSE(result.recommendation);
    for (const auto& line : result.rejected) EXPECT_EQ(line.find("nan"), std::string::npos) << line;
}

TEST(Trade, SceneWithoutAnglesIgnoresTheToleranceOfAngles) {
    const Trade both = trade(shipped("pinned_bar"), quick({0.01, 1e-30}, 20));
    EXPECT_FALSE(both.angles);
    EXPECT_TRUE(both.recommendation);
    const Trade angle = trade(shipped("pinned_bar"), quick({infinity, 1}, 20));
    EXPECT_FALSE(angle.recommendation);
    ASSERT_EQ(angle.inconclusive.size(), 1u);
    EXPECT_NE(angle.inconclusive.front().find("only an angle has a tolerance"), std::string::npos);
}

TEST(Trade, WorkIsProportionalToStepsTimesCostPerStep) {
    const Trade result = trade(shipped("pinned_bar"), quick({0.01}, 80));
    // two branches, and one more each to settle at a = 0
    for (const int steps : {10, 20, 40, 80}) {
        EXPECT_EQ(find(result, "published", steps)->work.solves, 2 * steps);
        EXPECT_EQ(find(result, "published", steps)->work.factorisations, 2 * steps);
        EXPECT_EQ(find(result, "chord", steps)->work.solves, 4 * steps + 2);
        EXPECT_EQ(find(result, "chord", steps)->work.factorisations, 2 * steps + 2);
        EXPECT_EQ(find(result, "midpoint", steps)->work.factorisations, 4 * steps + 2);
    }
    EXPECT_EQ(find(result, "published", 160), nullptr);
}

TEST(Trade, WorkBudgetOfZeroTriesTheSmallestStepCountOnly) {
    TradeOptions options = quick({0.01}, 2560);
    options.work_budget = 0;
    const Trade result = trade(shipped("pinned_bar"), options);
    EXPECT_NE(find(result, "tangent", 10), nullptr);
    EXPECT_EQ(find(result, "tangent", 20), nullptr);
}

TEST(Trade, EquilibriumLegIsTimedTwiceAndIsTheUnitOfTime) {
    const Trade result = trade(shipped("pinned_bar"), quick({0.01}, 20, 2));
    EXPECT_EQ(result.points.front().ratio, 1);
    const TradePoint& again = result.points.back();
    EXPECT_TRUE(again.again);
    EXPECT_TRUE(std::isfinite(again.ratio) && again.ratio > 0);
    EXPECT_TRUE(std::isfinite(result.noise) && result.noise >= std::abs(again.ratio - 1));
    EXPECT_EQ(again.work.factorisations, result.points.front().work.factorisations);
}

// ---- the arithmetic

TEST(Trade, EverythingButTheTimesIsReproducible) {
    for (const auto& name : {"chrono_mcpherson", "pinned_bar"}) {
        const Model model = shipped(name);
        std::vector<Trade> runs;
        for (const int rounds : {0, 1, 3}) {
            runs.push_back(trade(model, quick({0.01, 0.001}, 160, rounds)));
            ASSERT_TRUE(runs.back().recommendation) << name;
            EXPECT_EQ(runs.back().recommendation->point, runs.front().recommendation->point)
                << name;
            EXPECT_EQ(runs.back().recommendation->high.mm, runs.front().recommendation->high.mm)
                << name;
            EXPECT_EQ(runs.back().rejected, runs.front().rejected) << name;
            ASSERT_EQ(runs.back().points.size(), runs.front().points.size());
            for (std::size_t k = 0; k < runs.back().points.size(); ++k) {
                const TradePoint &p = runs.back().points[k], &q = runs.front().points[k];
                EXPECT_EQ(p.work.price, q.work.price) << describe(p);
                EXPECT_EQ(p.outcome, q.outcome) << describe(p);
                EXPECT_EQ(p.ranked, q.ranked) << describe(p);
                EXPECT_TRUE(p.error.mm == q.error.mm || p.outcome != Outcome::converged);
                EXPECT_TRUE(p.error.deg == q.error.deg || p.outcome != Outcome::converged);
                for (const bool on_front : p.on_front)
                    EXPECT_FALSE(on_front && !p.ranked) << describe(p);
            }
        }
        const Trade& result = runs.front();
        for (const auto& point : result.points)
            EXPECT_TRUE(std::isnan(point.ratio) && std::isnan(point.work.seconds))
                << describe(point);
    }
}

TEST(Trade, RecommendedToleranceOfAMethodIsTheLargestThatSuffices) {
    // A series of high order is accurate at a tolerance of 1 mm too, by chance.
    for (const Tolerance required :
         {Tolerance{0.01, 0.001}, Tolerance{0.01}, Tolerance{infinity, 0.001}}) {
        TradeOptions options = quick(required, 40);
        options.methods = {"adaptive", "series"};
        const Trade result = trade(shipped("chrono_mcpherson"), options);
        ASSERT_TRUE(result.recommendation);
        const TradePoint& chosen = result.points[result.recommendation->point];
        EXPECT_LE(1e3 * chosen.own_tolerance, required.mm) << describe(chosen);
        EXPECT_LE(1.745 * chosen.own_tolerance * 180 / std::numbers::pi, required.deg)
            << describe(chosen);
        // and of the rungs of equal cost, the loosest allowed one
        for (const auto& point : result.points)
            if (point.method == chosen.method && point.own_tolerance > chosen.own_tolerance &&
                1e3 * point.own_tolerance <= required.mm &&
                100 * point.own_tolerance <= required.deg) {
                EXPECT_GT(point.work.price, chosen.work.price) << describe(point);
            }
    }
}

TEST(Trade, PriceCountsFactorisationsAsBackSubstitutions) {
    TradeOptions options = quick({0.01, 0.001}, 160);
    const Model model = shipped("chrono_mcpherson");
    const Trade result = trade(model, options);
    ASSERT_TRUE(result.recommendation);
    const double N = coordinates(model) + constraint_rows(model);
    const TradePoint& chosen = result.points[result.recommendation->point];
    for (const auto& point : result.points) {
        EXPECT_NEAR(point.work.price,
                    N / 3 * static_cast<double>(point.work.factorisations) +
                        static_cast<double>(point.work.solves + point.work.evaluations),
                    1e-9 * point.work.price)
            << describe(point);
        if (point.method == "tangent" && share_of(result.tolerance, point.error) <= 1) {
            EXPECT_LE(chosen.work.price, point.work.price) << describe(point);
        }
    }
    EXPECT_LE(result.recommendation->confirmed.mm, 0.01);
    options.rounds = -1;
    EXPECT_THROW((void)trade(model, options), std::invalid_argument);
}

TEST(Trade, PriceOfATwoSidedBranchIsTheSumOfItsSides) {
    Scene both = support::scene("pinned_bar");
    const Scene halves = both;
    ASSERT_EQ(both.branches.size(), 2u);
    both.branches.resize(1);
    both.branches[0].from = halves.branches[1].to;
    TradeOptions options = quick({0.01}, 40);
    options.points = 20;
    const Trade one = trade(compile(both), options);
    options.points = 10;
    options.max_steps = 20;
    const Trade two = trade(compile(halves), options);
    for (const auto& method : {"published", "tangent", "midpoint"}) {
        const auto *a = find(one, method, 40), *b = find(two, method, 20);
        ASSERT_TRUE(a != nullptr && b != nullptr) << method;
        EXPECT_EQ(a->work.solves, b->work.solves) << method;
        EXPECT_EQ(a->error.mm, b->error.mm) << method;
    }
    EXPECT_TRUE(one.recommendation);
}

TEST(Trade, BranchWithoutMovementMakesTheStudyInconclusive) {
    Scene scene = support::scene("pinned_bar");
    for (auto& driver : scene.branches[0].drivers)
        std::get<DeadForce>(std::get<Load>(driver.what).kind).f.setZero();
    const Trade result = trade(compile(scene), quick({0.01}, 10));
    ASSERT_FALSE(result.inconclusive.empty());
    EXPECT_NE(result.inconclusive[0].find("nothing drives branch"), std::string::npos);
    EXPECT_FALSE(result.recommendation);
}

TEST(ErrorProfile, EndsWithTheErrorOfItsConfigurationAndIsZeroForTheReference) {
    const Model model = shipped("chrono_mcpherson");
    const auto channels = compare::channels(model);
    Solves solves(model, 10, 4);
    for (std::size_t b = 0; b < model.branches.size(); ++b) {
        const Branch& branch = model.branches[b];
        const Profile found = profile(solves, b, {.method = "tangent", .steps = 40});
        ASSERT_EQ(found.a.size(), 41u);
        EXPECT_EQ(found.a.back(), branch.to);
        const auto truth = reference::energy::solve(model, branch, std::vector{0.0, branch.to});
        const auto path = recursive::solve(
            model, branch, {.method = *recursive::find_method("tangent"), .steps = 40});
        const auto u = evaluate(model, truth.points.back()),
                   v = evaluate(model, path.points.back());
        double mm = 0, deg = 0;
        for (std::size_t c = 0; c < channels.size(); ++c)
            if (channels[c].main)
                (channels[c].unit == Unit::deg ? deg : mm) =
                    std::max(channels[c].unit == Unit::deg ? deg : mm, std::abs(v[c] - u[c]));
        EXPECT_NEAR(found.deviation.back().mm, mm, 1e-6);
        EXPECT_NEAR(found.deviation.back().deg, deg, 1e-6);
        EXPECT_GT(found.deviation.back().mm, 1e-4);
        for (const auto& error : profile(solves, b, {.leg = Leg::equilibrium}).deviation)
            EXPECT_EQ(error.mm, 0);
    }
    for (const char* method : {"adaptive", "series"}) {
        const auto found = profile(solves, 0, {.method = method, .own_tolerance = 1e-6});
        EXPECT_EQ(found.a.size(), 41u) << method;
        for (const auto& error : found.deviation) EXPECT_LE(error.mm, 1e-3) << method;
    }
}

}  // namespace
}  // namespace elastocheck::compare
