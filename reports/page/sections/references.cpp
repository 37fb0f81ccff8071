// Section: agreement of the references, by the residuals of each leg's states in the equations of
// the others.
#include <fmt/format.h>

#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::optional<Section> references_section(const JsonCursor& scene) {
    if (!scene.find("branches")) return std::nullopt;
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
                    {"constraint [mm]"}}};
    Table work{.caption = "Outcome and work of each solution",
               .columns = {{"branch", true},
                           {"solution", true},
                           {"outcome", true},
                           {"points"},
                           {"factorisations"},
                           {"iterations"},
                           {"evaluations"}}};
    Table proofs{
        .caption = scene.find("proved")
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
    bool times = false;
    for (const auto& branch : scene["branches"].items())
        for (const auto& leg : branch["legs"].items()) times = times || leg.find("seconds");
    if (times) work.columns.push_back({"time [ms]"});
    const auto channels = channels_of(scene);
    bool theorem_printed = false;  // the theorem has been printed
    for (const auto& branch : scene["branches"].items()) {
        const std::string name = branch["name"].text();
        const auto uncertainty = branch.find("reference_uncertainty");
        std::vector<std::string> row{name};
        int compared = 0;
        for (const char* unit : {"mm", "deg", "N", "N·m"}) {
            double worst = -1;
            for (const auto& channel : channels) {
                const auto d =
                    uncertainty
                        ? (*uncertainty)["at_equal_parameter"]["channels"].find(channel.name)
                        : std::nullopt;
                // A length that is not a position, such as a swing arm length near infinity, has
                // its own scale.
                const bool place = channel.unit == "mm" || channel.unit == "deg";
                if (channel.unit != unit || !d || (place && !channel.kinematic)) continue;
                compared += (*d)["compared"].whole();
                const double max = (*d)["max"].number();
                if (std::isnan(max) || max > worst) worst = max;
                if (std::isnan(worst)) break;
            }
            row.push_back(worst < 0 ? "–" : number(worst, 2));
        }
        row.push_back(whole_number(compared));
        agreement.rows.push_back(row);
        for (const auto& leg : branch["legs"].items()) {
            for (const auto& [by, residuals] : leg["residuals_by"].entries())
                if (by != leg["leg"].text())
                    judged.rows.push_back({name, leg["leg"].text(), by,
                                           number(residuals["force_N"].number(), 2),
                                           number(residuals["moment_Nm"].number(), 2),
                                           number(residuals["constraint_mm"].number(), 2)});
            if (const auto proof = leg.find("proof")) {
                const int points = (*proof)["points"].whole(), proved = (*proof)["proved"].whole();
                const auto size = [&](const char* key) {
                    return proved > 0 ? number((*proof)[key].number(), 2) : std::string("–");
                };
                proofs.rows.push_back(
                    {name, leg["leg"].text(), fmt::format("{} of {}", proved, points),
                     size("off_at_most_mm"), size("off_at_most_deg"), size("off_at_most_N"),
                     size("alone_within_mm"),
                     proved > 0 ? fmt::format("{} of {}", (*proof)["stable"].whole(), proved)
                                : std::string("–"),
                     (*proof)["not_proved"].text()});
                if (proved > 0) section.words["proofs"] = true;
                const std::string also = (*proof)["says_also"].text();
                if (!theorem_printed && !also.empty()) section.words["says_also"].push_back(also);
                theorem_printed = theorem_printed || !also.empty();
            }
            const std::string detail = leg["detail"].text();
            std::vector<std::string> cells{
                name, leg["leg"].text(),
                detail.empty() ? leg["outcome"].text()
                               : fmt::format("{}: {}", leg["outcome"].text(), detail),
                whole_number(static_cast<long>(leg["curve"]["a"].items().size()))};
            for (const char* count : {"factorisations", "iterations", "evaluations"})
                cells.push_back(whole_number(leg["counts"][count].whole()));
            if (times) cells.push_back(number(1e3 * leg["seconds"].number()));
            work.rows.push_back(cells);
        }
        if (const auto why = branch.find("energy_not_asked"); why && !why->text().empty()) {
            nlohmann::ordered_json words{{"branch", name},
                                         {"second", branch["second_reference"].text()},
                                         {"why", why->text()}};
            const auto witness = branch.find("witness");
            if (!witness) {
                section.words["no_energy"].push_back(words);
            } else {
                for (const char* of : {"left", "at_most"})
                    words[of] = fmt::format("{} N, {} N·m and {} mm",
                                            number((*witness)[of]["force_N"].number(), 2),
                                            number((*witness)[of]["moment_Nm"].number(), 2),
                                            number((*witness)[of]["constraint_mm"].number(), 2));
                section.words["witness"].push_back(words);
            }
        }
        for (const auto& reason : branch["inconclusive"].texts())
            section.words["reasons"].push_back(fmt::format("{}: {}", name, reason));
    }
    if (section.words.contains("no_energy") || section.words.contains("witness"))
        agreement.caption =
            "Difference between the second reference and the solution by equilibrium, worst over "
            "the branch";
    judged.folded = true;
    section.tables = {agreement, proofs, judged, work};
    return section;
}

}  // namespace elastocheck::reports
