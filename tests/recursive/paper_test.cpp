// The sweep gives the same result as the paper's loop.
#include "recursive/paper.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/formula/reactions.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

TEST(Paper, TheSweepIsItsLoopOnEveryScene) {
    constexpr int N = 30;
    double worst = 0;
    int compared = 0;
    std::string where;
    for (const auto& name : support::small_scene_names()) {
        for (const auto& [model, branch] : one_ways(compile(support::scene(name)))) {
            // The paper's loop starts at the design position.
            if (std::ranges::any_of(branch.drivers, [](const Driver& d) { return d.start != 0; }))
                continue;
            ++compared;
            const auto idle = idle_bodies(model, diagnose(model));
            const auto sweep = solve(model, branch, {.steps = N});
            const auto loop = paper(model, branch, N);
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

}  // namespace
}  // namespace elastocheck::recursive
