// The ladder against closed forms, and what its choices add up to.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>

#include "models/compile.hpp"
#include "recursive/diagnosis.hpp"
#include "recursive/solve.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::Vector3d;

Method rung(const char* name) { return *find_method(name); }

// x in [low, high] with f(x) = y, f rising, to the last bit.
double inverse(const std::function<double(double)>& f, double y, double low, double high) {
    for (int k = 0; k < 200; ++k) {
        const double middle = (low + high) / 2;
        (f(middle) < y ? low : high) = middle;
    }
    return (low + high) / 2;
}

// Where the first probe is at the load F: the solutions in the comments of the scenes, in metres.
struct ClosedForm {
    const char* scene;
    Vector3d (*probe)(double F);
    double published_order;  // to the truth: 1 where what the sum forgets to turn happens to be nothing
};

const ClosedForm curved[] = {
    {"pinned_bar",
     [](double F) -> Vector3d {
         const double k = 20e3, L = 0.5, theta = std::atan(F / (k * L));
         return {L * std::cos(theta), 0, L * std::sin(theta)};
     },
     0},
    {"pendulum",
     [](double F) -> Vector3d {
         const double k_R = 600, L = 0.4;
         const double theta = inverse([&](double t) { return k_R * t / (L * std::cos(t)); }, F, -1.5, 1.5);
         return {0.8 * L * std::cos(theta), 0.6 * L * std::cos(theta), L * std::sin(theta)};
     },
     1},
    {"bushing_pair",
     [](double F) -> Vector3d {
         const double a = 0.15, e = 0.25, k = 2e5, k_R = 500;
         const double theta = inverse(
             [&](double t) { return (2 * k * a * a * std::sin(t) + 2 * k_R * t) / (e * std::cos(t)); }, F,
             -1.5, 1.5);
         return {e * std::cos(theta), 0, F / (2 * k) + e * std::sin(theta)};
     },
     0},
    {"two_spring_arch",
     [](double F) -> Vector3d {
         const double b = 0.3, h = 0.08, k = 100e3, l_0 = std::hypot(b, h);
         const double limit = std::sqrt(std::pow(l_0 * b * b, 2.0 / 3) - b * b);
         return {0, 0,
                 inverse([&](double z) { return 2 * k * (std::hypot(b, z) - l_0) * z / std::hypot(b, z); }, F,
                         limit, 1)};
     },
     0},
};

const ClosedForm straight[] = {
    // nothing turns
    {"parallel_springs",
     [](double F) -> Vector3d {
         return {0, 0, 0.4 + F / 75e3};
     },
     0},
    {"single_bushing",
     [](double F) -> Vector3d {
         return Vector3d(0.1, 0.2, 0.3) + F * Vector3d(0.6 / 2e5, 0.48 / 3e5, 0.64 / 5e5);
     },
     0},
};

// Largest distance of the first probe from the closed form over the recorded points [m].
double error(const Model& model, const ClosedForm& truth, const EquilibriumPath& path) {
    double worst = path.points.empty() ? NAN : 0;
    const Point& at = model.probes[0].at;
    for (const auto& point : path.points) {
        const Pose& pose = point.poses[static_cast<std::size_t>(at.body)];
        const double distance = (pose.r + pose.p * at.s_local - truth.probe(point.load)).norm();
        if (!(distance <= worst)) worst = distance;
    }
    return worst;
}

// Largest distance of any body's origin [m], or turn of a body without an idle mode [rad], over the recorded
// points.
double apart(const Model& model, const EquilibriumPath& a, const EquilibriumPath& b) {
    EXPECT_EQ(a.points.size(), b.points.size());
    std::vector<bool> idle(model.bodies.size(), false);
    for (const auto& mode : diagnose(model).idle) idle[static_cast<std::size_t>(mode.body)] = true;
    double worst = 0;
    for (std::size_t k = 0; k < std::min(a.points.size(), b.points.size()); ++k)
        for (std::size_t body = 0; body < idle.size(); ++body) {
            const Pose &in_a = a.points[k].poses[body], &in_b = b.points[k].poses[body];
            worst =
                std::max({worst, (in_a.r - in_b.r).norm(), idle[body] ? 0 : in_a.p.angularDistance(in_b.p)});
        }
    return worst;
}

TEST(Ladder, EachRungHasItsOrderToTheClosedForm) {
    for (const auto& truth : curved) {
        const Model model = compile(support::scene(truth.scene));
        for (const auto& branch : model.branches)
            for (const auto& method : methods) {
                if (method.adaptive) continue;
                const double formal = method.formal_order == 0 ? truth.published_order : method.formal_order;
                const auto at = [&](int steps) {
                    const auto path = solve(model, branch, {.method = method, .steps = steps, .record = 10});
                    EXPECT_EQ(path.outcome, Outcome::converged)
                        << truth.scene << " " << method.name << ": " << path.detail;
                    return error(model, truth, path);
                };
                // Doubled until the leading term leads or round-off is near.
                double coarse = at(250), order = NAN;
                int steps = 500;
                for (; steps <= 8000; steps *= 2) {
                    const double fine = at(steps);
                    if (fine < 1e-12) break;
                    order = std::log2(coarse / fine);
                    coarse = fine;
                    if (std::abs(order - formal) <= 0.02) break;
                }
                fmt::print("{} {} {}: order {:.3f} at {} steps, error {:.3g}\n", truth.scene, branch.name,
                           method.name, order, steps, coarse);
                EXPECT_NEAR(order, formal, 0.1)
                    << truth.scene << " " << branch.name << " " << method.name << ": " << coarse;
            }
    }
}

TEST(Ladder, WhereNothingTurnsOneStepIsExact) {
    for (const auto& truth : straight) {
        const Model model = compile(support::scene(truth.scene));
        for (const auto& branch : model.branches)
            for (const auto& method : methods)
                for (const int steps : {1, 7}) {
                    const auto path = solve(model, branch, {.method = method, .steps = steps});
                    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
                    const double off = error(model, truth, path);
                    EXPECT_TRUE(std::isfinite(off) && off <= 1e-14)
                        << truth.scene << " " << method.name << " " << off;
                }
    }
}

TEST(Ladder, AdaptiveKeepsItsToleranceToTheClosedForm) {
    for (const auto& truth : curved) {
        const Model model = compile(support::scene(truth.scene));
        for (const auto& branch : model.branches)
            for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
                // 137 points: nearly all between its steps.
                const auto path = solve(model, branch,
                                        {.method = rung("adaptive"),
                                         .steps = 137,
                                         .length_tolerance = tolerance,
                                         .angle_tolerance = tolerance});
                ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
                const double off = error(model, truth, path);
                EXPECT_TRUE(std::isfinite(off) && off <= tolerance)
                    << truth.scene << " " << branch.name << ": " << off << " of " << tolerance;
            }
    }
}

TEST(Ladder, AdaptiveAtItsFinestAndChordAtManyStepsAgree) {
    for (const char* name : {"mcpherson", "mcpherson_preload"}) {
        const Model model = compile(support::scene(name));
        for (const auto& branch : model.branches) {
            const auto chord = solve(model, branch, {.method = rung("chord"), .steps = 13700, .record = 137});
            for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
                const auto adaptive = solve(model, branch,
                                            {.method = rung("adaptive"),
                                             .steps = 137,
                                             .length_tolerance = tolerance,
                                             .angle_tolerance = tolerance});
                ASSERT_EQ(adaptive.outcome, Outcome::converged) << adaptive.detail;
                const double off = apart(model, adaptive, chord);
                EXPECT_LE(off, tolerance) << name << " " << branch.name;
            }
        }
    }
}

TEST(Ladder, WhereAdaptiveStepsDoesNotDependOnWhatIsRecorded) {
    for (const auto& name : support::scene_names()) {
        const Model model = compile(support::scene(name));
        for (const auto& branch : model.branches) {
            const auto all = solve(model, branch, {.method = rung("adaptive"), .steps = 120}),
                       some = solve(model, branch, {.method = rung("adaptive"), .steps = 120, .record = 8});
            ASSERT_EQ(some.points.size(), 9u);
            EXPECT_EQ(all.counts.factorisations, some.counts.factorisations);
            for (std::size_t k = 0; k < 9; ++k)
                for (std::size_t b = 0; b < model.bodies.size(); ++b)
                    EXPECT_LE((all.points[15 * k].poses[b].r - some.points[k].poses[b].r).norm(), 1e-15)
                        << name << " " << k;
        }
    }
}

TEST(Ladder, ClosingMakesTheConstraintErrorFallTwiceAsFast) {
    for (const char* name : {"pinned_bar", "pendulum", "mcpherson", "mcpherson_preload"}) {
        const Model model = compile(support::scene(name));
        for (const auto& branch : model.branches)
            for (const auto& [method, order] : {std::pair{"published", 1}, {"closed", 2}, {"balanced", 2}}) {
                const auto Phi = [&](int steps) {
                    return solve(model, branch, {.method = rung(method), .steps = steps, .record = 1})
                        .points.back()
                        .constraint_error;
                };
                EXPECT_NEAR(std::log2(Phi(1000) / Phi(2000)), order, 0.05)
                    << name << " " << branch.name << " " << method;
            }
    }
}

std::vector<Method> all_follows() {
    std::vector<Method> all;
    for (unsigned k = 0; k < 8; ++k) {
        Method method;
        method.follow = {.lever = (k & 1) != 0, .axis = (k & 2) != 0, .load = (k & 4) != 0};
        all.push_back(method);
    }
    return all;
}

TEST(Follow, EveryCombinationConvergesToALimitOfItsOwn) {
    for (const char* name : {"mcpherson", "bushing_pair"}) {
        const Model model = compile(support::scene(name));
        for (const auto& branch : model.branches)
            for (const auto& method : all_follows()) {
                std::vector<EquilibriumPath> paths;
                for (const int steps : {500, 1000, 2000}) {
                    paths.push_back(solve(model, branch, {.method = method, .steps = steps, .record = 10}));
                    ASSERT_EQ(paths.back().outcome, Outcome::converged)
                        << name << ": " << paths.back().detail;
                }
                const double coarse = apart(model, paths[0], paths[1]),
                             fine = apart(model, paths[1], paths[2]);
                EXPECT_NEAR(std::log2(coarse / fine), 1, 0.1)
                    << name << " " << branch.name << ": lever " << method.follow.lever << " axis "
                    << method.follow.axis << " load " << method.follow.load << ": " << coarse << " " << fine;
            }
    }
}

TEST(Follow, EverythingTogetherReachesTheTruthAtFirstOrder) {
    for (const char* name : {"mcpherson", "bushing_pair"}) {
        const Model model = compile(support::scene(name));
        Method method;
        method.follow = everything;
        for (const auto& branch : model.branches) {
            const auto truth = solve(model, branch, {.method = rung("chord"), .steps = 12000, .record = 10});
            const auto off = [&](int steps) {
                return apart(model, solve(model, branch, {.method = method, .steps = steps, .record = 10}),
                             truth);
            };
            EXPECT_NEAR(std::log2(off(1000) / off(2000)), 1, 0.05) << name << " " << branch.name;
        }
    }
}

TEST(Follow, ALoadWithoutALeverCannotStayBehind) {
    for (const char* name : {"mcpherson", "mcpherson_preload", "two_spring_arch"}) {
        const Model model = compile(support::scene(name));
        Method stays;
        stays.follow.load = false;
        for (const auto& branch : model.branches) {
            const auto published = solve(model, branch, {.steps = 100}),
                       behind = solve(model, branch, {.method = stays, .steps = 100});
            EXPECT_LE(apart(model, published, behind), 1e-10) << name;
        }
    }
    const Model model = compile(support::scene("bushing_pair"));  // here the load has a lever
    Method stays;
    stays.follow.load = false;
    EXPECT_GT(apart(model, solve(model, model.branches[0], {.steps = 100}),
                    solve(model, model.branches[0], {.method = stays, .steps = 100})),
              1e-3);
}

// What is wrong with a converged path, by the worst recorded point after the first: its distance from the
// truth as a share of how far anything has moved by then.
TEST(Ladder, FewStepsAreNoWorseThanAFewTimesThePublishedOnes) {
    for (const auto& name : support::scene_names()) {
        const Model model = compile(support::scene(name));
        for (const auto& branch : model.branches) {
            const auto truth = solve(model, branch, {.method = rung("chord"), .steps = 6000, .record = 1});
            ASSERT_EQ(truth.outcome, Outcome::converged);
            for (const int steps : {1, 2, 3, 5, 10}) {
                const auto at = [&](const Method& method) {
                    return solve(model, branch, {.method = method, .steps = steps, .record = 1});
                };
                const auto published = at(rung("published"));
                const double bound =
                    published.outcome == Outcome::converged ? apart(model, published, truth) : NAN;
                for (const auto& method : methods) {
                    const auto path = at(method);
                    if (path.outcome != Outcome::converged) {
                        fmt::print("{} {} {} {}: {}\n", name, branch.name, method.name, steps, path.detail);
                        EXPECT_FALSE(path.detail.empty());
                        continue;
                    }
                    const double off = apart(model, path, truth);
                    if (!(off <= 2 * bound + 1e-9))
                        fmt::print("{} {} {} {}: {:.3g} published {:.3g}\n", name, branch.name, method.name,
                                   steps, off, bound);
                }
            }
        }
    }
}

TEST(Ladder, OrdersDoNotDependOnTheArithmeticUntilRoundOff) {
    const ClosedForm& truth = curved[2];
    const Model model = compile(support::scene(truth.scene));
    for (const char* name : {"balanced", "tangent", "chord", "midpoint"}) {
        const Method method = rung(name);
        const auto off = [&](Precision precision, int steps) {
            return error(model, truth,
                         solve(model, model.branches[0],
                               {.method = method, .steps = steps, .record = 5, .precision = precision}));
        };
        const int steps = method.formal_order == 3 ? 10 : 20;
        const double single = off(Precision::single, steps), twofold = off(Precision::twofold, steps),
                     extended = off(Precision::extended, steps);
        EXPECT_NEAR(single / extended, 1, 0.05) << name;
        EXPECT_NEAR(twofold / extended, 1, 1e-6) << name;
    }
}

TEST(Ladder, LongDoubleLosesLessThanDoubleLosesLessThanFloat) {
    // What 20 000 additions round away, against the same steps in long double; and what that leaves of the
    // constraints.
    for (const char* name : {"bushing_pair", "mcpherson"}) {
        const Model model = compile(support::scene(name));
        const auto at = [&](Precision precision) {
            return solve(model, model.branches[0], {.steps = 20000, .record = 1, .precision = precision});
        };
        const auto single = at(Precision::single), twofold = at(Precision::twofold),
                   extended = at(Precision::extended);
        EXPECT_LE(apart(model, twofold, extended), 1e-9) << name;
        EXPECT_GE(apart(model, single, extended), 1e3 * apart(model, twofold, extended)) << name;
    }
}

TEST(Ladder, EveryRungGivesTheSameBitsEachTime) {
    const auto same = [](const auto& a, const auto& b) {
        return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
    };
    for (const auto& name : support::scene_names()) {
        const Model model = compile(support::scene(name));
        for (const auto& branch : model.branches)
            for (const auto& method : methods) {
                const auto a = solve(model, branch, {.method = method, .steps = 30}),
                           b = solve(model, branch, {.method = method, .steps = 30});
                ASSERT_EQ(a.outcome, b.outcome);
                ASSERT_EQ(a.points.size(), b.points.size());
                bool equal = true;
                for (std::size_t k = 0; k < a.points.size(); ++k) {
                    for (std::size_t body = 0; body < model.bodies.size(); ++body)
                        equal = equal && same(a.points[k].poses[body].r, b.points[k].poses[body].r) &&
                                same(a.points[k].poses[body].p.coeffs(), b.points[k].poses[body].p.coeffs());
                    for (std::size_t joint = 0; joint < model.joints.size(); ++joint)
                        equal =
                            equal &&
                            same(a.points[k].reactions[joint].force, b.points[k].reactions[joint].force) &&
                            same(a.points[k].reactions[joint].moment, b.points[k].reactions[joint].moment);
                }
                EXPECT_TRUE(equal) << name << " " << branch.name << " " << method.name;
            }
    }
}

}  // namespace
}  // namespace elastocheck::recursive
