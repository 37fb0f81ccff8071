// Speed of the recursion, as ratios within one process.
//
//   bare      600 × PartialPivLU factor + solve of a dense 27×27 matrix, what the paper's method cannot do
//             without
//   sweep     the paper's example, 2 × 300 steps, by every rung; the ratio to `bare`
//   points    the same 2 × 301 output points by `adaptive`, `series` and both references; the ratio to the
//             equilibrium leg
//   branches  both branches by `series`, as polynomials; the ratio to the published sweep
//
//   sweep: the paper's example, 2 × 300 steps, by every rung; the ratio to `bare`.
//
//   points: the same 2 × 301 output points by `adaptive`, `series` and both references; the ratio to the
//   equilibrium leg.
//
//   branches: both branches by `series`, as polynomials; the ratio to the published sweep.
//
//   analysis: what is told of the model once (analysis.hpp); the ratio to the published sweep. All of the
//   above that the recursive leg does has it given.
//
// The counter `ratio` is measured against its base in turns, sweep by sweep, so that a slow moment slows
// both.
#include <benchmark/benchmark.h>

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <functional>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/series/path.hpp"
#include "tests/support/scenes.hpp"

namespace {

using namespace elastocheck;
using Clock = std::chrono::steady_clock;

const Model& mcpherson() {
    static const Model model = compile(support::scene("chrono_mcpherson"));
    return model;
}

// Told once for the model, as the sweeps, the branches and the points all use it.
const recursive::Analysis& analysis() {
    static const recursive::Analysis analysis = recursive::analyse(mcpherson());
    return analysis;
}

void bare() {
    static Eigen::MatrixXd A =
        Eigen::MatrixXd::Random(27, 27) + 27 * Eigen::MatrixXd::Identity(27, 27);
    static Eigen::VectorXd b = Eigen::VectorXd::Random(27), x(27);
    static Eigen::PartialPivLU<Eigen::MatrixXd> lu(27);
    for (int k = 0; k < 600; ++k) {
        A(k % 27, 0) += 1e-12;
        lu.compute(A);
        x = lu.solve(b);
        benchmark::DoNotOptimize(x.data());
    }
}

void sweep(const recursive::Method& method) {
    for (const auto& branch : mcpherson().branches)
        benchmark::DoNotOptimize(recursive::solve(
            mcpherson(), branch, {.method = method, .steps = 300, .record = 1}, analysis()));
}

template <class Solve>
void points(Solve&& solve) {
    for (const auto& branch : mcpherson().branches) {
        std::vector<double> loads;
        for (int k = 0; k <= 300; ++k) loads.push_back(branch.to * k / 300);
        benchmark::DoNotOptimize(solve(branch, loads));
    }
}
void equilibrium() {
    points([](const Branch& b, const auto& loads) {
        return reference::equilibrium::solve(mcpherson(), b, loads);
    });
}
void energy() {
    points([](const Branch& b, const auto& loads) {
        return reference::energy::solve(mcpherson(), b, loads);
    });
}
void adaptive() {  // 0.01 mm, 0.001 deg
    points([](const Branch& b, const auto&) {
        return recursive::solve(mcpherson(), b,
                                {.method = *recursive::find_method("adaptive"), .steps = 300},
                                analysis());
    });
}

void series() {  // 1e-12 m
    points([](const Branch& b, const auto&) {
        return recursive::solve(mcpherson(), b,
                                {.method = *recursive::find_method("series"), .steps = 300},
                                analysis());
    });
}
void branches(int order) {  // 1e-12 m, nothing evaluated
    for (const auto& branch : mcpherson().branches)
        benchmark::DoNotOptimize(
            recursive::series::follow(mcpherson(), branch, {.order = order}, analysis()));
}
void published() { sweep(recursive::Method{}); }

// Runs job and base in turns; reports the time of the job and the median of their ratios.
void in_turns(benchmark::State& state, const std::function<void()>& job,
              const std::function<void()>& base) {
    const auto seconds = [](const std::function<void()>& f) {
        const auto start = Clock::now();
        f();
        return std::chrono::duration<double>(Clock::now() - start).count();
    };
    std::vector<double> ratios;
    for (auto _ : state) {
        const double own = seconds(job), other = seconds(base);
        state.SetIterationTime(own);
        ratios.push_back(own / other);
    }
    std::ranges::nth_element(ratios,
                             ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2));
    state.counters["ratio"] = ratios[ratios.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
    const auto add = [](const std::string& name, const std::function<void()>& job,
                        const std::function<void()>& base) {
        benchmark::RegisterBenchmark(name.c_str(),
                                     [=](benchmark::State& state) { in_turns(state, job, base); })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
    };
    add("bare/bare", bare, bare);
    for (const auto& method : recursive::methods)
        if (has_steps(method))
            add(
                "sweep/" + std::string(method.name), [&method] { sweep(method); }, bare);
    add("points/equilibrium", equilibrium, equilibrium);
    add("points/energy", energy, equilibrium);
    add("points/adaptive", adaptive, equilibrium);
    add("points/series", series, equilibrium);
    for (const int order : {8, 12, 16, 20, 24})
        add(
            "branches/series order " + std::to_string(order), [order] { branches(order); },
            published);
    add(
        "analysis", [] { benchmark::DoNotOptimize(recursive::analyse(mcpherson())); }, published);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
