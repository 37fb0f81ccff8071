// The stepping loop allocates nothing: a run of a thousand steps asks for memory as often as one of ten. Nor
// does an expansion of the series.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "models/compile.hpp"
#include "recursive/series/expand.hpp"
#include "recursive/settle.hpp"
#include "recursive/solve.hpp"
#include "tests/recursive/walks.hpp"
#include "tests/support/scenes.hpp"

namespace {
std::atomic<long> allocations{0};
}

// Every allocation of this program passes here, operator new and Eigen's included.
extern "C" {
void* __libc_malloc(std::size_t);  // NOLINT: glibc's own
void* malloc(std::size_t size) {
    ++allocations;
    return __libc_malloc(size);
}
}

namespace elastocheck::recursive {
namespace {

TEST(Allocation, NoStepOfAnyMethodAllocates) {
    for (const char* name : {"mcpherson", "mcpherson_preload", "bushing_pair", "two_spring_arch"}) {
        const Model model = compile(support::scene(name));
        for (const auto& method : methods) {
            if (!has_steps(method)) continue;
            const auto count = [&](int steps) {
                const long before = allocations;
                const auto path =
                    solve(model, model.branches[1], {.method = method, .steps = steps, .record = 1});
                EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
                return allocations - before;
            };
            (void)count(50);
            const long few = count(50), many = count(1000);
            EXPECT_GT(few, 0) << "nothing is counted";
            EXPECT_EQ(few, many) << name << " " << method.name;
        }
    }
}

TEST(Allocation, NoExpansionOfTheSeriesAllocatesForItsCoefficients) {
    for (const auto& name : support::scene_names()) {
        const auto [model, branch] = one_ways(compile(support::scene(name))).front();
        March<double> s(model, branch, analyse(model));
        ASSERT_EQ(settle(s), Outcome::converged);
        s.applied.setZero();
        ASSERT_EQ(factorise_at(s, s.q, s.lambda), Outcome::converged);
        series::Equations e = series::equations(model, branch, 16);
        series::Coefficients c = series::reserve_coefficients(s, 16);
        const Vector<double> ahead = Vector<double>::Zero(s.n() + s.m());
        for (const bool arc_length : {false, true}) {
            const long before = allocations;
            series::expand(s, e, c, branch.to, arc_length, ahead);
            EXPECT_EQ(allocations - before, 0) << name;
            EXPECT_GT(c.x.col(1).norm(), 0) << name;
        }
    }
}

}  // namespace
}  // namespace elastocheck::recursive
