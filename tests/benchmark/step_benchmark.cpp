// Cost of one step of the published recursion, of the project's sparse LU and of KLU (klu_refactor,
// klu_solve, analysis done beforehand) for the same matrix: one numeric factorisation and one
// solution. A step assembles, factorises, solves, checks and moves the bodies. Processor time, in
// turns within one process, as a table in Markdown: benchmark_step [SCENE | BODIES ...], by default
// two chains of hinges.
#include <fmt/format.h>
#include <klu.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/stepping/settle.hpp"
#include "tests/benchmark/families.hpp"

namespace {

using namespace elastocheck;
using namespace elastocheck::recursive;

template <class Job>
double seconds(Job&& job) {
    timespec from{}, to{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
    job();
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
    return static_cast<double>(to.tv_sec - from.tv_sec) +
           1e-9 * static_cast<double>(to.tv_nsec - from.tv_nsec);
}
double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

struct Klu {
    klu_common common{};
    Pattern pattern;
    klu_symbolic* symbolic = nullptr;
    klu_numeric* numeric = nullptr;

    Klu(const Pattern& p, std::vector<double>& values) : pattern(p) {
        klu_defaults(&common);
        symbolic = klu_analyze(pattern.size, pattern.first.data(), pattern.row.data(), &common);
        numeric =
            klu_factor(pattern.first.data(), pattern.row.data(), values.data(), symbolic, &common);
    }
    ~Klu() {
        klu_free_numeric(&numeric, &common);
        klu_free_symbolic(&symbolic, &common);
    }
    Klu(const Klu&) = delete;
    Klu& operator=(const Klu&) = delete;
    bool solve(std::vector<double>& values, std::vector<double>& b) {
        return klu_refactor(pattern.first.data(), pattern.row.data(), values.data(), symbolic,
                            numeric, &common) == 1 &&
               klu_solve(symbolic, numeric, pattern.size, 1, b.data(), &common) == 1;
    }
};

bool compare(const std::string& name, const Scene& scene, int steps) {
    const Model model = compile(scene);
    const Branch& branch = model.branches[0];
    SteppingState s(model, branch, analyse(model));
    const Linear published;
    if (settle(s, published, 1) != Outcome::converged) return false;
    std::vector<double> step_time, own_time, klu_time, slower;
    const SparseLU<double>& lu = s.system.lu;
    const auto entries = [&] {  // of the matrix with its border, in the order of the pattern
        std::vector<double> all;
        for (std::size_t e = 0; e < lu.source.size(); ++e)
            all.push_back(s.system.M.values[static_cast<std::size_t>(lu.source[e])] * lu.factor[e]);
        return all;
    };
    std::vector<double> values = entries();
    Klu klu(s.system.lu.order->pattern, values);
    std::vector<double> b(s.system.lu.size()), x(b.size());
    bool good = true;
    for (int k = 1; k <= steps; ++k) {
        const Parameters next{1, 1e-3 * branch.to * k / steps};
        step_time.push_back(
            seconds([&] { good = step(s, published, next) == Outcome::converged && good; }));
        values = entries();
        std::ranges::fill(b, 1);
        own_time.push_back(seconds([&] {
            factorise(s.system.lu, s.system.M.values.data());
            solve(s.system.lu, b.data(), x.data());
        }));
        klu_time.push_back(seconds([&] { good = klu.solve(values, b) && good; }));
        slower.push_back(klu_time.back() / own_time.back());
    }
    fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.2f} |\n", name, s.system.lu.size(),
               1e6 * median(step_time), 1e6 * median(own_time), 1e6 * median(klu_time),
               median(slower));
    return good;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> cases(argv + 1, argv + argc);
    if (cases.empty()) cases = {"300", "1000"};
    fmt::print(
        "| matrix | unknowns | step [us] | LU [us] | KLU [us] | KLU / LU |\n"
        "|---|---|---|---|---|---|\n");
    bool good = true;
    for (const std::string& at : cases) {
        if (std::filesystem::path(at).extension() == ".yaml") {
            good = compare(std::filesystem::path(at).stem(), read_scene(at), 1001) && good;
            continue;
        }
        for (const auto hinge : {families::Hinge::bushing, families::Hinge::revolute}) {
            const families::Family chain{families::Kind::chain, std::stoi(at), hinge};
            good = compare(fmt::format("{} bodies on {}s", at, families::name(hinge)),
                           parse_scene(families::scene(chain), "family"), 101) &&
                   good;
        }
    }
    return good ? 0 : 1;
}
