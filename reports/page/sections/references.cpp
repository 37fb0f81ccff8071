// Section: agreement of the references, by the residuals of each leg's states in the equations of
// the others.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::BranchComparison;
using compare::Unit;

std::string size(double value) { return number(value, 2); }

// Distance of the references in each unit, and how many numbers it is made of.
std::vector<std::string> agreement_of(const std::vector<compare::Channel>& channels,
                                      const BranchComparison& branch) {
    const auto& apart = branch.uncertainty.equal_parameter.channels;
    std::vector<std::string> row{branch.branch};
    int compared = 0;
    for (const Unit unit : {Unit::mm, Unit::deg, Unit::newton, Unit::newton_metre}) {
        double worst = -1;
        for (std::size_t c = 0; c < apart.size(); ++c) {
            // A length that is not a position, such as a swing arm length near infinity, has its
            // own scale.
            const bool place = unit == Unit::mm || unit == Unit::deg;
            if (channels[c].unit != unit || !branch.determined[c] ||
                (place && !channels[c].kinematic()))
                continue;
            compared += apart[c].compared;
            worst = compare::worse(apart[c].max, worst);
            if (std::isnan(worst)) break;
        }
        row.push_back(worst < 0 ? "–" : size(worst));
    }
    row.push_back(whole_number(compared));
    return row;
}

// Largest residuals of its states in the equations of the others.
void add_judged(Table& table, const BranchComparison& branch, const compare::LegRun& run) {
    for (const compare::Leg by : compare::legs) {
        const Residuals& left = run.judged[static_cast<std::size_t>(by)];
        if (by != run.leg)
            table.rows.push_back({branch.branch, name(run.leg), name(by), size(left.force),
                                  size(left.moment), size(1e3 * left.length)});
    }
}

void add_proof(Table& table, const BranchComparison& branch, const compare::LegRun& run) {
    const compare::Tally& proof = run.proved;
    if (proof.points == 0) return;
    const auto proved = [&](const std::string& text) {
        return proof.proved > 0 ? text : std::string("–");
    };
    table.rows.push_back(
        {branch.branch, name(run.leg), fmt::format("{} of {}", proof.proved, proof.points),
         proved(size(1e3 * proof.error.length)),
         proved(size(180 / std::numbers::pi * proof.error.angle)), proved(size(proof.error.force)),
         proved(size(1e3 * proof.unique.length)),
         proved(fmt::format("{} of {}", proof.stable, proof.proved)), proof.not_proved});
}

void add_work(Table& table, const BranchComparison& branch, const compare::LegRun& run) {
    const std::string outcome = name(run.outcome);
    table.rows.push_back(
        {branch.branch, name(run.leg), run.detail.empty() ? outcome : outcome + ": " + run.detail,
         whole_number(static_cast<long>(run.curve.a.size())),
         whole_number(run.counts.factorisations), whole_number(run.counts.iterations),
         whole_number(run.counts.evaluations)});
}

// Why the energy leg was not asked, and what its equations leave of the other states.
void add_why_not_energy(nlohmann::ordered_json& words, const BranchComparison& branch) {
    if (branch.why_not_energy.empty()) return;
    nlohmann::ordered_json why{
        {"branch", branch.branch}, {"second", name(branch.second)}, {"why", branch.why_not_energy}};
    if (!energy_judges_states(branch)) {
        words["no_energy"].push_back(why);
        return;
    }
    const auto three = [](double force, double moment, double mm) {
        return fmt::format("{} N, {} N·m and {} mm", size(force), size(moment), size(mm));
    };
    const Residuals& left = branch.run(compare::Leg::equilibrium)
                                .judged[static_cast<std::size_t>(compare::Leg::energy)];
    const compare::Bounds& bounds = branch.bounds;
    why["left"] = three(left.force, left.moment, 1e3 * left.length);
    why["at_most"] = three(bounds.residual_force, bounds.residual_moment, bounds.residual_length);
    words["witness"].push_back(why);
}

}  // namespace

std::optional<Section> references_section(const SceneAnalyses& scene) {
    Section section{.id = "references",
                    .title = "Agreement and certification of the references",
                    .part = Part::evidence};
    Table agreement{
        .caption =
            "Difference between the solutions by energy and by equilibrium, worst over the branch",
        .columns = {{"branch", true},
                    {"positions [mm]"},
                    {"angles [deg]"},
                    {"forces [N]"},
                    {"moments [N·m]"},
                    {"numbers compared"}}};
    Table judged{
        .caption =
            "Residuals of each solution in the equations of the others, worst over the points",
        .columns = {{"branch", true},
                    {"states of", true},
                    {"judged by", true},
                    {"force [N]"},
                    {"moment [N·m]"},
                    {"constraint [mm]"}},
        .folded = true};
    Table work{.caption = "Outcome and work of each solution",
               .columns = {{"branch", true},
                           {"solution", true},
                           {"outcome", true},
                           {"points"},
                           {"factorisations"},
                           {"iterations"},
                           {"evaluations"}}};
    Table proofs{
        .caption = scene.quick
                       ? "Proofs by interval arithmetic at the ends (--quick)"
                       : "Proofs by interval arithmetic at the start, the middle and the ends",
        .columns = {{"branch", true},
                    {"points of", true},
                    {"proved"},
                    {"off at most [mm]"},
                    {"at most [deg]"},
                    {"at most [N]"},
                    {"alone within [mm]"},
                    {"stable"},
                    {"remark", true}}};
    for (const auto& branch : scene.comparison.branches) {
        agreement.rows.push_back(agreement_of(scene.comparison.channels, branch));
        for (const auto& run : branch.runs) {
            add_judged(judged, branch, run);
            add_proof(proofs, branch, run);
            add_work(work, branch, run);
            if (run.proved.proved > 0) section.words["proofs"] = true;
            if (!run.proved.theorem.empty() && !section.words.contains("says_also"))
                section.words["says_also"].push_back(run.proved.theorem);
        }
        add_why_not_energy(section.words, branch);
        for (const auto& reason : branch.inconclusive.texts())
            section.words["reasons"].push_back(fmt::format("{}: {}", branch.branch, reason));
    }
    if (section.words.contains("no_energy") || section.words.contains("witness"))
        agreement.caption =
            "Difference between the second reference and the solution by equilibrium, worst over "
            "the branch";
    section.tables = {agreement, proofs, judged, work};
    return section;
}

}  // namespace elastocheck::reports
