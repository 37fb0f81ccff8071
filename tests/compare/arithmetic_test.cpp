// Robustness against floating-point arithmetic: rounding modes, flush-to-zero, inputs changed by
// one ulp, and NaN in every input. A converged result must still be correct.
#include "compare/stress/arithmetic.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "compare/stress/stress.hpp"
#include "compare/stress/transforms.hpp"
#include "elastocheck/compile.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

// A single bushing: all its points coincide, and a rounding difference between them is no length.
constexpr std::array scene_list{"mcpherson", "pendulum", "arch_driven", "parallel_springs",
                                "single_bushing"};
constexpr std::array others{Arithmetic::up, Arithmetic::down, Arithmetic::towards_zero,
                            Arithmetic::flushed};

Scene small(const std::string& name) {
    Scene scene = support::scene(name);
    scene.branches.resize(1);
    scene.branches.front().steps = 20;
    return scene;
}

// The unchanged scene, and all variants of the sweep.
std::vector<Trial> requested(const std::string& name) {
    std::vector<Sweep> both;
    for (const auto& sweep : sweeps())
        if (sweep.name == as_it_is || sweep.name == "arithmetic") both.push_back(sweep);
    return trials(name, small(name), both);
}

std::string told(const StressCell& cell) {
    return fmt::format("{}, {}, {}, {}: {} {} {}", cell.scene, cell.variant, cell.side, cell.solver,
                       name(cell.verdict), cell.why, cell.detail);
}

// 1/3 computed at run time.
double third() {
    const volatile double one = 1, three = 3;
    return one / three;
}
double half_of_the_least() {
    const volatile double least = std::numeric_limits<double>::min(), half = 0.5;
    const volatile double product = least * half;
    return product;
}

TEST(Arithmetic, IsInForceWhileItIsAskedForAndNoLonger) {
    const double nearest = third();
    for (const Arithmetic how : others) {
        try {
            const WithArithmetic in_force(how);
            EXPECT_EQ(third() > nearest, how == Arithmetic::up) << name(how);
            EXPECT_EQ(half_of_the_least() == 0, how == Arithmetic::flushed && exists(how))
                << name(how);
            throw std::runtime_error("whoever solves may throw");
        } catch (const std::runtime_error&) {
        }
        EXPECT_EQ(third(), nearest) << name(how);
        EXPECT_GT(half_of_the_least(), 0) << name(how);
    }
    // 1/3 lies above its nearest double: -1/3 distinguishes rounding down from rounding towards
    // zero.
    const auto minus_third = [](Arithmetic how) {
        const WithArithmetic in_force(how);
        const volatile double minus = -1, three = 3;
        const volatile double quotient = minus / three;
        return quotient;
    };
    EXPECT_LT(minus_third(Arithmetic::down), minus_third(Arithmetic::towards_zero));
    EXPECT_EQ(minus_third(Arithmetic::up), minus_third(Arithmetic::towards_zero));
}

// No solver is wrong or fails because of rounding.
TEST(Arithmetic, WhateverItIsWhoConvergesIsStillRight) {
    for (const auto& scene : scene_list) {
        const Survival survival = stress(requested(scene));
        const auto converged_as_drawn = [&](const StressCell& cell) {
            return std::ranges::any_of(survival.cells, [&](const StressCell& one) {
                return one.sweep == as_it_is && one.side == cell.side &&
                       one.solver == cell.solver && one.outcome == Outcome::converged;
            });
        };
        std::set<std::string> variants;
        for (const auto& cell : survival.cells) {
            EXPECT_NE(cell.verdict, CellVerdict::wrong) << told(cell);
            if (cell.sweep == as_it_is) continue;
            variants.insert(cell.variant);
            if (converged_as_drawn(cell)) {
                EXPECT_EQ(cell.outcome, Outcome::converged) << told(cell);
            }
            if (cell.outcome != Outcome::converged) continue;
            EXPECT_TRUE(std::isfinite(cell.apart)) << told(cell);
            if (cell.solver == "equilibrium" || cell.solver == "energy" ||
                cell.solver == "series") {
                EXPECT_GE(cell.digits, 8) << told(cell);
            }
        }
        EXPECT_EQ(variants.size(), exists(Arithmetic::flushed) ? 5u : 4u);
    }
}

// Some digit differs for every solver; otherwise the arithmetic was not active during the solve.
TEST(Arithmetic, ReachesEverySolver) {
    const Survival survival = stress(requested("mcpherson"));
    for (const auto& solver : survival.solvers) {
        bool differs = false;
        for (const auto& cell : survival.cells)
            if (cell.solver == solver && cell.variant == name(Arithmetic::up))
                differs |= cell.apart > 0;
        EXPECT_TRUE(differs) << solver;
    }
}

TEST(Arithmetic, EveryNumberIsAnUlpOffAndNoFurther) {
    Scene before = support::scene("double_wishbone"), after = an_ulp_off(before);
    std::vector<double> a, b;
    for_each_number(before, [&](double& x) { a.push_back(x); });
    for_each_number(after, [&](double& x) { b.push_back(x); });
    ASSERT_EQ(a.size(), b.size());
    EXPECT_GT(a.size(), 400u);
    int up = 0, down = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (a[k] == 0) {
            EXPECT_EQ(b[k], 0);
            continue;
        }
        ++(b[k] > a[k] ? up : down);
        EXPECT_EQ(b[k], std::nextafter(a[k], b[k])) << k;
        EXPECT_NE(b[k], a[k]) << k;
    }
    EXPECT_GT(up, 50);
    EXPECT_GT(down, 50);
}

// Over all sides of the first branch: the first outcome that is not converged, and the end of the
// last side.
struct Answer {
    Outcome outcome = Outcome::converged;
    std::vector<Pose> poses;
};

// Each number of the scene in turn is NaN, also of its geometry: it has no effect, or the outcome
// reports it.
TEST(Arithmetic, ANumberThatIsNoneDoesNotMatterOrIsAnHonestOutcome) {
    for (const char* name : {"mcpherson", "tyre_on_road"}) {
        const Scene scene = small(name);
        const auto found = [&](const Scene& made) {
            std::vector<Answer> all;
            const Model model = compile(made);
            for (const auto& solver : solvers()) {
                Answer& answer = all.emplace_back();
                SolverSettings settings = solver.settings;
                settings.every = 4;
                for (const auto& side : sides_of(model, model.branches.front(), 4)) {
                    const auto path = walk(side, settings, [&](const Equilibrium& state) {
                        answer.poses = state.poses;
                    });
                    if (answer.outcome == Outcome::converged) answer.outcome = path.outcome;
                }
            }
            return all;
        };
        const auto expected = found(scene);
        int count = 0;
        Scene counted = scene;
        for_each_number(counted, [&](double&) { ++count; });
        for (const double none :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
            for (int at = 0; at < count; ++at) {
                Scene poisoned = scene;
                for_each_number(poisoned, [&, k = 0](double& x) mutable {
                    if (k++ == at) x = none;
                });
                const auto now = found(poisoned);
                for (std::size_t s = 0; s < now.size(); ++s) {
                    if (now[s].outcome != Outcome::converged) continue;
                    ASSERT_EQ(now[s].poses.size(), expected[s].poses.size());
                    for (std::size_t b = 0; b < now[s].poses.size(); ++b)
                        EXPECT_LE((now[s].poses[b].r - expected[s].poses[b].r).norm(), 1e-12)
                            << name << ", number " << at << " of " << count << ", "
                            << solvers()[s].name;
                }
            }
    }
}

}  // namespace
}  // namespace elastocheck::compare
