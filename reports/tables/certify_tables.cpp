#include "reports/tables/certify_tables.hpp"

#include <fmt/format.h>

#include <iterator>

#include "compare/tables/rows.hpp"
#include "reports/tables/render.hpp"

namespace elastocheck::reports {
namespace {

std::string claim(const compare::Tolerance& tolerance) {
    return fmt::format("{:g} mm and {:g} deg", tolerance.mm, tolerance.deg);
}

// Statement and limits of the proofs in one paragraph.
std::string what_is_proved(const compare::CertifyStudy& study) {
    return fmt::format(
        "Proved: interval arithmetic shows that the model's equations of balance and constraint, "
        "with its stored numbers taken as exact, have a solution within {} of the solver's point, "
        "and no other within the distance \"alone within\" for the same positions of idle motions "
        "and the same load sharing of redundant joints. Excluded: they have no solution there. A "
        "proved curve is continuous between the points. Not proved: that the equations describe "
        "the suspension, or that its numbers are right.",
        claim(study.tolerance));
}

}  // namespace

std::string sentence(const compare::CertifyStudy& study) {
    const int points = study.points(), proved = study.proved();
    if (study.excluded()) {
        int excluded = 0;
        for (const auto& side : study.sides) excluded += side.tally.excluded;
        return fmt::format(
            "Wrong: {} of {} points are provably no equilibrium to {}; {} are proved to be.",
            excluded, points, claim(study.tolerance), proved);
    }
    if (study.conclusive())
        return fmt::format("Proved: all {} points are equilibria to {}.", points,
                           claim(study.tolerance));
    if (points == 0) return "Not proved: no point was found.";
    if (proved == points)
        return fmt::format(
            "Not all is proved: {} that were found {} to {}, but some were not found or not "
            "judged, or the curve through them is open.",
            points == 1 ? "the one point" : fmt::format("all {} points", points),
            points == 1 ? "is an equilibrium" : "are equilibria", claim(study.tolerance));
    return fmt::format(
        "Not all is proved: {} of {} points are equilibria to {}, the others are open.", proved,
        points, claim(study.tolerance));
}

std::string certify_text(const compare::CertifyStudy& study) {
    std::string all;
    const auto out = std::back_inserter(all);
    for (const auto& branch : distinct(study.sides, &compare::CertifiedSide::branch)) {
        compare::CertifyStudy of_branch = study;
        of_branch.sides = where(study.sides, &compare::CertifiedSide::branch, branch);
        fmt::format_to(out, "branch '{}'\n{}", branch, text(certify_table(of_branch)));
        bool printed = false;
        for (const auto& side : study.sides) {
            if (side.branch != branch) continue;
            const char* unit = symbol(side.unit);
            if (side.curve && side.curve->answer == compare::Answer::proved)
                fmt::format_to(out,
                               "  one curve of equilibria is proved from {:.10g} to {:.10g} {}{}\n",
                               in_unit(side.unit) * side.curve->from + 0.0,
                               in_unit(side.unit) * side.curve->to, unit,
                               side.curve->corners > 0 ? ", over corners of laws" : "");
            if (side.limit && side.limit->answer == compare::Answer::proved)
                fmt::format_to(out, "  a limit point is proved, between {:.16g} and {:.16g} {}\n",
                               in_unit(side.unit) * side.limit->from,
                               in_unit(side.unit) * side.limit->to, unit);
            for (const std::string& what :
                 {side.detail, side.tally.not_proved,
                  side.curve && side.curve->answer != compare::Answer::proved
                      ? "the curve: " + side.curve->detail
                      : std::string(),
                  side.limit && side.limit->answer != compare::Answer::proved
                      ? "the limit point: " + side.limit->detail
                      : std::string()})
                if (!what.empty()) fmt::format_to(out, "  {}: {}\n", side.solver, what);
            // The theorems of the other solvers' points hold about the same motions.
            if (!side.tally.theorem.empty() && !printed)
                fmt::format_to(out, "  {}\n", side.tally.theorem);
            printed = printed || !side.tally.theorem.empty();
        }
        all += '\n';
    }
    return all + what_is_proved(study) + "\n\n";
}

nlohmann::ordered_json certify_json(const compare::CertifyStudy& study) {
    return {{"tolerance_mm", study.tolerance.mm},
            {"tolerance_deg", study.tolerance.deg},
            {"points", study.points()},
            {"proved", study.proved()},
            {"says", sentence(study)},
            {"ways", table_json(certify_table(study))}};
}

}  // namespace elastocheck::reports
