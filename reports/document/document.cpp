#include "reports/document/document.hpp"

#include "compare/comparison/elements.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/studies/converge.hpp"
#include "compare/tables/compare_result.hpp"
#include "compare/tables/rows.hpp"
#include "models/overloaded.hpp"
#include "reports/document/drawing.hpp"
#include "reports/given/wheels.hpp"
#include "reports/render/render.hpp"
#include "reports/tables/candidate_tables.hpp"
#include "reports/tables/judgement.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Leg;

// Moved and held drivers of a branch.
json drivers_json(const Model& model, const Branch& branch) {
    json moved = json::array(), held = json::array();
    for (const auto& driver : branch.drivers)
        (driver.rate != 0 ? moved : held).push_back(driven_name(model, driver.what));
    return {{"moved", moved}, {"held", held}};
}

json branch_json(const Model& model, const Branch& branch) {
    const compare::Unit unit = compare::unit_of(branch.unit);
    return {{"name", branch.name},
            {"from", parameter_in(unit, branch.from)},
            {"to", parameter_in(unit, branch.to)},
            {"unit", symbol(unit)},
            {"drivers", drivers_json(model, branch)}};
}

json channels_json(const std::vector<compare::Channel>& channels) {
    json list = json::array();
    for (const auto& channel : channels)
        list.push_back({{"name", channel.name},
                        {"unit", symbol(channel.unit)},
                        {"main", channel.main},
                        {"kinematic", channel.kinematic()},
                        {"kind", name(channel.kind())},
                        {"definition", channel.definition}});
    return list;
}

json numbers_json(const Scene& scene) {
    json numbers = json::array();
    for (const auto& n : scene.numbers) {
        numbers.push_back({{"path", n.path}, {"value", n.value}, {"unit", n.unit}});
        for (const auto& [side, value] : n.sides) numbers.back()["sides"][side] = value;
    }
    return numbers;
}

json legs_json(const std::vector<compare::LegRun>& runs,
               const std::vector<compare::Channel>& channels) {
    json legs = json::array();
    for (const compare::LegRun& run : runs) {
        json values = json::object();
        for (std::size_t c = 0; c < channels.size(); ++c)
            values[channels[c].name] = run.curve.channel(c);
        legs.push_back({{"leg", name(run.leg)},
                        {"method", run.method},
                        {"outcome", elastocheck::name(run.outcome)},
                        {"detail", run.detail},
                        {"curve",
                         {{"a", run.curve.a},
                          {"constraint_error", run.constraint_error},
                          {"values", values}}}});
    }
    return legs;
}

json reading_json(const compare::Reading& reading, const compare::Comparison& all,
                  const std::vector<bool>& determined) {
    json result = {{"not_compared", reading.not_compared},
                   {"points_outside", reading.outside},
                   {"channels", json::object()}};
    for (std::size_t c = 0; c < reading.channels.size(); ++c) {
        if (!determined[c]) continue;
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

json pair_json(const compare::Pair& pair, const compare::Comparison& all,
               const std::vector<bool>& determined) {
    return {{"of", name(pair.b)},
            {"from", name(pair.a)},
            {"at_equal_parameter", reading_json(pair.equal_parameter, all, determined)},
            {"at_equal_abscissa", reading_json(pair.equal_abscissa, all, determined)}};
}

json trim_json(const compare::TrimRecord& trim) {
    json adjusted = json::array(), conditions = json::array();
    for (const auto& a : trim.adjusted)
        adjusted.push_back(
            {{"name", a.name}, {"unit", symbol(a.unit)}, {"by", a.change}, {"makes", a.resulting}});
    for (const auto& c : trim.conditions)
        conditions.push_back({{"name", c.name},
                              {"unit", symbol(c.unit)},
                              {"requested", c.target},
                              {"missed", c.residual},
                              {"missed_by_confirming_leg", c.confirming_residual}});
    return {{"adjusted", adjusted},
            {"conditions", conditions},
            {"iterations", trim.iterations},
            {"bushings", compare::name(trim.bushings)},
            {"confirmed_by", name(trim.confirmed_by)}};
}

json wheels_json(const Model& model) {
    json names = json::array(), vehicle = nullptr;
    for (const auto& wheel : model.wheels)
        names.push_back({{"name", wheel.name}, {"side", wheel.side > 0 ? "left" : "right"}});
    if (model.vehicle)
        vehicle = {{"wheelbase_mm", 1e3 * model.vehicle->wheelbase},
                   {"cg_height_mm", 1e3 * model.vehicle->cg_height}};
    return {{"names", names},
            {"vehicle", vehicle},
            {"settled_on", model.branches[settled_on(model)].name}};
}

}  // namespace

std::string driven_name(const Model& model, const Driven& driven) {
    const auto element = [&](int k) -> const Elastic& {
        return model.elastics[static_cast<std::size_t>(k)];
    };
    return std::visit(
        overloaded{
            [](const Load& load) { return load.name; },
            [&](const Motion& m) { return model.joints[static_cast<std::size_t>(m.joint)].name; },
            [&](const FreeLength& f) {
                const Elastic& spring = element(f.elastic);
                return (spring.written_as == WrittenAs::tyre ? "road under " : "free length of ") +
                       spring.name;
            },
            [&](const Preload& p) { return "preload of " + element(p.elastic).name; }},
        driven);
}

json document(const std::string& reproduce, const Provenance& provenance) {
    return {{"schema", result_schema},
            {"reproduce", reproduce},
            {"provenance", provenance_json(provenance)},
            {"scenes", json::array()}};
}

json scene_head(const SceneAnalyses& s) {
    json head = {{"name", s.scene.name}, {"source", s.scene.source}, {"input_hash", s.hash}};
    if (s.trim) head["trim"] = trim_json(*s.trim);
    if (!s.warnings.empty()) head["warnings"] = s.warnings;
    return head;
}

namespace {

json branches_json(const SceneAnalyses& scene) {
    const Model& model = scene.model;
    const compare::Comparison& comparison = scene.comparison;
    json branches = json::array();
    for (std::size_t b = 0; b < comparison.branches.size(); ++b) {
        const auto& branch = comparison.branches[b];
        const auto pair = [&](const compare::Pair& p) {
            return pair_json(p, comparison, branch.determined);
        };
        json document = branch_json(model, model.branches[b]);
        document.update(
            {{"abscissa",
              branch.abscissa < 0
                  ? json(nullptr)
                  : json(comparison.channels[static_cast<std::size_t>(branch.abscissa)].name)},
             {"legs", legs_json(branch.runs, comparison.channels)},
             {"deviation", pair(branch.deviation)},
             {"cross_check", pair(branch.cross_check)},
             {"reference_uncertainty", pair(branch.uncertainty)},
             {"second_reference", name(branch.second)},
             {"why_not_energy", branch.why_not_energy},
             {"bounds", compare::describe(branch.bounds)},
             {"inconclusive", branch.inconclusive.texts()},
             {"case", load_case(model, model.branches[b])},
             {"events", scene.lift_offs[b]}});
        if (branch.every > 1) document["steps"] = branch.steps;
        branches.push_back(std::move(document));
    }
    return branches;
}

json described_channels(const Model& model, const compare::Comparison& comparison) {
    json channels = channels_json(comparison.channels);
    const auto drawn = compare::evaluate(model, comparison.channels, compare::design_state(model));
    for (std::size_t c = 0; c < drawn.size(); ++c) {
        if (comparison.channels[c].kinematic()) channels[c]["drawn"] = drawn[c];
        if (compare::is_swing_arm(comparison.channels[c])) channels[c]["reciprocal"] = true;
    }
    return channels;
}

void add_compared(json& part, const SceneAnalyses& scene) {
    const Model& model = scene.model;
    const compare::Comparison& comparison = scene.comparison;
    part["numbers"] = numbers_json(scene.scene);
    part["channels"] = described_channels(model, comparison);
    part["branches"] = branches_json(scene);
    if (!model.wheels.empty() && !comparison.branches.empty()) part["wheels"] = wheels_json(model);
    part["drawing"] = drawing_json(scene.drawing);
}

}  // namespace

void add_curves(json& scene_document, const Model& model,
                const std::vector<compare::Channel>& channels,
                std::span<const compare::BranchComparison> branches) {
    json list = json::array();
    for (std::size_t b = 0; b < branches.size(); ++b) {
        list.push_back(branch_json(model, model.branches[b]));
        list.back()["legs"] = legs_json(branches[b].runs, channels);
    }
    scene_document["channels"] = channels_json(channels);
    scene_document["branches"] = list;
}

void add_verdict(json& scene_document, int numbers_compared,
                 const std::vector<std::string>& reasons) {
    scene_document["verdict"] = {{"conclusive", reasons.empty()},
                                 {"numbers_compared", numbers_compared},
                                 {"reasons", reasons}};
}

namespace {

// Error of the recommended configuration over the branches.
compare::Table recommended_table(const Recommended& recommended) {
    struct Point {
        std::string branch;
        double a;
        compare::Accuracy error;
    };
    std::vector<Point> points;
    for (const auto& [branch, profile] : recommended.branches)
        for (std::size_t k = 0; k < profile.a.size(); ++k)
            points.push_back({branch, profile.a[k], profile.deviation[k]});
    using enum compare::Digits;
    return compare::table<Point>(
        {.id = "recommended"},
        {{"branch", words, &Point::branch},
         {"parameter", place, &Point::a},
         {"error", size, [](const Point& p) { return p.error.mm; }, "", "mm"},
         {"angle error", size, [](const Point& p) { return p.error.deg; }, "", "deg"}},
        points);
}

// What the analyses found, each as its command writes it.
json results_json(const SceneAnalyses& s) {
    compare::Assessment judgement = s.judgement.value_or(compare::Assessment{});
    if (!s.judgement) {
        judgement.requested = false;
        judgement.verdict = compare::Grade::pass;
    }
    compare::Result compared = result_of(s.model, s.comparison, judgement);
    if (s.judgement) compared.verdict.sentence = sentence(judgement);
    if (s.formulations) add_formulations(compared, *s.formulations, s.comparison);
    add_tables(compared, s);
    json results = json::array({json_of(compared)});
    if (s.study)
        results.push_back(
            json_of(result_of(s.model, compare::ConvergenceStudies{.methods = s.study})));
    if (s.trade) {
        compare::Result trade = result_of(s.model, *s.trade);
        if (s.recommended) trade.tables.push_back(recommended_table(*s.recommended));
        results.push_back(json_of(trade));
    }
    if (s.effects) results.push_back(json_of(result_of(*s.effects)));
    if (s.measured) results.push_back(json_of(result_of(*s.measured, s.comparison)));
    if (s.loads) results.push_back(json_of(*s.loads));
    for (const auto& [candidate, sentence] : s.candidates)
        results.push_back(json_of(result_of(candidate, s.comparison)));
    if (s.against) results.push_back(json_of(result_of(*s.against)));
    if (!s.inspected.tables.empty()) results.push_back(json_of(s.inspected));
    return results;
}

}  // namespace

void add_tables(compare::Result& compared, const SceneAnalyses& s) {
    add_tables(compared, s.model, s.comparison);
    compared.tables.push_back(table_of(static_rows(s.model, s.comparison)));
    compared.tables.back().id = "static";
}

json compared_json(const SceneAnalyses& s) {
    json part = scene_head(s);
    if (!s.only.empty()) part["only"] = s.only;
    if (s.quick) part["proved"] = "ends";
    add_compared(part, s);
    add_verdict(part, s.comparison.compared, s.reasons);
    return part;
}

json scene_json(const SceneAnalyses& s) {
    json part = compared_json(s);
    part["results"] = results_json(s);
    return part;
}

}  // namespace elastocheck::reports
