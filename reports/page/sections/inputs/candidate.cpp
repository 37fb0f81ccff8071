#include "reports/page/sections/inputs/candidate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::CandidateBranch;
using compare::CandidateJudgement;
using compare::Deviation;

// Deviation of a column; null where it has no numbers.
const Deviation* deviation_of(const std::vector<Deviation>& columns, std::size_t c) {
    return c < columns.size() && columns[c].compared > 0 ? &columns[c] : nullptr;
}

std::string cell(const Deviation* deviation) {
    return deviation == nullptr ? "–" : signed_number(deviation->signed_max);
}

// Deviations of every output that the candidate gives on a branch, beside those of the recursion.
Table beside_the_recursion(const SceneAnalyses& scene, const CandidateJudgement& candidate,
                           const CandidateBranch& branch) {
    const auto& channels = scene.comparison.channels;
    const compare::BranchComparison& solved = scene.comparison.branch(branch.branch);
    const std::string load = compare::parameter_reading(symbol(branch.unit)),
                      travel = compare::abscissa_reading(
                          branch.abscissa < 0
                              ? ""
                              : channels[static_cast<std::size_t>(branch.abscissa)].name);
    Table table{.caption = fmt::format("Deviation from the full solution, branch {} ({} points)",
                                       branch.branch, branch.points),
                .columns = {{"output", true},
                            {fmt::format("{}, {}", candidate.name, load)},
                            {fmt::format("{}, {}", candidate.name, travel)},
                            {"share of the range"},
                            {"published recursion, " + load},
                            {"published recursion, " + travel}}};
    for (std::size_t c = 0; c < candidate.columns.size(); ++c) {
        const std::size_t channel = candidate.columns[c].channel;
        const Deviation *mine = deviation_of(branch.equal_parameter.columns, c),
                        *across = deviation_of(branch.equal_abscissa.columns, c),
                        *some = mine ? mine : across;
        if (some == nullptr || (!candidate.judged[c] && some->max < 1e-6)) continue;
        const auto recursion = [&](const compare::Reading& reading) {
            return cell(solved.determined[channel] && channel < reading.channels.size()
                            ? &reading.channels[channel]
                            : nullptr);
        };
        table.rows.push_back(
            {fmt::format("{} [{}]", channels[channel].name, symbol(channels[channel].unit)),
             cell(mine), cell(across), some->range < 1e-9 ? "–" : percent(some->max / some->range),
             recursion(solved.deviation.equal_parameter),
             recursion(solved.deviation.equal_abscissa)});
    }
    return table;
}

double largest_of(const std::vector<Residuals>& list, double Residuals::*field) {
    double worst = 0;
    for (const auto& r : list) worst = compare::worse(worst, r.*field);
    return worst;
}

// Residuals of its states in the equations of the legs.
Table leftovers(const CandidateJudgement& candidate) {
    Table table{.caption = fmt::format(
                    "Largest residuals of the states of {} in the equations of the references",
                    candidate.name),
                .columns = {{"branch", true},
                            {"equations of", true},
                            {"states"},
                            {"force [N]"},
                            {"moment [N·m]"},
                            {"constraints [mm]"}}};
    for (const auto& of : candidate.leftovers)
        for (const auto& [leg, left] :
             {std::pair{compare::Leg::equilibrium, &of.truth}, std::pair{of.second, &of.by_second}})
            table.rows.push_back({of.branch, name(leg),
                                  whole_number(static_cast<long>(of.a.size())),
                                  number(largest_of(*left, &Residuals::force), 2),
                                  number(largest_of(*left, &Residuals::moment), 2),
                                  number(1e3 * largest_of(*left, &Residuals::length), 2)});
    return table;
}

}  // namespace

std::optional<Section> candidate_section(const SceneAnalyses& scene) {
    if (scene.candidates.empty()) return std::nullopt;
    Section section{.id = "candidate", .title = "The candidate", .mark = Mark::pass};
    for (const auto& [candidate, sentence] : scene.candidates) {
        if (candidate.verdict == compare::Grade::fail)
            section.mark = Mark::fail;
        else if (candidate.verdict != compare::Grade::pass && section.mark == Mark::pass)
            section.mark = Mark::open;
        section.words["candidates"].push_back(
            {{"sentence", sentence}, {"reasons", candidate.reasons}, {"notes", candidate.notes}});
        for (const auto& branch : candidate.branches)
            if (auto table = beside_the_recursion(scene, candidate, branch); !table.rows.empty())
                section.tables.push_back(std::move(table));
        if (!candidate.leftovers.empty()) section.tables.push_back(leftovers(candidate));
    }
    return section;
}

std::vector<Series> candidate_series(const SceneAnalyses& scene, const Sweep& sweep,
                                     const std::string& by, const std::string& channel) {
    std::vector<Series> list;
    const auto& channels = scene.comparison.channels;
    for (const auto& [candidate, sentence] : scene.candidates) {
        Series series{
            .title = candidate.name, .style = Series::Style::rings, .colour = green, .mark = 4};
        // its main outputs, and what places its points
        const auto column = [&](const compare::CandidateReading& reading,
                                const CandidateBranch& branch,
                                const std::string& name) -> const std::vector<double>* {
            for (std::size_t c = 0; c < reading.columns.size(); ++c)
                if (const std::size_t k = candidate.columns[c].channel;
                    channels[k].name == name &&
                    (channels[k].main || static_cast<int>(k) == branch.abscissa))
                    return &reading.candidate[c];
            return nullptr;
        };
        for (const auto& branch : candidate.branches) {
            if (!sweep.has(branch.branch)) continue;
            const bool by_parameter = !branch.equal_parameter.columns.empty();
            const auto& reading = by_parameter ? branch.equal_parameter : branch.equal_abscissa;
            const std::string over = by_parameter || branch.abscissa < 0
                                         ? ""
                                         : channels[static_cast<std::size_t>(branch.abscissa)].name;
            const auto* x = by == over ? &reading.at : column(reading, branch, by);
            const auto* y = column(reading, branch, channel);
            if (x == nullptr || y == nullptr) continue;
            for (const auto k : thinned(x->size(), 21))
                if (std::isfinite((*x)[k]) && std::isfinite((*y)[k]))
                    series.rows.push_back({(*x)[k], (*y)[k]});
        }
        if (!series.rows.empty()) list.push_back(std::move(series));
    }
    return list;
}

}  // namespace elastocheck::reports
