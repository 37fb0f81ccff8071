// The suspension families in one table: survey SCENE...
//
//   gap, equal load     the published recursion's worst position error, and angle error, over all branches; with so many steps that
//   gap, equal travel   nearly all of it is its formulation gap (640 a way); read at equal parameter, and at equal travel as far as
//                       it goes
//   best of 100 steps   the smallest worst position error among the methods with equal steps, 100 a way, and which
//   series              expansions over all branches, worst position error against the equilibrium leg
//   references          how far they are apart, at least the rounding of what they solve for
//   series : equilibrium    time for the same output points; both in this process, the least of three turns
//
// A branch driven by its travel has the two readings in one. Exit code 3 where a reference fails on a branch.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>

#include "compare/comparison/compare.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/outputs/curve.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "models/branch.hpp"
#include "recursive/series/path.hpp"

namespace {

using namespace elastocheck;
using namespace elastocheck::compare;

constexpr int points = 40, fine = 640, coarse = 100;  // of a way

// What a method makes of a branch, against the references there.
compare::Curve walked(const Model& model, const std::vector<Channel>& channels,
                      const Branch& branch, const std::vector<BranchSide>& ways,
                      const recursive::Method& method, int refine) {
    return curve(
        model, channels, branch,
        solve_branch(ways,
                     {.leg = Leg::recursive, .recursion = {.method = method}, .refine = refine})
            .points);
}

Accuracy at_equal_travel(const std::vector<Channel>& channels, const compare::Curve& truth,
                         const compare::Curve& other) {
    Accuracy most;
    const auto by = abscissa(channels, default_abscissa(channels, truth), truth, other);
    for (const auto& apart : profile_at_equal_abscissa(channels, truth, other, by).deviation)
        if (std::isfinite(apart.mm)) most = worse(most, apart);  // as far as the recursion goes
    return most;
}

double seconds(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// One row of the table; whether every branch could be judged.
bool survey(const std::string& file) {
    const Scene scene = trim(read_scene(file)).scene;
    const Model model = compile(scene);
    const auto channels = compare::channels(model);
    const auto series = *recursive::find_method("series");
    Accuracy by_load, by_travel, apart, of_series;
    std::vector<std::pair<std::string_view, double>> rungs;
    for (const auto& method : recursive::methods)
        if (recursive::has_steps(method)) rungs.emplace_back(method.name, 0);
    std::size_t expansions = 0;
    double time_of_series = 0, time_of_equilibrium = 0;
    std::string failed;
    for (const auto& branch : model.branches) {
        const auto ways = sides_of(
            model, branch, points * static_cast<int>(elastocheck::branch_sides(branch).size()));
        const auto known = references(model, channels, branch, ways);
        for (const auto& why : known.failures) failed += fmt::format(" {}: {};", branch.name, why);
        if (!known.failures.empty()) continue;
        apart = worse(apart, known.uncertainty);
        const auto published =
            walked(model, channels, branch, ways, recursive::Method{}, fine / points);
        by_load = worse(by_load, distance(channels, known.truth.curve, published));
        by_travel = worse(by_travel, at_equal_travel(channels, known.truth.curve, published));
        for (auto& [name, error] : rungs) {
            const auto hundred =
                sides_of(model, branch, coarse / 5 * static_cast<int>(ways.size()));
            const auto truth = curve(model, channels, branch,
                                     solve_branch(hundred, {.leg = Leg::equilibrium}).points);
            error = worse(error, distance(channels, truth,
                                          walked(model, channels, branch, hundred,
                                                 *recursive::find_method(name), 5))
                                     .mm);
        }
        of_series = worse(of_series, distance(channels, known.truth.curve,
                                              walked(model, channels, branch, ways, series, 1)));
        for (const auto& way : ways)
            expansions += recursive::series::follow(way.model, way.branch).expansions.size();
        const auto least = [&](const SolverSettings& solver) {
            double time = std::numeric_limits<double>::infinity();
            for (int turn = 0; turn < 3; ++turn)
                time = std::min(time, seconds([&] { solve_branch(ways, solver); }));
            return time;
        };
        time_of_series += least({.leg = Leg::recursive, .recursion = {.method = series}});
        time_of_equilibrium += least({.leg = Leg::equilibrium});
    }
    // What diverged on some branch is NaN there, and not the best.
    const auto best = std::ranges::min_element(rungs, {}, [](const auto& rung) {
        return std::isfinite(rung.second) ? rung.second : std::numeric_limits<double>::infinity();
    });
    fmt::print(
        "| {} | {} | {} | {:.2g} mm, {:.1g}° | {:.2g} mm, {:.1g}° | {:.1g} mm, `{}` | {}, {:.0e} "
        "mm | {:.0e} "
        "mm | 1/{:.0f} |\n",
        scene.name, model.branches.size(), coordinates(model) + constraint_rows(model), by_load.mm,
        by_load.deg, by_travel.mm, by_travel.deg, best->second, best->first, expansions,
        of_series.mm, apart.mm, time_of_equilibrium / time_of_series);
    if (!failed.empty()) fmt::print(stderr, "survey: {}:{}\n", file, failed);
    return failed.empty();
}

}  // namespace

int main(int argc, char** argv) {
    fmt::print(
        "| scene | branches | unknowns | gap, equal load | gap, equal travel | best of 100 steps | "
        "series | "
        "references | "
        "series : equilibrium |\n|---|---|---|---|---|---|---|---|---|\n");
    bool judged = argc > 1;
    for (int k = 1; k < argc; ++k) judged = survey(argv[k]) && judged;
    return judged ? 0 : 3;
}
