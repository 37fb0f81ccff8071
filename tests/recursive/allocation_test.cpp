// The stepping loop allocates nothing: a run of a thousand steps asks for memory as often as one of ten.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "models/compile.hpp"
#include "recursive/solve.hpp"
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

}  // namespace
}  // namespace elastocheck::recursive
