#include "reports/document/scene_analyses.hpp"

#include <fmt/format.h>

#include "compare/warnings/lift_off.hpp"

namespace elastocheck::reports {

void add_comparison(SceneAnalyses& scene, compare::Comparison comparison) {
    scene.comparison = std::move(comparison);
    for (const auto& branch : scene.comparison.branches)
        for (const auto& reason : branch.inconclusive.texts())
            scene.reasons.push_back(branch.branch + ": " + reason);
    if (scene.comparison.compared == 0) scene.reasons.emplace_back("nothing was compared");
    for (const auto& branch : scene.model.branches) {
        auto& texts = scene.lift_offs.emplace_back();
        for (const auto& event : compare::lift_offs(scene.model, branch, compare::Leg::equilibrium))
            texts.push_back(event.text());
    }
    scene.drawing = drawing_of(scene.scene, scene.model, scene.comparison);
}

compare::Result result_of(const Effects& effects) {
    compare::Result result{.analysis = "sensitivity"};
    result.tables = {table_of(effects.rows)};
    result.tables.front().id = "effects";
    result.verdict = {
        .grade = effects.reasons.empty() ? compare::Grade::pass : compare::Grade::not_judged,
        .sentence = fmt::format("The solvers differ by {:.1e} of the largest of a figure at most.",
                                effects.difference),
        .reasons = effects.reasons,
        .compared = static_cast<int>(effects.compared)};
    return result;
}

}  // namespace elastocheck::reports
