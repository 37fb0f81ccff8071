#include <algorithm>
#include <optional>
#include <stdexcept>

#include "elastocheck/recursive_batch.hpp"
#include "models/structure.hpp"
#include "recursive/batch/pack.hpp"

namespace elastocheck::recursive {
namespace {

// Whether variants may share lanes at all: else each is solved alone.
bool has_lanes(const Model& design, const Analysis& analysis) {
    return analysis.pivot_ratio > 0 && !design.bodies.empty() &&
           undecided(design, analysis.diagnosis).empty();
}

void solve_alone(std::size_t variant, const Model& model, const BatchOptions& options,
                 const VisitBatch& visit) {
    const Analysis analysis = analyse(model);
    const Options alone{.method = {"series", 0, options.series}, .steps = options.points};
    for (std::size_t k = 0; k < model.branches.size(); ++k)
        visit(variant, k, solve(model, model.branches[k], alone, analysis));
}

}  // namespace

void solve_batch(const Model& design, const Analysis& analysis, std::span<const Model> variants,
                 const BatchOptions& options, const VisitBatch& visit) {
    if (options.points < 1 || options.series.arc_length)
        throw std::invalid_argument(
            "a batch records at least one step, with the parameter of the branch");
    for (const auto& branch : design.branches) check(design, branch);
    std::vector<int> expected, structure;
    elastocheck::structure(design, expected);
    std::optional<batch::Pack> pack;
    if (has_lanes(design, analysis)) pack.emplace(design, analysis, options);
    std::vector<std::size_t> together;
    std::vector<const Model*> models;
    const auto flush = [&] {
        if (together.empty()) return;
        models.clear();
        for (const std::size_t v : together) models.push_back(&variants[v]);
        pack->solve_variants(models);
        for (std::size_t lane = 0; lane < together.size(); ++lane) {
            const batch::LaneState& state = pack->lanes[lane];
            if (!state.in_lockstep) {
                solve_alone(together[lane], variants[together[lane]], options, visit);
                continue;
            }
            for (std::size_t k = 0; k < state.paths.size(); ++k)
                visit(together[lane], k, state.paths[k]);
        }
        together.clear();
    };
    for (std::size_t v = 0; v < variants.size(); ++v) {
        for (const auto& branch : variants[v].branches) check(variants[v], branch);
        elastocheck::structure(variants[v], structure);
        const bool ends_early = std::ranges::any_of(variants[v].branches, [&](const Branch& side) {
            return vanishing_length(variants[v], side).has_value();
        });
        if (!pack || structure != expected || ends_early) {
            solve_alone(v, variants[v], options, visit);
            continue;
        }
        together.push_back(v);
        if (together.size() == static_cast<std::size_t>(batch::Lanes::count)) flush();
    }
    flush();
}

void solve_batch(const Model& design, std::span<const Model> variants, const BatchOptions& options,
                 const VisitBatch& visit) {
    solve_batch(design, analyse(design), variants, options, visit);
}

}  // namespace elastocheck::recursive
