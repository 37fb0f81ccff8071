// Variants per second and core: a scene with random numbers, both branches, twelve figures at 21
// stations of each, compiled models in, numbers out.
//
//   benchmark_batch [SCENE.yaml [VARIANTS [ORDER [baseline]]]]
//
// Each variant has other hardpoints (1 mm) and rates (10 %). `solve` and `solve_batch` take turns over
// the same variants; the rate is that of the median turn, in processor time. `baseline`: without AVX2.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <map>
#include <random>

#include "elastocheck/channels.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive_batch.hpp"
#include "recursive/batch/kernels.hpp"
#include "recursive/diagnosis/analysis.hpp"

namespace {

using namespace elastocheck;

// The scene with its hardpoints moved by up to 1 mm, the rates of every element scaled by up to 10 %.
Model variant(const std::string& file, const Scene& scene, std::mt19937& random) {
    std::uniform_real_distribution<double> share(-1, 1);
    std::vector<Setting> settings;
    std::map<std::string, double> scale;  // of an element, "bushings.K3_arm_front"
    for (const Number& number : scene.numbers) {
        if (number.path.starts_with("points.") && number.unit == "m")
            settings.push_back(setting(number.path, number.value + 1e-3 * share(random)));
        const std::size_t at = number.path.find(".rot") != std::string::npos
                                   ? number.path.find(".rot")
                                   : number.path.find(".rate");
        if (at == std::string::npos) continue;
        const auto [of, first] = scale.try_emplace(number.path.substr(0, at), 0);
        if (first) of->second = 1 + 0.1 * share(random);
        settings.push_back(setting(number.path, number.value * of->second));
    }
    return compile(read_scene(file, settings));
}

// The first twelve figures of the wheel: its centre, angles, travel, patch, steering axis.
constexpr std::size_t figures = 12;
constexpr int points = 20;

double sum = 0;  // of all figures: nothing may be left out
void read(const Model& model, std::span<const compare::Channel> channels,
          const EquilibriumPath& path) {
    for (const Equilibrium& point : path.points)
        for (const double value : compare::evaluate(model, channels, point)) sum += value;
}

double seconds(auto&& work) {
    const std::clock_t start = std::clock();
    work();
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string file = argc > 1 ? argv[1] : ELASTOCHECK_SCENES "/chrono_mcpherson.yaml";
    const int count = argc > 2 ? std::atoi(argv[2]) : 400;
    if (argc > 4) recursive::batch::use_avx2(false);
    const Scene scene = read_scene(file);
    const Model design = compile(scene);
    const recursive::Analysis analysis = recursive::analyse(design);
    std::mt19937 random(1);
    std::vector<Model> variants;
    for (int k = 0; k < count; ++k) variants.push_back(variant(file, scene, random));
    auto channels = compare::channels(design);
    channels.resize(std::min(channels.size(), figures));

    recursive::BatchOptions options{.points = points, .wrenches = false};
    if (argc > 3) options.series.order = std::atoi(argv[3]);
    const recursive::Options alone{.method = {"series", 0, options.series}, .steps = points};
    const auto solve = [&] {
        for (const Model& model : variants) {
            const recursive::Analysis own = recursive::analyse(model);
            for (const Branch& branch : model.branches)
                read(model, channels, recursive::solve(model, branch, alone, own));
        }
    };
    const auto solve_batch = [&] {
        recursive::solve_batch(design, analysis, variants, options,
                               [&](std::size_t v, std::size_t, const EquilibriumPath& path) {
                                   read(variants[v], channels, path);
                               });
    };
    const auto median = [](std::vector<double>& all) {
        std::ranges::sort(all);
        return all[all.size() / 2];
    };
    std::vector<double> one, four, ratio;
    for (int turn = 0; turn < (count < 50 ? 1 : 5); ++turn) {
        one.push_back(seconds(solve));
        four.push_back(seconds(solve_batch));
        ratio.push_back(one.back() / four.back());
    }
    fmt::print("| {} | variants per second |\n|---|---|\n", design.name);
    fmt::print("| alone | {:.0f} |\n| in batches | {:.0f} |\n| ratio | {:.2f} |\n",
               count / median(one), count / median(four), median(ratio));
    return std::isfinite(sum) ? 0 : 1;
}
