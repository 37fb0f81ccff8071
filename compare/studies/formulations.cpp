#include "compare/studies/formulations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/comparison/legs.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/deformation.hpp"
#include "elastocheck/compile.hpp"
#include "models/kinds.hpp"
#include "models/laws.hpp"

namespace elastocheck::compare {
namespace {

constexpr double min_spread = 1e-9;  // [mm], [deg]: smaller spreads are rounding

// Number of the six deformations that have a stiffness.
int axes_resisted(const SpatialLaw& law) {
    return std::visit(
        overloaded{[](const LinearStiffness& u) {
                       return static_cast<int>((u.K.array() != 0).rowwise().any().count());
                   },
                   [](const PerAxis& u) {
                       return static_cast<int>(std::ranges::count_if(
                           u.axis, [](const ScalarLaw& axis) { return max_slope(axis) > 0; }));
                   }},
        law);
}

// Formulation of every bushing; two scenes of one study differ in nothing else.
std::vector<Formulation> formulations_of(const Scene& scene) {
    std::vector<Formulation> list;
    for (const auto& elastic : scene.elastics)
        if (const auto* formulation = member<Formulation>(elastic.kind))
            list.push_back(*formulation);
    return list;
}

struct SolvedFormulation {
    std::string name;
    Curve curve;
};

std::optional<FormulationSpread> spread_of(const std::vector<SolvedFormulation>& solved,
                                           std::size_t channel) {
    FormulationSpread largest{
        .channel = channel, .spread = -1, .at = 0, .lowest = {}, .highest = {}};
    // Range that every curve reaches, around the start points.
    std::size_t before = solved.front().curve.start, after = solved.front().curve.a.size();
    for (const auto& one : solved) {
        before = std::min(before, one.curve.start);
        after = std::min(after, one.curve.a.size() - one.curve.start);
    }
    for (std::size_t k = 0; k < before + after; ++k) {
        const auto value = [&](const SolvedFormulation& one) {
            return one.curve.values[one.curve.start - before + k][channel];
        };
        const auto [low, high] = std::ranges::minmax_element(solved, {}, value);
        const double spread = value(*high) - value(*low);
        if (!std::isfinite(spread)) return std::nullopt;
        if (spread <= largest.spread) continue;
        largest.spread = spread;
        largest.at = solved.front().curve.a[solved.front().curve.start - before + k];
        largest.lowest = low->name;
        largest.highest = high->name;
    }
    if (largest.spread < 0) return std::nullopt;
    if (largest.spread < min_spread) {
        largest.lowest.clear();
        largest.highest.clear();
    }
    return largest;
}

}  // namespace

bool is_reformulated(const Elastic& elastic) {
    const auto* formulation = member<Formulation>(elastic.kind);
    return formulation != nullptr && formulation->frame != Formulation::Frame::middle &&
           axes_resisted(*member<SpatialLaw>(elastic.kind)) > 1;
}

Scene reformulated(const Scene& scene, const Formulation& formulation) {
    Scene result = scene;
    for (auto& elastic : result.elastics)
        if (is_reformulated(elastic)) std::get<Bushing>(elastic.kind).formulation = formulation;
    return result;
}

FormulationStudy spread_among(const std::vector<std::pair<std::string, Scene>>& scenes, int steps,
                              int every, int threads, const Progress& progress) {
    FormulationStudy study;
    std::vector<std::pair<std::string, Model>> models;
    for (const auto& [name, scene] : scenes) models.emplace_back(name, compile(scene));
    for (const auto& channel : channels(models.front().second))
        if (channel.main) study.channels.push_back(channel);

    const auto& branches = models.front().second.branches;
    std::vector<std::vector<PathCurve>> curves(branches.size(),
                                               std::vector<PathCurve>(models.size()));
    std::vector<Job> jobs;
    // A formulation that the scene has as it is written is not solved again.
    const auto repeats_the_first = [&](std::size_t m) {
        return m > 0 && formulations_of(scenes[m].second) == formulations_of(scenes[0].second);
    };
    for (std::size_t b = 0; b < branches.size(); ++b)
        for (std::size_t m = 0; m < models.size(); ++m)
            if (!repeats_the_first(m))
                jobs.push_back(
                    {fmt::format("{}: {}", branches[b].name, models[m].first), [&, b, m] {
                         const Model& model = models[m].second;
                         const Branch& branch = model.branches[b];
                         curves[b][m] = solve_branch(model, study.channels, branch,
                                                     sides_of(model, branch, steps),
                                                     {.leg = Leg::equilibrium, .every = every});
                     }});
    run_jobs(jobs, threads, progress);
    for (std::size_t b = 0; b < branches.size(); ++b) {
        BranchSpread spread{.branch = branches[b].name,
                            .unit = unit_of(branches[b].unit),
                            .solved = {},
                            .not_solved = {},
                            .outputs = {}};
        std::vector<SolvedFormulation> solved;
        for (std::size_t m = 0; m < models.size(); ++m) {
            const std::string& name = models[m].first;
            const PathCurve& path = curves[b][repeats_the_first(m) ? 0 : m];
            if (path.outcome != Outcome::converged) {
                spread.not_solved.push_back(
                    fmt::format("{}: {}: {}", name, elastocheck::name(path.outcome), path.detail));
                continue;
            }
            spread.solved.push_back(name);
            solved.push_back({name, path.curve});
        }
        if (solved.size() < 2)
            study.inconclusive.push_back(fmt::format(
                "{}: fewer than two formulations were solved{}{}", spread.branch,
                spread.not_solved.empty() ? "" : "; ", fmt::join(spread.not_solved, "; ")));
        else
            for (std::size_t c = 0; c < study.channels.size(); ++c)
                if (const auto found = spread_of(solved, c))
                    spread.outputs.push_back(*found);
                else
                    study.inconclusive.push_back(fmt::format(
                        "{}: '{}' is not a number", spread.branch, study.channels[c].name));
        study.branches.push_back(std::move(spread));
    }
    return study;
}

FormulationStudy formulation_study(const Scene& scene, int steps, int every, int threads,
                                   const Progress& progress) {
    std::vector<std::string> bushings;
    for (const auto& elastic : scene.elastics)
        if (is_reformulated(elastic)) bushings.push_back(elastic.name);
    if (bushings.empty()) {
        FormulationStudy none;
        none.inconclusive.emplace_back("the scene has no bushing that leaves a choice");
        return none;
    }
    std::vector<std::pair<std::string, Scene>> scenes;
    for (const auto& [name, formulation] : formulations)
        scenes.emplace_back(name, formulation ? reformulated(scene, *formulation) : scene);
    FormulationStudy study = spread_among(scenes, steps, every, threads, progress);
    study.bushings = std::move(bushings);
    return study;
}

Conversion converted(const Scene& scene, const Formulation& formulation) {
    Conversion result{scene, {}};
    for (Elastic& elastic : result.scene.elastics) {
        auto* bushing = std::get_if<Bushing>(&elastic.kind);
        if (bushing == nullptr || elastic.active_only_where_driven ||
            elastic.written_as == WrittenAs::torsion_spring ||
            bushing->formulation == formulation ||
            markers_swapped(*bushing).formulation == formulation)
            continue;
        bushing->formulation = formulation;
        result.bushings.push_back(elastic.name);
    }
    return result;
}

}  // namespace elastocheck::compare
