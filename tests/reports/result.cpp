#include "tests/reports/result.hpp"

#include <map>

#include "elastocheck/compile.hpp"
#include "reports/document/document.hpp"
#include "reports/document/inspection.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {

namespace {

SceneAnalyses solved(const std::string& name, compare::Trimmed trimmed,
                     const compare::Options& options) {
    Model model = compile(trimmed.scene);
    SceneAnalyses made{.scene = std::move(trimmed.scene),
                       .model = std::move(model),
                       .trim = std::move(trimmed.record),
                       .hash = input_hash("input")};
    made.scene.source = name + ".yaml";
    made.inspected = inspection({made.scene, made.model, made.trim});
    add_comparison(made, compare::compare(made.model, options));
    return made;
}

}  // namespace

const SceneAnalyses& compared_scene(const std::string& name) {
    static std::map<std::string, SceneAnalyses> made;
    if (const auto found = made.find(name); found != made.end()) return found->second;
    return made[name] = solved(name, compare::trim(support::scene(name)), {});
}

const SceneAnalyses& sample_scene(const std::string& name) {
    static std::map<std::string, SceneAnalyses> made;
    if (const auto found = made.find(name); found != made.end()) return found->second;
    compare::Options options;
    options.recursion.steps = 20;
    SceneAnalyses scene = solved(name, {support::scene(name), std::nullopt}, options);
    compare::StudyOptions study_options;
    study_options.steps = {10, 20, 40, 80, 160};
    scene.study = compare::study(scene.model, study_options);
    scene.trade = compare::trade(scene.model, {.max_steps = 80, .rounds = 1});
    scene.judgement =
        compare::assess(scene.model, scene.comparison, compare::default_tolerance, false);
    return made[name] = std::move(scene);
}

SceneAnalyses small_scene(const std::string& name) {
    SceneAnalyses scene = sample_scene("pinned_bar");
    scene.scene.name = name;
    scene.study.reset();
    scene.trade.reset();
    return scene;
}

Report report_of(std::vector<SceneAnalyses> scenes) {
    return {"elastocheck report scene.yaml -o out", provenance(), std::move(scenes)};
}

compare::Curve& truth_of(compare::BranchComparison& branch) {
    return branch.run(compare::Leg::equilibrium).curve;
}

std::size_t channel_of(const SceneAnalyses& scene, std::string_view name) {
    return static_cast<std::size_t>(compare::find_channel(scene.comparison.channels, name));
}

}  // namespace elastocheck::reports
