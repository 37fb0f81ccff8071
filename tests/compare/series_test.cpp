// What compare makes of a polynomial branch: rates of outputs, loads for travels, the study over orders.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/order_study.hpp"
#include "compare/rates.hpp"
#include "models/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using recursive::series::evaluate;
using recursive::series::find;
using recursive::series::follow;

TEST(Rates, AreTheDerivativesOfTheOutputs) {
    for (const auto& name : support::scene_names()) {
        const Model model = compile(support::scene(name));
        const auto all = channels(model);
        for (const auto& branch : model.branches) {
            const auto path = follow(model, branch);
            const Equilibrium start = evaluate(model, path, {0, 0});
            for (const double share : {0.1, 0.45, 0.8}) {
                const double load = share * branch.to, h = 1e-3 * branch.to;
                std::vector<Equilibrium> points{start};
                for (const double at : {load - 2 * h, load - h, load + h, load + 2 * h})
                    points.push_back(evaluate(model, path, *find(path, at)));
                const Curve c = curve(model, branch, points);
                const ChannelRates rates = channel_rates(model, branch, path, *find(path, load));
                const auto slope = [&](auto value) {
                    return (value(1) - 8 * value(2) + 8 * value(3) - value(4)) / (12 * h);
                };
                const double travel = slope([&](std::size_t k) { return c.travel[k]; });
                EXPECT_NEAR(rates.travel, travel, 1e-7 * std::abs(travel)) << name;
                std::size_t main = 0;
                for (std::size_t k = 0; k < all.size(); ++k) {
                    if (!all[k].main) continue;
                    const double expected = slope([&](std::size_t p) { return c.values[p][k]; });
                    EXPECT_NEAR(rates.slope[main], expected, 1e-7 * std::abs(travel))
                        << name << " " << all[k].name;
                    ++main;
                }
                EXPECT_EQ(rates.slope.size(), main);
            }
        }
    }
}

TEST(Rates, LoadForATravelIsTheInverseOfTravelForALoad) {
    for (const char* name : {"mcpherson", "mcpherson_preload", "pinned_bar", "pendulum", "two_spring_arch"}) {
        const Model model = compile(support::scene(name));
        for (const auto& branch : model.branches) {
            const auto path = follow(model, branch);
            const Equilibrium start = evaluate(model, path, {0, 0});
            for (const double share : {0.0, 1e-6, 0.2, 0.7, 0.999, 1.0}) {
                const auto there = evaluate(model, path, *find(path, share * branch.to));
                const double travel = curve(model, branch, {start, there}).travel.back();
                const auto place = place_at_travel(model, branch, path, travel);
                ASSERT_TRUE(place) << name << " " << share;
                const auto back = evaluate(model, path, *place);
                EXPECT_NEAR(curve(model, branch, {start, back}).travel.back(), travel, 1e-9)
                    << name << " " << share;
            }
            EXPECT_FALSE(place_at_travel(model, branch, path, 1e4)) << name;
            EXPECT_FALSE(place_at_travel(model, branch, path, -1e4)) << name;
            EXPECT_FALSE(place_at_travel(model, branch, path, std::nan(""))) << name;
        }
    }
}

TEST(OrderStudy, ErrorStaysWithinWhatWasTold) {
    const Model model = compile(support::scene("mcpherson"));
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

TEST(OrderStudy, NothingComparedIsNotConclusive) {
    EXPECT_FALSE(conclusive({}));
    const Model model = compile(support::scene("mcpherson"));
    OrderOptions options;
    options.orders = {2};
    options.tolerances = {1e-12};
    options.expansions = 3;
    const auto orders = order_study(model, options);
    EXPECT_EQ(orders.front().levels.front().outcome, Outcome::iteration_limit);
    EXPECT_FALSE(conclusive(orders));
}

}  // namespace
}  // namespace elastocheck::compare
