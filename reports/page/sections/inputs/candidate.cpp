#include "reports/page/sections/inputs/candidate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/outputs/readings.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

std::string cell(const std::optional<JsonCursor>& deviation) {
    return deviation ? signed_number((*deviation)["signed_max"].number()) : "–";
}

// Deviations of every output that the candidate gives on a branch, beside those of the recursion.
Table beside_the_recursion(const JsonCursor& scene, const std::string& who,
                           const JsonCursor& candidate, const JsonCursor& branch) {
    const std::string name = branch["name"].text(), unit = branch["unit"].text();
    const auto abscissa = branch.find("abscissa");
    const std::string load = compare::parameter_reading(unit),
                      travel = compare::abscissa_reading(abscissa ? abscissa->text() : "");
    Table table{.caption = fmt::format("Deviation from the full solution, branch {} ({} points)",
                                       name, branch["points"].whole()),
                .columns = {{"output", true},
                            {fmt::format("{}, {}", who, load)},
                            {fmt::format("{}, {}", who, travel)},
                            {"share of the range"},
                            {"published recursion, " + load},
                            {"published recursion, " + travel}}};
    std::optional<JsonCursor> recursion;
    for (const auto& of : scene["branches"].items())
        if (of["name"].text() == name) recursion = of["deviation"];
    for (const auto& channel : candidate["channels"].items()) {
        const std::string output = channel["name"].text();
        const auto of = [&](const JsonCursor& deviation,
                            const char* reading) -> std::optional<JsonCursor> {
            const auto found = deviation.find(reading);
            if (!found) return std::nullopt;
            const auto channels = found->find("channels");
            return channels ? channels->find(output) : std::nullopt;
        };
        const auto mine = of(branch, "at_equal_parameter"),
                   across = of(branch, "at_equal_abscissa");
        if (!mine && !across) continue;
        const JsonCursor& some = mine ? *mine : *across;
        if (!channel["judged"].truth() && some["max"].number() < 1e-6) continue;
        table.rows.push_back(
            {fmt::format("{} [{}]", output, channel["unit"].text()), cell(mine), cell(across),
             some["range"].number() < 1e-9 ? "–"
                                           : percent(some["max"].number() / some["range"].number()),
             cell(recursion ? of(*recursion, "at_equal_parameter") : std::nullopt),
             cell(recursion ? of(*recursion, "at_equal_abscissa") : std::nullopt)});
    }
    return table;
}

double largest_of(const JsonCursor& list) {
    double worst = 0;
    for (const double v : list.numbers())
        if (!(v <= worst)) worst = std::isnan(worst) ? worst : v;
    return worst;
}

// Residuals of its states in the equations of the legs.
Table leftovers(const std::string& who, const JsonCursor& states) {
    Table table{
        .caption = fmt::format(
            "Largest residuals of the states of {} in the equations of the references", who),
        .columns = {{"branch", true},
                    {"equations of", true},
                    {"states"},
                    {"force [N]"},
                    {"moment [N·m]"},
                    {"constraints [mm]"}}};
    for (const auto& of : states.items()) {
        const auto row = [&](const std::string& leg, const JsonCursor& left) {
            table.rows.push_back(
                {of["branch"].text(), leg, whole_number(static_cast<long>(of["a"].items().size())),
                 number(largest_of(left["force_N"]), 2), number(largest_of(left["moment_Nm"]), 2),
                 number(largest_of(left["constraint_mm"]), 2)});
        };
        row("equilibrium", of["equilibrium"]);
        row(of["second"].text(), of["by_second"]);
    }
    return table;
}

}  // namespace

std::optional<Section> candidate_section(const JsonCursor& scene) {
    const auto candidates = scene.find("candidates");
    if (!candidates || candidates->items().empty()) return std::nullopt;
    Section section{.id = "candidate", .title = "The candidate"};
    section.mark = Mark::pass;
    nlohmann::ordered_json listed = nlohmann::ordered_json::array();
    for (const auto& candidate : candidates->items()) {
        const std::string verdict = candidate["verdict"].text();
        if (verdict == "fail")
            section.mark = Mark::fail;
        else if (verdict != "pass" && section.mark == Mark::pass)
            section.mark = Mark::open;
        listed.push_back({{"sentence", candidate["sentence"].text()},
                          {"reasons", candidate["reasons"].texts()},
                          {"notes", candidate["notes"].texts()}});
        const std::string who = candidate["name"].text();
        for (const auto& branch : candidate["branches"].items())
            if (auto table = beside_the_recursion(scene, who, candidate, branch);
                !table.rows.empty())
                section.tables.push_back(std::move(table));
        if (!candidate["states"].items().empty())
            section.tables.push_back(leftovers(who, candidate["states"]));
    }
    section.words = {{"candidates", listed}};
    return section;
}

std::vector<Series> candidate_series(const JsonCursor& scene, const Sweep& sweep,
                                     const std::string& by, const std::string& channel) {
    std::vector<Series> list;
    const auto candidates = scene.find("candidates");
    if (!candidates) return list;
    for (const auto& candidate : candidates->items()) {
        Series series{.title = candidate["name"].text(),
                      .style = Series::Style::rings,
                      .colour = green,
                      .mark = 4};
        for (const auto& branch : candidate["branches"].items()) {
            if (!sweep.has(branch["name"].text())) continue;
            const JsonCursor curve = branch["curve"];
            const auto y = curve["outputs"].find(channel);
            const auto abscissa = branch.find("abscissa");
            const bool over_abscissa = curve["over"].text() == "abscissa";
            std::optional<JsonCursor> x;
            if (over_abscissa ? abscissa && abscissa->text() == by : by.empty())
                x = curve["at"];
            else if (!by.empty())
                x = curve["outputs"].find(by);
            if (!x || !y) continue;
            const auto xs = x->numbers(), ys = y->numbers();
            if (xs.size() != ys.size()) y->fail("not as many numbers as points");
            for (const auto k : thinned(xs.size(), 21))
                if (std::isfinite(xs[k]) && std::isfinite(ys[k]))
                    series.rows.push_back({xs[k], ys[k]});
        }
        if (!series.rows.empty()) list.push_back(std::move(series));
    }
    return list;
}

}  // namespace elastocheck::reports
