// The stepping loop and the series expansion allocate no memory.
// A run of a thousand steps has as many allocations as one of ten.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "elastocheck/compile.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/series/expand.hpp"
#include "recursive/stepping/settle.hpp"
#include "tests/recursive/elements.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace {
std::atomic<long> allocations{0};
}

// Counts every allocation of this program, including operator new and Eigen's.
extern "C" {
void* __libc_malloc(std::size_t);  // NOLINT: glibc's own
void* malloc(std::size_t size) {
    ++allocations;
    return __libc_malloc(size);
}
}

namespace elastocheck::recursive {
namespace {

// Adds a stop in parallel with every spring, gives every bushing another formulation with curves
// for a third of its axes, and adds a follower load.
Scene with_curves(Scene scene) {
    Random random;
    const auto formulations = every_formulation();
    std::size_t k = 0;
    for (auto& elastic : std::vector<Elastic>(scene.elastics))
        if (const auto* spring = std::get_if<AxialSpring>(&elastic.kind)) {
            AxialSpring bumper = *spring;
            bumper.law = stop(0.01, 2e4);
            scene.elastics.push_back({elastic.name + "_stop", bumper});
        }
    for (auto& elastic : scene.elastics)
        if (auto* bushing = std::get_if<Bushing>(&elastic.kind)) {
            const Matrix6<double> K = std::get<LinearStiffness>(bushing->law).K;
            PerAxis law;
            for (std::size_t a = 0; a < 6; ++a) {
                const double rate = K(static_cast<int>(a), static_cast<int>(a));
                law.axis[a] = LinearRate{rate};
                if (a % 3 == 0)
                    law.axis[a] = Curve{
                        {0, 1}, {{0, rate, 0, 0}, {0, rate, rate, 0}, {2 * rate, 3 * rate, 0, 0}}};
            }
            bushing->law = law;
            bushing->formulation = formulations[k++ % formulations.size()];
        }
    return scene;
}

// Points are recorded at the end only, or passed to a visitor.
TEST(Allocation, StepsOfEveryMethodRunWithoutAllocation) {
    std::vector<std::pair<std::string, Scene>> scenes;
    for (const char* name :
         {"chrono_mcpherson", "chrono_mcpherson_preload", "bushing_pair", "two_spring_arch"})
        scenes.emplace_back(name, support::scene(name));
    scenes.emplace_back("chrono_mcpherson with curves",
                        with_curves(support::scene("chrono_mcpherson")));
    for (const auto& [name, scene] : scenes) {
        const Model model = compile(scene);
        for (const auto& method : methods)
            for (const bool visits : {false, true}) {
                if (!has_steps(method)) continue;
                int visited = 0;
                const auto count = [&](int steps) {
                    visited = 0;
                    const Options options{
                        .method = method, .steps = steps, .record = visits ? 0 : 1};
                    const long before = allocations;
                    const auto path = visits ? solve(model, model.branches[1], options,
                                                     [&](const Equilibrium&) { ++visited; })
                                             : solve(model, model.branches[1], options);
                    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
                    return allocations - before;
                };
                (void)count(50);
                const long few = count(50), many = count(1000);
                EXPECT_GT(few, 0) << "nothing is counted";
                EXPECT_EQ(few, many) << name << " " << method.name;
                EXPECT_EQ(visited, visits ? 1001 : 0);
            }
    }
}

TEST(Allocation, ExpansionsOfTheSeriesReuseTheirCoefficients) {
    for (const auto& name : support::small_scene_names()) {
        const auto [model, branch] = all_sides(compile(support::scene(name))).front();
        SteppingState s(model, branch, analyse(model));
        ASSERT_EQ(settle(s), Outcome::converged);
        s.work.applied.setZero();
        ASSERT_EQ(factorise_at(s, s.q, s.lambda), Outcome::converged);
        series::Equations<double> e = series::equations<double>(model, branch, 16);
        series::Coefficients<double> c = series::reserve_coefficients<double>(s.n() + s.m(), 16);
        const Vector<double> ahead = Vector<double>::Zero(s.n() + s.m());
        for (const bool arc_length : {false, true}) {
            const long before = allocations;
            series::expand(s, e, c, {.a_1 = branch.to, .arc_length = arc_length}, ahead);
            EXPECT_EQ(allocations - before, 0) << name;
            EXPECT_GT(c.x.col(1).norm(), 0) << name;
        }
    }
}

}  // namespace
}  // namespace elastocheck::recursive
