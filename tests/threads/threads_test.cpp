// Independent solves of one model from several threads: each the same, bit by bit, as when it runs alone.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <latch>
#include <string>
#include <thread>
#include <vector>

#include "models/branch.hpp"
#include "models/compile.hpp"
#include "models/reader/scene_file.hpp"
#include "recursive/solve.hpp"
#include "reference/energy/solve.hpp"
#include "reference/equilibrium/solve.hpp"

namespace elastocheck {
namespace {

constexpr int threads = 4;

using Bits = std::vector<std::uint64_t>;

// Everything a path says, as bits: NaN equals itself, and 0 is not -0.
Bits bits(const EquilibriumPath& path) {
    Bits all{static_cast<std::uint64_t>(path.outcome), std::hash<std::string>{}(path.detail)};
    const auto add = [&](const auto& numbers) {
        for (const double number : numbers) all.push_back(std::bit_cast<std::uint64_t>(number));
    };
    for (const Equilibrium& point : path.points) {
        add(std::vector{point.load, point.constraint_error});
        for (const Pose& pose : point.poses) add(pose.r), add(pose.p.coeffs());
        for (const Wrench& wrench : point.reactions) add(wrench.force), add(wrench.moment);
    }
    return all;
}

// A solve: along the k-th one-way branch of the model it is given, which all threads share.
using Solve = std::function<EquilibriumPath(const Model&, const Branch&)>;

// The branches of the scene by `solve`, one after the other in each thread; all threads start at once, each
// with another branch, so that they are in each other's way as much as they can be.
void expect_undisturbed(const char* scene, const Solve& solve) {
    const Model model = compile(read_scene(std::string(ELASTOCHECK_SCENES "/") + scene));
    std::vector<Model> models;
    std::vector<Bits> alone;
    for (const Branch& branch : model.branches)
        for (const Branch& way : ways(branch)) models.push_back(on_branch(model, way));
    for (const Model& each : models) alone.push_back(bits(solve(each, each.branches.front())));

    std::vector<std::vector<Bits>> together(threads, std::vector<Bits>(models.size()));
    std::latch start(threads);
    {
        std::vector<std::jthread> running;
        for (std::size_t t = 0; t < threads; ++t)
            running.emplace_back([&, t] {
                start.arrive_and_wait();
                for (std::size_t k = 0; k < models.size(); ++k) {
                    const std::size_t way = (k + t) % models.size();
                    together[t][way] = bits(solve(models[way], models[way].branches.front()));
                }
            });
    }
    for (std::size_t t = 0; t < threads; ++t)
        for (std::size_t way = 0; way < models.size(); ++way) {
            EXPECT_GT(alone[way].size(), 50u) << scene;  // several points
            EXPECT_TRUE(together[t][way] == alone[way])
                << scene << ", branch " << models[way].branches.front().name << ", thread " << t;
        }
}

std::vector<double> loads(const Branch& branch) {
    std::vector<double> all;
    for (int k = 0; k <= 4; ++k) all.push_back(branch.to * k / 4);
    return all;
}

TEST(Threads, EveryMethodOfTheRecursionIsUndisturbed) {
    for (const recursive::Method& method : recursive::methods)
        for (const char* scene : {"chrono_mcpherson_preload.yaml", "two_spring_arch.yaml"}) {
            SCOPED_TRACE(std::string(method.name));
            expect_undisturbed(scene, [&](const Model& model, const Branch& branch) {
                return recursive::solve(model, branch, {.method = method, .steps = 20});
            });
        }
}

TEST(Threads, TheEquilibriumLegIsUndisturbed) {
    for (const char* scene : {"chrono_mcpherson_preload.yaml", "two_spring_arch.yaml"})
        expect_undisturbed(scene, [](const Model& model, const Branch& branch) {
            return reference::equilibrium::solve(model, branch, loads(branch));
        });
}

TEST(Threads, TheEnergyLegIsUndisturbed) {
    for (const char* scene : {"chrono_mcpherson_preload.yaml", "two_spring_arch.yaml"})
        expect_undisturbed(scene, [](const Model& model, const Branch& branch) {
            return reference::energy::solve(model, branch, loads(branch));
        });
}

}  // namespace
}  // namespace elastocheck
