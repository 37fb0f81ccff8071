#include "reports/document/document.hpp"

#include <cmath>
#include <numbers>

#include "compare/comparison/characteristics.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/studies/findings.hpp"
#include "compare/tables/rows.hpp"
#include "compare/warnings/lift_off.hpp"
#include "compare/warnings/plausibility.hpp"
#include "models/overloaded.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "reports/document/drawing.hpp"
#include "reports/document/wheels.hpp"
#include "reports/tables/elements.hpp"
#include "reports/render/render.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Leg;

json model_json(const Model& model) {
    const recursive::Diagnosis d = recursive::diagnose(model);
    const recursive::Conditioning condition = recursive::conditioning(model, d);
    json bodies = json::array(), joints = json::array(), elements = json::array(),
         idle = json::array(), redundant = json::array(), omitted = json::array();
    for (const auto& body : model.bodies) bodies.push_back(body.name);
    for (const auto& joint : model.joints) joints.push_back(joint.name);
    for (const auto& elastic : model.elastics) elements.push_back(elastic.name);
    for (const auto& mode : d.idle) idle.push_back(mode.description);
    for (const auto& r : d.redundant)
        redundant.push_back(
            {{"joint", model.joints[static_cast<std::size_t>(r.joint)].name}, {"rows", r.rows}});
    for (const auto& o : model.omitted) omitted.push_back({{"what", o.what}, {"why", o.why}});
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
            {"left_out", omitted},
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

json counts_json(const Counts& counts) {
    return {{"factorisations", counts.factorisations},
            {"iterations", counts.iterations},
            {"evaluations", counts.evaluations}};
}

json curve_json(const compare::Curve& curve, const std::vector<double>& constraint_error,
                const std::vector<compare::Channel>& channels) {
    json values = json::object();
    for (std::size_t c = 0; c < channels.size(); ++c) values[channels[c].name] = curve.channel(c);
    return {{"a", curve.a}, {"constraint_error", constraint_error}, {"values", values}};
}

json proof_json(const compare::Tally& tally) {
    const bool any = tally.proved > 0;
    const auto number = [&](double value) {
        return any && std::isfinite(value) ? json(value) : json(nullptr);
    };
    constexpr double degrees = 180 / std::numbers::pi;
    return {{"points", tally.points},
            {"proved", tally.proved},
            {"excluded", tally.excluded},
            {"stable", tally.stable},
            {"off_at_most_mm", number(1e3 * tally.error.length)},
            {"off_at_most_deg", number(degrees * tally.error.angle)},
            {"off_at_most_N", number(tally.error.force)},
            {"off_at_most_Nm", number(tally.error.moment)},
            {"alone_within_mm", number(1e3 * tally.unique.length)},
            {"not_proved", tally.not_proved},
            {"says_also", tally.theorem}};
}

json run_json(const compare::LegRun& run, const std::vector<compare::Channel>& channels) {
    json judged = json::object();
    for (const Leg by : compare::legs)
        judged[name(by)] = residuals_json(run.judged[static_cast<std::size_t>(by)]);
    return {{"leg", name(run.leg)},
            {"method", run.method},
            {"outcome", elastocheck::name(run.outcome)},
            {"detail", run.detail},
            {"counts", counts_json(run.counts)},
            {"seconds", run.seconds},
            {"residuals_by", judged},
            {"proof", run.proved.points > 0 ? proof_json(run.proved) : json(nullptr)},
            {"curve", curve_json(run.curve, run.constraint_error, channels)}};
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

// Worst main channel at each point of the equilibrium leg.
json profile_json(const compare::Profile& profile) {
    json mm = json::array(), deg = json::array();
    for (const auto& apart : profile.apart) mm.push_back(apart.mm), deg.push_back(apart.deg);
    return {{"mm", mm}, {"deg", deg}};
}

json profiles_json(const compare::Comparison& all, const compare::BranchComparison& branch) {
    const auto curve = [&](Leg leg) -> const compare::Curve& {
        return branch.runs[static_cast<std::size_t>(leg)].curve;
    };
    const compare::Curve &truth = curve(Leg::equilibrium), &recursion = curve(Leg::recursive);
    const auto by = compare::abscissa(all.channels, branch.abscissa, truth, recursion);
    return {{"at_equal_parameter",
             profile_json(compare::profile_at_equal_parameter(all.channels, truth, recursion))},
            {"at_equal_abscissa",
             profile_json(compare::profile_at_equal_abscissa(all.channels, truth, recursion, by))},
            {"references", profile_json(compare::profile_at_equal_parameter(
                               all.channels, truth, curve(branch.second)))}};
}

json worst_json(const std::optional<compare::Worst>& worst) {
    if (!worst) return nullptr;
    return {{"branch", worst->branch},
            {"channel", worst->channel},
            {"max", worst->max},
            {"end", worst->end},
            {"range", worst->range}};
}

json findings_json(const compare::Comparison& all) {
    using compare::ReadingKind;
    json findings;
    for (const auto unit : {compare::Unit::mm, compare::Unit::deg}) {
        const char* name = symbol(unit);
        findings["worst_at_equal_parameter"][name] =
            worst_json(compare::worst_deviation(all, ReadingKind::equal_parameter, unit));
        findings["worst_at_equal_abscissa"][name] =
            worst_json(compare::worst_deviation(all, ReadingKind::equal_abscissa, unit));
        findings["references_apart"][name] = worst_json(compare::worst_disagreement(all, unit));
    }
    return findings;
}

const char* name_of(compare::GapRole role) {
    switch (role) {
        case compare::GapRole::none: return "none";
        case compare::GapRole::nearly_all: return "nearly_all";
        case compare::GapRole::part: return "part";
        case compare::GapRole::hardly_any: return "hardly_any";
        case compare::GapRole::hidden: return "hidden";
        case compare::GapRole::opposite: return "opposite";
    }
    return "";
}

json rate_errors_json(const std::vector<compare::RateError>& rates) {
    json list = json::array();
    for (const auto& rate : rates)
        list.push_back({{"branch", rate.branch},
                        {"wheel", rate.wheel},
                        {"to", rate.to},
                        {"unit", symbol(rate.unit)},
                        {"off", rate.off},
                        {"over_mm", rate.over},
                        {"travel_mm", rate.travel},
                        {"force_N", rate.force},
                        {"wheel_rate_N_per_mm", rate.wheel_rate},
                        {"ride_rate_N_per_mm", rate.ride_rate},
                        {"ride_off", rate.ride_off}});
    return list;
}

json events_json(const Model& model, const Branch& branch) {
    json list = json::array();
    for (const auto& event : compare::lift_offs(model, branch, Leg::equilibrium))
        list.push_back(event.text());
    return list;
}

// Residuals of the equilibrium leg's states in the equations of the energy leg, and their bounds,
// where the scene is too large for states of the energy leg; null where the energy leg judges as
// usual.
json witness_json(const compare::BranchComparison& branch) {
    if (!energy_judges_states(branch)) return nullptr;
    const Residuals& left = branch.runs[1].judged[static_cast<std::size_t>(compare::Leg::energy)];
    const auto three = [](double force, double moment, double length) {
        return json{{"force_N", force}, {"moment_Nm", moment}, {"constraint_mm", length}};
    };
    const compare::Bounds& b = branch.bounds;
    return {{"leg", name(compare::Leg::energy)},
            {"states_of", name(compare::Leg::equilibrium)},
            {"left", three(left.force, left.moment, 1e3 * left.length)},
            {"at_most", three(b.residual_force, b.residual_moment, b.residual_length)}};
}

}  // namespace

std::string driven_name(const Model& model, const Driven& what) {
    const auto element = [&](int k) { return model.elastics[static_cast<std::size_t>(k)].name; };
    return std::visit(
        overloaded{
            [](const Load& load) { return load.name; },
            [&](const Motion& m) { return model.joints[static_cast<std::size_t>(m.joint)].name; },
            [&](const FreeLength& f) {
                const Elastic& of = model.elastics[static_cast<std::size_t>(f.elastic)];
                return (of.written_as == WrittenAs::tyre ? "road under " : "free length of ") +
                       of.name;
            },
            [&](const Preload& p) { return "preload of " + element(p.elastic); }},
        what);
}

json document(const std::string& reproduce, const Provenance& provenance) {
    return {{"schema", result_schema},
            {"reproduce", reproduce},
            {"provenance", provenance_json(provenance)},
            {"scenes", json::array()}};
}

json scene_document(const Scene& scene, std::string_view input, const Model& model) {
    return {{"name", scene.name},
            {"source", scene.source},
            {"input_hash", input_hash(input)},
            {"model", model_json(model)}};
}

void add_comparison(json& scene_document, const Scene& scene, const Model& model,
                    const compare::Comparison& comparison) {
    json branches = json::array();
    for (std::size_t b = 0; b < comparison.branches.size(); ++b) {
        const auto& branch = comparison.branches[b];
        json legs = json::array();
        for (const auto& run : branch.runs) legs.push_back(run_json(run, comparison.channels));
        const auto pair = [&](const compare::Pair& p) {
            return pair_json(p, comparison, branch.determined);
        };
        json one = branch_json(model, model.branches[b]);
        one.update(
            {{"abscissa",
              branch.abscissa < 0
                  ? json(nullptr)
                  : json(comparison.channels[static_cast<std::size_t>(branch.abscissa)].name)},
             {"legs", legs},
             {"deviation", pair(branch.deviation)},
             {"cross_check", pair(branch.cross_check)},
             {"reference_uncertainty", pair(branch.uncertainty)},
             {"profiles", profiles_json(comparison, branch)},
             {"second_reference", name(branch.second)},
             {"energy_not_asked", branch.why_not_energy},
             {"witness", witness_json(branch)},
             {"bounds", compare::describe(branch.bounds)},
             {"inconclusive", branch.inconclusive.texts()},
             {"case", load_case(model, model.branches[b])},
             {"events", events_json(model, model.branches[b])},
             {"pushes", pushes_json(model, model.branches[b])},
             {"efforts", efforts_json(model.branches[b], comparison.channels)}});
        if (branch.every > 1) one["steps"] = branch.steps;
        branches.push_back(std::move(one));
    }
    json channels = channels_json(comparison.channels);
    const auto drawn = compare::evaluate(model, comparison.channels, compare::design_state(model));
    for (std::size_t c = 0; c < drawn.size(); ++c) {
        const auto* rate = std::get_if<compare::Characteristic>(&comparison.channels[c].reads);
        if (comparison.channels[c].kinematic()) channels[c]["drawn"] = drawn[c];
        if (rate != nullptr && compare::is_swing_arm(*rate)) channels[c]["reciprocal"] = true;
    }
    scene_document["numbers"] = numbers_json(scene);
    scene_document["channels"] = channels;
    scene_document["branches"] = branches;
    scene_document["findings"] = findings_json(comparison);
    scene_document["rate_errors"] = rate_errors_json(compare::rate_errors(model, comparison));
    if (!model.wheels.empty())
        scene_document["characteristics"] = {
            {"design", table_json(characteristic_rows(comparison))},
            {"compliance", table_json(compliance_rows(model, comparison))}};
    if (!model.wheels.empty() && !comparison.branches.empty())
        scene_document["wheels"] = wheels_json(model, comparison);
    scene_document["elements"] = elements_json(model);
    scene_document["forces"] = table_json(force_rows(model, comparison));
    scene_document["largest_forces"] = table_json(largest_force_rows(comparison));
    scene_document["drawing"] = drawing_json(scene, model, comparison);
}

void add_curves(json& scene_document, const Model& model,
                const std::vector<compare::Channel>& channels, compare::Leg leg,
                const std::string& method, const std::vector<compare::PathCurve>& branches) {
    std::vector<std::string> reasons;
    json list = json::array();
    int numbers = 0;
    for (std::size_t b = 0; b < branches.size(); ++b) {
        const compare::PathCurve& walked = branches[b];
        json one = branch_json(model, model.branches[b]);
        one["legs"] =
            json::array({{{"leg", name(leg)},
                          {"method", method},
                          {"outcome", elastocheck::name(walked.outcome)},
                          {"detail", walked.detail},
                          {"counts", counts_json(walked.counts)},
                          {"curve", curve_json(walked.curve, walked.constraint_error, channels)}}});
        list.push_back(std::move(one));
        numbers += static_cast<int>(walked.curve.a.size() * channels.size());
        if (walked.outcome != Outcome::converged)
            reasons.push_back(model.branches[b].name + ": " + elastocheck::name(walked.outcome) +
                              ": " + walked.detail);
    }
    scene_document["channels"] = channels_json(channels);
    scene_document["branches"] = list;
    scene_document["verdict"] = {
        {"conclusive", reasons.empty()}, {"numbers", numbers}, {"reasons", reasons}};
}

void add_inspection(json& scene_document, const Scene& scene, const Model& model) {
    const auto channels = compare::channels(model);
    json bodies = json::array(), list = json::array(), branches = json::array();
    for (const auto& body : model.bodies) {
        const Eigen::Vector3d mm = 1e3 * body.design.r;
        bodies.push_back({{"name", body.name}, {"origin_mm", {mm.x(), mm.y(), mm.z()}}});
    }
    for (const auto& [name, between, what] : elements(scene, model))
        list.push_back({{"name", name}, {"between", between}, {"what", what}});
    for (const auto& branch : model.branches) {
        const compare::Settled settled = compare::settled(model, channels, branch);
        json one = branch_json(model, branch), moves = json::object();
        for (std::size_t c = 0; c < settled.displacement.size(); ++c)
            if (!std::isnan(settled.displacement[c]))
                moves[channels[c].name] = settled.displacement[c];
        one["steps"] = branch.steps;
        one["settles"] = {{"outcome", elastocheck::name(settled.outcome)},
                          {"detail", settled.detail},
                          {"displacement", moves}};
        branches.push_back(std::move(one));
    }
    scene_document["channels"] = channels_json(channels);
    scene_document["inspection"] = {{"bodies", bodies},
                                    {"elements", list},
                                    {"branches", branches},
                                    {"misplaced", compare::misplaced_points(scene)},
                                    {"numbers", numbers_json(scene)}};
}

void add_trim(json& scene_document, const compare::TrimRecord& trim) {
    json adjusted = json::array(), conditions = json::array();
    for (const auto& a : trim.adjusted)
        adjusted.push_back(
            {{"name", a.name}, {"unit", symbol(a.unit)}, {"by", a.by}, {"makes", a.makes}});
    for (const auto& c : trim.conditions)
        conditions.push_back({{"name", c.name},
                              {"unit", symbol(c.unit)},
                              {"asked", c.target},
                              {"missed", c.missed},
                              {"missed_by_confirming_leg", c.confirmed}});
    scene_document["trim"] = {{"adjusted", adjusted},
                              {"conditions", conditions},
                              {"iterations", trim.iterations},
                              {"bushings", compare::name(trim.bushings)},
                              {"confirmed_by", name(trim.confirmed_by)}};
}

void add_formulations(json& scene_document, const compare::FormulationStudy& study,
                      const compare::Comparison& comparison) {
    json formulations = json::array();
    for (const auto& one : compare::formulations) formulations.push_back(one.name);
    json not_solved = json::array();
    for (const auto& branch : study.branches)
        for (const auto& why : branch.not_solved) not_solved.push_back(branch.branch + ": " + why);
    scene_document["formulations"] = {{"formulations", formulations},
                                      {"bushings", study.bushings},
                                      {"spread", table_json(formulation_rows(study, comparison))},
                                      {"not_solved", not_solved},
                                      {"inconclusive", study.inconclusive}};
}

void add_gap(json& scene_document, const compare::Comparison& comparison,
             const compare::Study& study) {
    const auto part = compare::gap_part(comparison, study, "published");
    if (!part) return;
    scene_document["findings"]["gap"] = {
        {"branch", part->branch}, {"channel", part->channel}, {"deviation", part->deviation},
        {"gap", part->gap},       {"band", part->band},       {"role", name_of(part->role)}};
}

std::vector<std::string> reasons_of(const compare::Comparison& comparison) {
    std::vector<std::string> reasons;
    for (const auto& branch : comparison.branches)
        for (const auto& reason : branch.inconclusive.texts())
            reasons.push_back(branch.branch + ": " + reason);
    if (comparison.compared == 0) reasons.emplace_back("nothing was compared");
    return reasons;
}

void add_verdict(json& scene_document, int numbers_compared,
                 const std::vector<std::string>& reasons) {
    scene_document["verdict"] = {{"conclusive", reasons.empty()},
                                 {"numbers_compared", numbers_compared},
                                 {"reasons", reasons}};
}

}  // namespace elastocheck::reports
