#include "reports/document/candidate.hpp"

#include "compare/outputs/readings.hpp"
#include "reports/tables/judgement.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::CandidateJudgement;

json reading_json(const compare::CandidateReading& reading, const CandidateJudgement& j,
                  const compare::Comparison& comparison) {
    json result = {{"compared", reading.not_compared.empty()},
                   {"not_compared", reading.not_compared},
                   {"outside", reading.outside}};
    json channels = json::object();
    for (std::size_t c = 0; c < reading.columns.size(); ++c) {
        const auto& d = reading.columns[c];
        if (d.compared == 0) continue;
        channels[comparison.channels[j.columns[c].channel].name] = {{"max", d.max},
                                                                    {"signed_max", d.signed_max},
                                                                    {"at", d.at},
                                                                    {"end", d.end},
                                                                    {"rms", d.rms},
                                                                    {"range", d.range},
                                                                    {"compared", d.compared}};
    }
    result["channels"] = channels;
    return result;
}

// The points for the figures: their positions on the branch, and their main outputs.
json points_json(const compare::CandidateBranch& branch, const CandidateJudgement& j,
                 const compare::Comparison& comparison) {
    const bool by_parameter = !branch.equal_parameter.columns.empty();
    const auto& reading = by_parameter ? branch.equal_parameter : branch.equal_abscissa;
    json outputs = json::object();
    for (std::size_t c = 0; c < reading.columns.size(); ++c) {
        const auto& channel = comparison.channels[j.columns[c].channel];
        if (channel.main || static_cast<int>(j.columns[c].channel) == branch.abscissa)
            outputs[channel.name] = reading.candidate[c];
    }
    return {{"over", by_parameter ? "parameter" : "abscissa"},
            {"at", reading.at},
            {"outputs", outputs}};
}

json residuals_json(const std::vector<Residuals>& list) {
    json force = json::array(), moment = json::array(), length = json::array(),
         direction = json::array();
    for (const auto& r : list)
        force.push_back(r.force), moment.push_back(r.moment), length.push_back(1e3 * r.length),
            direction.push_back(r.direction);
    return {{"force_N", force},
            {"moment_Nm", moment},
            {"constraint_mm", length},
            {"direction", direction}};
}

}  // namespace

json candidate_json(const CandidateJudgement& j, const compare::Comparison& comparison,
                    const std::string& sentence) {
    json worst = json::array();
    for (const auto& w : j.worst)
        worst.push_back(
            {{"channel", w.channel},
             {"branch", w.branch},
             {"unit", symbol(w.unit)},
             {"reading", w.kind == compare::ReadingKind::equal_parameter ? "at_equal_parameter"
                                                                         : "at_equal_abscissa"},
             {"max", w.max},
             {"at", w.at},
             {"range", w.range},
             {"tolerance", w.limit}});
    json channels = json::array();
    for (std::size_t c = 0; c < j.columns.size(); ++c) {
        const auto& channel = comparison.channels[j.columns[c].channel];
        channels.push_back({{"name", channel.name},
                            {"unit", symbol(channel.unit)},
                            {"judged", bool(j.judged[c])}});
    }
    json branches = json::array();
    for (const auto& branch : j.branches)
        branches.push_back(
            {{"name", branch.branch},
             {"unit", symbol(branch.unit)},
             {"points", branch.points},
             {"from", branch.from},
             {"to", branch.to},
             {"abscissa",
              branch.abscissa < 0
                  ? json(nullptr)
                  : json(comparison.channels[static_cast<std::size_t>(branch.abscissa)].name)},
             {"at_equal_parameter", reading_json(branch.equal_parameter, j, comparison)},
             {"at_equal_abscissa", reading_json(branch.equal_abscissa, j, comparison)},
             {"curve", points_json(branch, j, comparison)}});
    json states = json::array();
    for (const auto& left : j.leftovers)
        states.push_back({{"branch", left.branch},
                          {"unit", symbol(left.unit)},
                          {"a", left.a},
                          {"equilibrium", residuals_json(left.truth)},
                          {"second", name(left.second)},
                          {"by_second", residuals_json(left.by_second)},
                          {"why_not", left.why_not}});
    return {{"name", j.name},       {"verdict", compare::name(j.verdict)},
            {"sentence", sentence}, {"tolerance", tolerance_json(j.tolerance, j.tolerance_given)},
            {"worst", worst},       {"findings", j.hints},
            {"reasons", j.reasons}, {"not_given", j.not_given},
            {"notes", j.notes},     {"numbers", j.compared},
            {"channels", channels}, {"branches", branches},
            {"states", states}};
}

}  // namespace elastocheck::reports
