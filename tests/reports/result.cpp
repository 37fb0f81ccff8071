#include "tests/reports/result.hpp"

#include <map>

#include "compare/studies/study.hpp"
#include "compare/studies/work_precision.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"
#include "reports/document/document.hpp"
#include "reports/tables/judgement.hpp"
#include "reports/render/render.hpp"
#include "reports/tables/studies/study_tables.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {

using json = nlohmann::ordered_json;

namespace {

json compared(const Scene& scene, const Model& model, const compare::Comparison& comparison,
              const std::string& name) {
    json part = scene_document(scene, "input", model);
    part["source"] = name + ".yaml";
    add_comparison(part, scene, model, comparison);
    return part;
}

json document_of(json part, const std::string& name) {
    json result = document("elastocheck report " + name + ".yaml -o out", provenance());
    result["scenes"].push_back(std::move(part));
    return json::parse(result.dump());
}

}  // namespace

const json& compared_result(const std::string& name) {
    static std::map<std::string, json> made;
    if (const auto found = made.find(name); found != made.end()) return found->second;
    const auto trimmed = compare::trim(support::scene(name));
    const Model model = compile(trimmed.scene);
    const auto comparison = compare::compare(model);
    json part = compared(trimmed.scene, model, comparison, name);
    if (trimmed.record) add_trim(part, *trimmed.record);
    add_verdict(part, comparison.compared, reasons_of(comparison));
    return made[name] = document_of(std::move(part), name);
}

const json& sample_result(const std::string& name) {
    static std::map<std::string, json> made;
    if (const auto found = made.find(name); found != made.end()) return found->second;
    const Scene scene = support::scene(name);
    const Model model = compile(scene);
    compare::Options options;
    options.recursion.steps = 20;
    const auto comparison = compare::compare(model, options);
    json part = compared(scene, model, comparison, name);
    compare::StudyOptions study_options;
    study_options.steps = {10, 20, 40, 80, 160};
    const auto study = compare::study(model, study_options);
    part["convergence"] = study_json(study, compare::attribute_gap(model));
    part["trade"] = trade_json(compare::trade(model, {.most_steps = 80, .rounds = 1}));
    add_gap(part, comparison, study);
    add_verdict(part, comparison.compared, reasons_of(comparison));
    part["judgement"] =
        judgement_json(compare::assess(model, comparison, compare::default_tolerance, false));
    return made[name] = document_of(std::move(part), name);
}

json small_result(const std::string& name) {
    json result = sample_result("pinned_bar");
    auto& scene = result["scenes"][0];
    scene["name"] = name;
    for (const char* part : {"convergence", "trade", "drawing"}) scene.erase(part);
    return result;
}

}  // namespace elastocheck::reports
