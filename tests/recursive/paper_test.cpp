// The sweep gives the same result as the paper's loop, whose error ends at round-off.
#include "recursive/paper.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/formula/reactions.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

TEST(Paper, PublishedMethodEqualsThePapersLoopOnEveryScene) {
    constexpr int N = 30;
    double worst = 0;
    int compared = 0;
    std::string where;
    for (const auto& name : support::small_scene_names()) {
        for (const auto& [model, branch] : all_sides(compile(support::scene(name)))) {
            // The paper's loop starts at the design position.
            if (std::ranges::any_of(branch.drivers, [](const Driver& d) { return d.start != 0; }))
                continue;
            ++compared;
            const auto idle = idle_bodies(model, diagnose(model));
            const auto sweep = solve(model, branch, {.steps = N});
            const auto loop = paper<double>(model, branch, N);
            ASSERT_EQ(sweep.points.size(), loop.size()) << name << ": " << sweep.detail;
            for (std::size_t k = 0; k < loop.size(); ++k)
                for (std::size_t b = 0; b < model.bodies.size(); ++b) {
                    const auto& body = loop[k].q[static_cast<BodyId>(b)];
                    const Pose& pose = sweep.points[k].poses[b];
                    const double apart = idle[b] ? 0
                                                 : std::max((pose.r - body.r).norm(),
                                                            pose.p.angularDistance(body.p));
                    if (apart > worst) {
                        worst = apart;
                        where = fmt::format("{} {} point {} body {}", name, branch.name, k, b);
                    }
                }
            // Compares λ as wrenches in newtons.
            std::vector<Wrench> wrenches(model.joints.size());
            const double a = branch.to * (N - 1) / N;
            (void)joint_wrenches<double>(model, inputs_at<double>(model, branch, a), loop[N - 1].q,
                                         loop[N].lambda, wrenches);
            for (std::size_t j = 0; j < wrenches.size(); ++j)
                EXPECT_LE((wrenches[j].force - sweep.points[N].reactions[j].force).norm(), 1e-6)
                    << name << " " << model.joints[j].name;
        }
    }
    EXPECT_LE(worst, 1e-10) << where;
    EXPECT_GE(compared, 20);
}

// |Φ| at the end, eq. (31), in the arithmetic itself [m].
template <class Real>
double end_error(const Model& model, const Branch& branch, int N) {
    const Inputs<Real> inputs = inputs_at<Real>(model, branch, static_cast<Real>(branch.to));
    const State<Real> q = paper<Real>(model, branch, N).back().q;
    Real sum = 0;
    for_each_row<Real>(model, inputs, q,
                       [&](int, const Row<Real>& row) { sum += row.Phi * row.Phi; });
    return static_cast<double>(std::sqrt(sum));
}

TEST(Paper, ConvergenceEndsAtRoundOffInFloatAndContinuesInLongDouble) {
    const Model model = compile(support::scene("mcpherson"));
    const Branch& branch = model.branches[0];
    double least = 1, last = 0, before = 0;
    for (int N = 40; N <= 10240; N *= 4) {
        const double extended = end_error<long double>(model, branch, N);
        if (before > 0) {
            EXPECT_NEAR(before / extended, 4, 0.1) << N;  // order one, down to 1e-6 m
        }
        before = extended;
        last = end_error<float>(model, branch, N);
        least = std::min(least, last);
    }
    EXPECT_NEAR(least, 4e-6, 1e-6);  // at 2560 steps: the floor that recursive/README.md states
    EXPECT_GT(last, 5 * least);      // more steps make it worse
}

}  // namespace
}  // namespace elastocheck::recursive
