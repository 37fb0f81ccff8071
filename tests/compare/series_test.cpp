// Use of a polynomial branch in compare: rates of outputs, loads for travels, study over orders.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/outputs/rates.hpp"
#include "compare/studies/order_study.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using recursive::series::evaluate;
using recursive::series::find;
using recursive::series::follow;

TEST(ChannelRates, RatesOfTheSeriesEqualDifferencesOfTheOutputs) {
    for (const auto& name : support::small_scene_names()) {
        const Model model = compile(support::scene(name));
        const auto all = channels(model);
        for (const auto& whole : model.branches) {
            const BranchSide way = sides_of(model, whole).back();
            const Branch& branch = way.branch;
            const auto path = follow(way.model, branch);
            ASSERT_EQ(path.outcome, Outcome::converged)
                << name << " " << way.name << " " << path.detail;
            for (const double share : {0.1, 0.45, 0.8}) {
                const double a = share * branch.to, h = 1e-3 * branch.to;
                std::vector<Equilibrium> points;
                for (const double at : {a - 2 * h, a - h, a + h, a + 2 * h})
                    points.push_back(evaluate(way.model, branch, path, *find(path, at)));
                const Curve c = curve(way.model, all, branch, points);
                const auto rates = channel_rates(way.model, all, branch, path, *find(path, a));
                ASSERT_EQ(rates.size(), all.size());
                const auto slope = [&](std::size_t k) {
                    const auto v = c.channel(k);
                    return (v[0] - 8 * v[1] + 8 * v[2] - v[3]) / (12 * (c.a[2] - c.a[1]) / 2);
                };
                double largest = 0;
                for (std::size_t k = 0; k < all.size(); ++k)
                    if (all[k].kinematic()) largest = std::max(largest, std::abs(slope(k)));
                for (std::size_t k = 0; k < all.size(); ++k) {
                    EXPECT_EQ(std::isnan(rates[k]), !all[k].kinematic()) << all[k].name;
                    if (all[k].kinematic()) {
                        EXPECT_NEAR(rates[k], slope(k), 1e-7 * largest)
                            << name << " " << all[k].name;
                    }
                }
            }
        }
    }
}

TEST(OrderStudy, ErrorIsWithinTheToleranceAndHigherOrdersNeedFewerExpansions) {
    const Model model = compile(support::scene("chrono_mcpherson"));
    OrderOptions options;
    options.orders = {4, 8, 12, 16};
    options.tolerances = {1e-6, 1e-9};
    const auto orders = order_study(model, options);
    ASSERT_EQ(orders.size(), model.branches.size());
    EXPECT_TRUE(conclusive(orders));
    for (const auto& branch : orders) {
        ASSERT_EQ(branch.levels.size(), 8u);
        for (const auto& level : branch.levels) {
            EXPECT_EQ(level.outcome, Outcome::converged);
            EXPECT_LE(level.error.mm, 1e3 * level.tolerance + branch.uncertainty.mm) << level.order;
            EXPECT_GT(level.error.mm, 1e-10) << "no series is that good: nothing was compared";
            EXPECT_GT(level.work.factorisations, 0);
        }
        for (std::size_t k = 1; k < 4; ++k)  // higher orders reach farther
            EXPECT_LE(branch.levels[k].expansions, branch.levels[k - 1].expansions);
    }
}

TEST(OrderStudy, StudyWithoutAConvergedSeriesIsNotConclusive) {
    EXPECT_FALSE(conclusive({}));
    const Model model = compile(support::scene("chrono_mcpherson"));
    OrderOptions options;
    options.orders = {2};
    options.tolerances = {1e-12};
    const auto orders = order_study(model, options);
    EXPECT_EQ(orders.front().levels.front().outcome, Outcome::iteration_limit);
    EXPECT_FALSE(conclusive(orders));
}

}  // namespace
}  // namespace elastocheck::compare
