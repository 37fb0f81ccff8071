// Section: agreement of the references, by the residuals of each leg's states in the equations of
// the others.
#include <fmt/format.h>

#include "compare/tables/compare_result.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

// Why the energy leg was not used, and what its equations leave of the other states.
void add_why_not_energy(nlohmann::ordered_json& words, const compare::BranchComparison& branch) {
    if (branch.why_not_energy.empty()) return;
    nlohmann::ordered_json why{
        {"branch", branch.branch}, {"second", name(branch.second)}, {"why", branch.why_not_energy}};
    if (!energy_judges_states(branch)) {
        words["no_energy"].push_back(why);
        return;
    }
    const auto three = [](double force, double moment, double mm) {
        return fmt::format("{} N, {} N·m and {} mm", number(force, 2), number(moment, 2),
                           number(mm, 2));
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
    const auto& comparison = scene.comparison;
    Section section{.id = "references",
                    .title = "Agreement and certification of the references",
                    .part = Part::evidence};
    auto& words = section.words;
    for (const auto& branch : comparison.branches) {
        for (const auto& run : branch.runs) {
            if (run.proved.proved > 0) words["proofs"] = true;
            if (!run.proved.theorem.empty() && !words.contains("says_also"))
                words["says_also"].push_back(run.proved.theorem);
        }
        add_why_not_energy(words, branch);
        for (const auto& reason : branch.inconclusive.texts())
            words["reasons"].push_back(fmt::format("{}: {}", branch.branch, reason));
    }
    Table agreement = agreement_table(comparison), proofs = proof_table(comparison),
          work = with_columns(compare::leg_table(comparison.branches),
                              {"branch", "leg", "outcome", "detail", "points", "factorisations",
                               "iterations", "evaluations"});
    agreement.caption =
        words.contains("no_energy") || words.contains("witness")
            ? "Difference between the second reference and the solution by equilibrium, worst over "
              "the branch"
            : "Difference between the solutions by energy and by equilibrium, worst over the "
              "branch";
    proofs.detail = false;
    proofs.caption +=
        scene.quick ? " at the ends (--quick)" : " at the start, the middle and the ends";
    work.caption = "Outcome and work of each solution";
    section.tables = {agreement, proofs, residual_table(comparison), work};
    return section;
}

}  // namespace elastocheck::reports
