// Speed of every leg on the paper's example, the McPherson strut, as ratios in Markdown.
//
//   LU        PartialPivLU factor + solve of a dense 27×27 matrix, what the paper's method cannot do
//             without
//   sweep     2 × 300 steps, by every rung
//   points    2 × 301 output points
//   proofs    of 2 × 21 points
//   branches  both, as polynomials
//
// The recursion has the analysis of the model given, which is a row of its own. Each job and its
// base take turns, and their ratio is the median, so that a slow moment slows both; processor time,
// so that other programs do not count.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <ctime>
#include <functional>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/series/sides.hpp"
#include "reference/certificate/certificate.hpp"
#include "tests/support/scenes.hpp"

namespace {

using namespace elastocheck;

const Model& mcpherson() {
    static const Model model = compile(support::scene("chrono_mcpherson"));
    return model;
}

// Told once for the model, as the sweeps, the branches and the points all use it.
const recursive::Analysis& analysis() {
    static const recursive::Analysis analysis = recursive::analyse(mcpherson());
    return analysis;
}

volatile double kept = 0;  // or the compiler may leave out what nobody reads
void bare() {
    static Eigen::MatrixXd A =
        Eigen::MatrixXd::Random(27, 27) + 27 * Eigen::MatrixXd::Identity(27, 27);
    static Eigen::VectorXd b = Eigen::VectorXd::Random(27), x(27);
    static Eigen::PartialPivLU<Eigen::MatrixXd> lu(27);
    for (int k = 0; k < 600; ++k) {
        A(k % 27, 0) += 1e-12;
        lu.compute(A);
        x = lu.solve(b);
        kept = x(0);
    }
}

void sweep(const recursive::Method& method) {
    for (const auto& branch : mcpherson().branches)
        recursive::solve(mcpherson(), branch, {.method = method, .steps = 300, .record = 1},
                         analysis());
}

template <class Solve>
void points(Solve&& solve) {
    for (const auto& branch : mcpherson().branches) {
        std::vector<double> loads;
        for (int k = 0; k <= 300; ++k) loads.push_back(branch.to * k / 300);
        solve(branch, loads);
    }
}
void equilibrium() {
    points([](const Branch& b, const auto& loads) {
        return reference::equilibrium::solve(mcpherson(), b, loads);
    });
}
// 20 increments a branch, as the command `certify` takes them.
std::vector<std::pair<const Branch&, std::vector<Equilibrium>>> few() {
    std::vector<std::pair<const Branch&, std::vector<Equilibrium>>> all;
    for (const auto& branch : mcpherson().branches) {
        std::vector<double> loads;
        for (int k = 0; k <= 20; ++k) loads.push_back(branch.to * k / 20);
        all.emplace_back(branch, reference::equilibrium::solve(mcpherson(), branch, loads).points);
    }
    return all;
}
void proofs() {
    static const auto known = few();
    for (const auto& [branch, states] : known)
        for (const auto& state : states)
            kept = reference::certificate::certify(mcpherson(), branch, state).error.length;
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
    recursive::series::follow_sides(mcpherson(), mcpherson().branches,
                                    {.order = order, .last_order = order}, analysis());
}

double seconds(const std::function<void()>& work) {
    const std::clock_t start = std::clock();
    work();
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// One row: `job` takes so many times `unit` bases, the median of a second's turns or of nine.
void row(const std::string& name, const std::function<void()>& job,
         const std::function<void()>& base, double unit = 1) {
    std::vector<double> ratios;
    double spent = 0;
    while (ratios.size() < 9 || spent < 1) {
        const double own = seconds(job), other = seconds(base);
        spent += own + other;
        ratios.push_back(unit * own / other);
    }
    std::ranges::nth_element(ratios,
                             ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2));
    fmt::print("| {} | {:.3g} |\n", name, ratios[ratios.size() / 2]);
}

}  // namespace

int main() {
    fmt::print("| McPherson strut | ratio |\n|---|---|\n");
    for (const auto& method : recursive::methods)
        if (has_steps(method))
            row(
                fmt::format("sweep by `{}` / 600 LU", method.name), [&] { sweep(method); }, bare);
    for (const int order : {16, 24})
        row(
            fmt::format("branches by `series`, order {} / LU", order), [=] { branches(order); },
            bare, 600);
    row(
        "analysis of the model / LU", [] { recursive::analyse(mcpherson()); }, bare, 600);
    row("a point by the equilibrium leg / LU", equilibrium, bare, 600. / 602);
    row("a point by the energy leg / LU", energy, bare, 600. / 602);
    row("a point by `certify` / by the equilibrium leg, 20 increments", proofs, few);
    row("points by the equilibrium leg / by `adaptive`", equilibrium, adaptive);
    row("points by the equilibrium leg / by `series`", equilibrium, series);
}
