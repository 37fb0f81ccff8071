#include "reports/tables/certify_tables.hpp"

#include <fmt/format.h>

#include <iterator>

#include "reports/tables/select.hpp"

namespace elastocheck::reports {
namespace {

std::string claim(const compare::Tolerance& tolerance) {
    return fmt::format("{:g} mm and {:g} deg", tolerance.mm, tolerance.deg);
}

}  // namespace

const std::vector<ShownColumn> certify_columns{{"solver"},
                                               {"outcome"},
                                               {"points", Digits::whole},
                                               {"proved", Digits::whole},
                                               {"excluded", Digits::whole},
                                               {"open", Digits::whole},
                                               {"stable", Digits::whole},
                                               {"error", Digits::size, "off at most"},
                                               {"angle error", Digits::size, "at most"},
                                               {"force error", Digits::size, "at most"},
                                               {"alone", Digits::size, "alone within"},
                                               {"curve"},
                                               {"curve pieces", Digits::whole, "pieces"},
                                               {"tube", Digits::size},
                                               {"limit"}};

std::string what_is_proved(const compare::CertifyStudy& study) {
    return fmt::format(
        "Proved: by interval arithmetic, that the model's equations of balance and constraint, "
        "with the "
        "numbers stored "
        "for it taken as exact, have a solution within {} of the solver's point, and no other as "
        "near as "
        "\"alone within\" with idle motions and the sharing of redundant joints as there. "
        "Excluded: that "
        "they have none there. A proved curve has no gap between the points. Not "
        "proved: that "
        "the equations are the suspension's, or its numbers right.",
        claim(study.tolerance));
}

std::string sentence(const compare::CertifyStudy& study) {
    const int points = study.points(), proved = study.proved();
    if (study.excluded()) {
        int excluded = 0;
        for (const auto& way : study.ways) excluded += way.tally.excluded;
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
            "Not all is proved: {} that were found {} to {}, and some was not found, or not "
            "judged.",
            points == 1 ? "the one point" : fmt::format("all {} points", points),
            points == 1 ? "is an equilibrium" : "are equilibria", claim(study.tolerance));
    return fmt::format(
        "Not all is proved: {} of {} points are equilibria to {}, the others are open.", proved,
        points, claim(study.tolerance));
}

std::string certify_text(const compare::CertifyStudy& study) {
    std::string all;
    const auto out = std::back_inserter(all);
    const compare::Table table = certify_table(study);
    for (const auto& branch : distinct(table, "branch")) {
        const compare::Table rows = where(table, "branch", branch);
        fmt::format_to(out, "branch '{}'\n{}", branch,
                       text(rows, nonempty_columns(rows, certify_columns)));
        bool said = false;
        for (const auto& way : study.ways) {
            if (way.branch != branch) continue;
            const char* unit = symbol(way.unit);
            if (way.curve && way.curve->answer == compare::Answer::proved)
                fmt::format_to(
                    out, "  one curve of equilibria is proved from {:.10g} to {:.10g} {}{}\n",
                    in_unit(way.unit) * way.curve->from + 0.0, in_unit(way.unit) * way.curve->to,
                    unit, way.curve->corners > 0 ? ", over corners of laws" : "");
            if (way.limit && way.limit->answer == compare::Answer::proved)
                fmt::format_to(out, "  a limit point is proved, between {:.16g} and {:.16g} {}\n",
                               in_unit(way.unit) * way.limit->from,
                               in_unit(way.unit) * way.limit->to, unit);
            for (const std::string& what :
                 {way.detail, way.tally.not_proved,
                  way.curve && way.curve->answer != compare::Answer::proved
                      ? "the curve: " + way.curve->detail
                      : std::string(),
                  way.limit && way.limit->answer != compare::Answer::proved
                      ? "the limit point: " + way.limit->detail
                      : std::string()})
                if (!what.empty()) fmt::format_to(out, "  {}: {}\n", way.solver, what);
            // The theorems of the other solvers' points hold about the same motions.
            if (!way.tally.theorem.empty() && !said)
                fmt::format_to(out, "  {}\n", way.tally.theorem);
            said = said || !way.tally.theorem.empty();
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
