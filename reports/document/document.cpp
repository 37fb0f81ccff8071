#include "reports/document/document.hpp"

#include "reports/document/definitions.hpp"
#include "reports/document/drawing.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Leg;

json model_json(const Model& model, const recursive::Diagnosis& d) {
    const recursive::Conditioning condition = recursive::conditioning(model, d);
    json bodies = json::array(), joints = json::array(), elements = json::array(), idle = json::array(),
         redundant = json::array(), left_out = json::array();
    for (const auto& body : model.bodies) bodies.push_back(body.name);
    for (const auto& joint : model.joints) joints.push_back(joint.name);
    for (const auto& elastic : model.elastics) elements.push_back(elastic.name);
    for (const auto& mode : d.idle) idle.push_back(mode.description);
    for (const auto& r : d.redundant)
        redundant.push_back(
            {{"joint", model.joints[static_cast<std::size_t>(r.joint)].name}, {"rows", r.rows}});
    for (const auto& o : model.left_out) left_out.push_back({{"what", o.what}, {"why", o.why}});
    return {{"bodies", bodies},
            {"joints", joints},
            {"elements", elements},
            {"coordinates", d.coordinates},
            {"constraints", d.rows},
            {"unknowns", d.coordinates + d.rows},
            {"rank", d.rank},
            {"degrees_of_freedom", d.degrees_of_freedom()},
            {"idle_modes", idle},
            {"redundant", redundant},
            {"left_out", left_out},
            {"imbalance_N", d.imbalance},
            {"condition_equilibrated", condition.equilibrated},
            {"condition_raw", condition.raw}};
}

json residuals_json(const Residuals& r) {
    return {{"constraint_mm", 1e3 * r.length},
            {"constraint_direction", r.direction},
            {"force_N", r.force},
            {"moment_Nm", r.moment}};
}

json run_json(const compare::LegRun& run, const std::vector<compare::Channel>& channels) {
    json judged = json::object();
    for (const Leg by : compare::legs)
        judged[name(by)] = residuals_json(run.judged[static_cast<std::size_t>(by)]);
    json constraint_error = json::array();
    for (const auto& point : run.path.points) constraint_error.push_back(point.constraint_error);
    json values = json::object();
    for (std::size_t c = 0; c < channels.size(); ++c) {
        json column = json::array();
        for (const auto& point : run.curve.values) column.push_back(point[c]);
        values[channels[c].name] = column;
    }
    return {{"leg", name(run.leg)},
            {"method", run.method},
            {"outcome", elastocheck::name(run.path.outcome)},
            {"detail", run.path.detail},
            {"counts",
             {{"factorisations", run.path.counts.factorisations},
              {"iterations", run.path.counts.iterations},
              {"evaluations", run.path.counts.evaluations}}},
            {"seconds", run.seconds},
            {"residuals_by", judged},
            {"curve",
             {{"load", run.curve.load},
              {"travel_mm", run.curve.travel},
              {"constraint_error", constraint_error},
              {"values", values}}}};
}

json reading_json(const compare::Reading& reading, const compare::Comparison& all) {
    json result = {{"not_compared", reading.not_compared},
                   {"points_outside", reading.outside},
                   {"channels", json::object()}};
    for (std::size_t c = 0; c < reading.channels.size(); ++c) {
        if (!all.unique[c]) continue;
        const auto& d = reading.channels[c];
        result["channels"][all.channels[c].name] = {{"unit", symbol(all.channels[c].unit)},
                                                    {"max", d.max},
                                                    {"signed_max", d.signed_max},
                                                    {"at", d.at},
                                                    {"end", d.end},
                                                    {"rms", d.rms},
                                                    {"range", d.range},
                                                    {"interpolation", d.interpolation},
                                                    {"compared", d.compared}};
    }
    return result;
}

json pair_json(const compare::Pair& pair, const compare::Comparison& all) {
    return {{"of", name(pair.b)},
            {"from", name(pair.a)},
            {"at_equal_load", reading_json(pair.equal_load, all)},
            {"at_equal_travel", reading_json(pair.equal_travel, all)}};
}

}  // namespace

const char* load_unit(const Branch& branch) {
    for (const auto& load : branch.loads)
        if (std::holds_alternative<DeadForce>(load.kind)) return "N";
    return "N·m";
}

json provenance_json(const Provenance& p) {
    json libraries = json::object();
    for (const auto& library : p.libraries) libraries[library.name] = library.version;
    return {{"elastocheck", p.version}, {"commit", p.commit}, {"dirty", p.dirty},
            {"compiler", p.compiler},   {"flags", p.flags},   {"cpu", p.cpu},
            {"libraries", libraries}};
}

json document(const std::string& reproduce, const Provenance& provenance) {
    return {{"schema", result_schema},
            {"reproduce", reproduce},
            {"provenance", provenance_json(provenance)},
            {"scenes", json::array()}};
}

json scene_document(const Scene& scene, std::string_view input, const Model& model,
                    const recursive::Diagnosis& diagnosis) {
    return {{"name", scene.name},
            {"source", scene.source},
            {"input_hash", input_hash(input)},
            {"model", model_json(model, diagnosis)}};
}

void add_comparison(json& scene_document, const Scene& scene, const Model& model,
                    const compare::Comparison& comparison) {
    json channels = json::array(), branches = json::array();
    for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
        const auto& channel = comparison.channels[c];
        channels.push_back({{"name", channel.name},
                            {"unit", symbol(channel.unit)},
                            {"definition", definition(channel)},
                            {"main", channel.main},
                            {"unique", static_cast<bool>(comparison.unique[c])}});
    }
    for (std::size_t b = 0; b < comparison.branches.size(); ++b) {
        const auto& branch = comparison.branches[b];
        json legs = json::array();
        for (const auto& run : branch.runs) legs.push_back(run_json(run, comparison.channels));
        json load_names = json::array();
        for (const auto& load : model.branches[b].loads) load_names.push_back(load.name);
        branches.push_back({{"name", branch.branch},
                            {"to", model.branches[b].to},
                            {"load_unit", load_unit(model.branches[b])},
                            {"loads", load_names},
                            {"legs", legs},
                            {"deviation", pair_json(branch.deviation, comparison)},
                            {"cross_check", pair_json(branch.cross_check, comparison)},
                            {"reference_uncertainty", pair_json(branch.uncertainty, comparison)},
                            {"inconclusive", branch.inconclusive}});
    }
    scene_document["channels"] = channels;
    scene_document["branches"] = branches;
    scene_document["drawing"] = drawing_json(scene, model, comparison);
}

std::vector<std::string> reasons_of(const compare::Comparison& comparison) {
    std::vector<std::string> reasons;
    for (const auto& branch : comparison.branches)
        for (const auto& reason : branch.inconclusive) reasons.push_back(branch.branch + ": " + reason);
    if (comparison.compared == 0) reasons.emplace_back("nothing was compared");
    return reasons;
}

void add_verdict(json& scene_document, int numbers_compared, const std::vector<std::string>& reasons) {
    scene_document["verdict"] = {
        {"conclusive", reasons.empty()}, {"numbers_compared", numbers_compared}, {"reasons", reasons}};
}

}  // namespace elastocheck::reports
