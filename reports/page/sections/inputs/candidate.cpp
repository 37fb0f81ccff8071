#include "reports/page/sections/inputs/candidate.hpp"

#include <fmt/format.h>

#include <cmath>

#include "compare/outputs/readings.hpp"
#include "reports/page/sections.hpp"
#include "reports/tables/candidate_tables.hpp"

namespace elastocheck::reports {
namespace {

using compare::CandidateBranch;

// Deviations of every output that the candidate gives on a branch, beside those of the recursion.
void add_recursion(Table& table, const SceneAnalyses& scene, const std::string& name) {
    const compare::BranchComparison& solved = scene.comparison.branch(name);
    const auto& channels = scene.comparison.channels;
    const std::size_t output = 1;  // column
    for (const auto& [reading, title] :
         {std::pair{&solved.deviation.equal_parameter,
                    compare::parameter_reading(symbol(solved.unit))},
          {&solved.deviation.equal_abscissa,
           compare::abscissa_reading(
               solved.abscissa < 0 ? ""
                                   : channels[static_cast<std::size_t>(solved.abscissa)].name)}}) {
        table.columns.push_back(
            {.name = "published recursion, " + title, .digits = Digits::deviation});
        for (auto& row : table.rows) {
            const auto c = static_cast<std::size_t>(
                compare::find_channel(channels, std::get<std::string>(row[output])));
            const bool known = solved.determined[c] && c < reading->channels.size() &&
                               reading->channels[c].compared > 0;
            row.emplace_back(known ? reading->channels[c].signed_max : compare::nan);
        }
    }
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
        compare::Result result = result_of(candidate, scene.comparison);
        for (auto& table : result.tables) {
            if (table.id == "residuals" || table.rows.empty()) continue;
            if (table.id == "deviations")
                add_recursion(table, scene, std::get<std::string>(table.rows.front().front()));
            table.caption = fmt::format("{}, {}", candidate.name, table.caption);
            section.tables.push_back(std::move(table));
        }
    }
    return section;
}

std::vector<DrawnCurve> candidate_curves(const SceneAnalyses& scene, const Sweep& sweep,
                                         const std::string& abscissa, const std::string& channel) {
    std::vector<DrawnCurve> list;
    const auto& channels = scene.comparison.channels;
    for (const auto& [candidate, sentence] : scene.candidates) {
        DrawnCurve points{candidate.name};
        // The candidate's values of a main output or of the abscissa of the branch; null without.
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
            const auto* x = abscissa == over ? &reading.at : column(reading, branch, abscissa);
            const auto* y = column(reading, branch, channel);
            if (x == nullptr || y == nullptr) continue;
            for (const auto k : thinned(x->size(), 21))
                if (std::isfinite((*x)[k]) && std::isfinite((*y)[k]))
                    points.rows.push_back({(*x)[k], (*y)[k]});
        }
        if (!points.rows.empty()) list.push_back(std::move(points));
    }
    return list;
}

}  // namespace elastocheck::reports
