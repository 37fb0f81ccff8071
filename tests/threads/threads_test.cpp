// Independent solves of one model from several threads: each the same, bit by bit, as when it runs alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <latch>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "models/branch.hpp"
#include "recursive/linear_response.hpp"
#include "reference/energy/linear_response.hpp"
#include "reference/equilibrium/linear_response.hpp"

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

Bits bits(const Response& response) {
    Bits all{static_cast<std::uint64_t>(response.outcome),
             std::hash<std::string>{}(response.detail)};
    for (const auto& answer : response.increments)
        for (const Increment& increment : answer)
            for (const auto& v : {increment.dr, increment.dpi})
                for (const double number : v) all.push_back(std::bit_cast<std::uint64_t>(number));
    return all;
}

// How the states of a path answer a force on the first body, by `respond` of a leg.
template <class Respond>
Bits answers(const EquilibriumPath& path, Respond linear_response) {
    const std::vector<Disturbance> push{UnitWrench{{0, {0.1, 0.2, 0.3}}, {1, 2, 3}, {0, 0, 1}}};
    Bits all = bits(path);
    for (const Equilibrium& point : path.points) {
        const Bits one = bits(linear_response(point, push));
        all.insert(all.end(), one.begin(), one.end());
    }
    return all;
}

// A solve: along the k-th one-way branch of the model it is given, which all threads share; all that it says, as bits.
using Solve = std::function<Bits(const Model&, const Branch&)>;

// The branches of the scene by `solve`, one after the other in each thread; all threads start at once, each
// with another branch, so that they are in each other's way as much as they can be.
void expect_undisturbed(const char* scene, const Solve& solve) {
    const Model model = compile(read_scene(std::string(ELASTOCHECK_SCENES "/") + scene));
    std::vector<Model> models;
    std::vector<Bits> alone;
    for (const Branch& branch : model.branches)
        for (const Branch& way : branch_sides(branch)) models.push_back(on_branch(model, way));
    for (const Model& each : models) alone.push_back(solve(each, each.branches.front()));

    std::vector<std::vector<Bits>> together(threads, std::vector<Bits>(models.size()));
    std::latch start(threads);
    {
        std::vector<std::jthread> running;
        for (std::size_t t = 0; t < threads; ++t)
            running.emplace_back([&, t] {
                start.arrive_and_wait();
                for (std::size_t k = 0; k < models.size(); ++k) {
                    const std::size_t way = (k + t) % models.size();
                    together[t][way] = solve(models[way], models[way].branches.front());
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

TEST(Threads, MethodsOfTheRecursionDoNotDependOnOtherThreads) {
    for (const recursive::Method& method : recursive::methods)
        for (const char* scene : {"chrono_mcpherson_preload.yaml", "two_spring_arch.yaml"}) {
            SCOPED_TRACE(std::string(method.name));
            expect_undisturbed(scene, [&](const Model& model, const Branch& branch) {
                const auto path = recursive::solve(model, branch, {.method = method, .steps = 20});
                return answers(
                    path, [&](const Equilibrium& state, std::span<const Disturbance> push) {
                        return recursive::linear_response(model, branch, state, push, method);
                    });
            });
        }
}

TEST(Threads, EquilibriumLegDoesNotDependOnOtherThreads) {
    for (const char* scene : {"chrono_mcpherson_preload.yaml", "two_spring_arch.yaml"})
        expect_undisturbed(scene, [](const Model& model, const Branch& branch) {
            const auto path = reference::equilibrium::solve(model, branch, loads(branch));
            return answers(path, [&](const Equilibrium& state, std::span<const Disturbance> push) {
                return reference::equilibrium::linear_response(model, branch, state, push);
            });
        });
}

TEST(Threads, EnergyLegDoesNotDependOnOtherThreads) {
    for (const char* scene : {"chrono_mcpherson_preload.yaml", "two_spring_arch.yaml"})
        expect_undisturbed(scene, [](const Model& model, const Branch& branch) {
            const auto path = reference::energy::solve(model, branch, loads(branch));
            return answers(path, [&](const Equilibrium& state, std::span<const Disturbance> push) {
                return reference::energy::linear_response(model, branch, state, push);
            });
        });
}

// A comparison runs all legs, their responses at the wheels, and the residuals of each leg for the others' states.
TEST(Threads, ComparisonDoesNotDependOnOtherThreads) {
    expect_undisturbed("chrono_mcpherson_travel.yaml", [](const Model& model, const Branch&) {
        compare::Options few;
        few.recursion.steps = 4;
        const auto all = compare::compare(model, few);
        Bits said;
        const auto add = [&](double number) {
            said.push_back(std::bit_cast<std::uint64_t>(number));
        };
        for (const auto& branch : all.branches)
            for (const auto& run : branch.runs) {
                for (const auto& row : run.curve.values) std::ranges::for_each(row, add);
                for (const auto& at : run.compliance)
                    for (const double number : at.centre.reshaped()) add(number);
                for (const auto& judged : run.judged) add(judged.force), add(judged.length);
            }
        return said;
    });
}

}  // namespace
}  // namespace elastocheck
