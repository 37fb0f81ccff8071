#include "reports/page/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/outputs/readings.hpp"
#include "compare/tables/rows.hpp"
#include "reports/page/common.hpp"
#include "reports/render/render.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

// Both errors, of units that the scene has: "0.11 mm and 0.00022 deg".
std::string errors(double mm, double deg) {
    std::vector<std::string> parts;
    if (std::isfinite(mm)) parts.push_back(quantity(mm, "mm"));
    if (std::isfinite(deg)) parts.push_back(quantity(deg, "deg"));
    return enumerated(parts);
}

// Largest error at equal abscissa of a method at the ends of the branches, with as many steps a branch
// or, as the study has them, fewer. A side of a two-sided branch takes half of them.
void add_across(MethodRow& row, const JsonCursor& scene, const std::vector<compare::StepRow>& steps,
                double count) {
    std::map<std::string, double> taken;  // of each side, the most that are not more
    const auto allowed = [&](const std::string& side) {
        for (const auto& branch : scene["branches"].items())
            if (branch["name"].text() == side) return count;
        return count / 2;
    };
    const auto across = [&](const compare::StepRow& r) {
        return r.method == row.method && r.reading != compare::parameter_reading("N") &&
               r.reading != compare::parameter_reading("");
    };
    for (const auto& r : steps)
        if (across(r)) {
            double& most = taken[r.branch];
            if (r.steps <= allowed(r.branch)) most = std::max(most, r.steps);
        }
    for (const auto& [side, n] : taken)
        if (n == 0) return;  // not all branches were studied with so few steps
    double mm = -1, deg = -1;
    for (const auto& r : steps) {
        const auto n = taken.find(r.branch);
        if (!across(r) || n == taken.end() || r.steps != n->second) continue;
        if (r.unit == "mm") mm = worse(mm, std::abs(r.error));
        if (r.unit == "deg") deg = worse(deg, std::abs(r.error));
    }
    if (mm >= 0) row.mm_across = mm;
    if (deg >= 0) row.deg_across = deg;
}

// The largest deviation of the published recursion; NaN without one.
double max_of(const JsonCursor& judgement, const char* key) {
    const auto worst = judgement.find(key);
    return worst ? (*worst)["max"].number() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::string trust_sentence(const JsonCursor& scene) {
    const JsonCursor verdict = scene["verdict"];
    if (!verdict["conclusive"].truth()) {
        std::string text = "Not judged: ";
        for (const auto& reason : verdict["reasons"].texts()) text += reason + "; ";
        return text + "the numbers below are no basis for a decision.";
    }
    std::vector<std::string> agreement;
    if (const auto findings = scene.find("findings"))
        if (const auto apart = findings->find("references_apart"))
            for (const char* unit : {"mm", "deg"})
                if (const auto d = apart->find(unit))
                    agreement.push_back(quantity((*d)["max"].number(), unit));
    int points = 0, proved = 0;
    if (const auto branches = scene.find("branches"))
        for (const auto& branch : branches->items())
            for (const auto& leg : branch["legs"].items())
                if (const auto proof = leg.find("proof");
                    proof && leg["leg"].text() == "equilibrium") {
                    points += (*proof)["points"].whole();
                    proved += (*proof)["proved"].whole();
                }
    std::string text =
        agreement.empty() ? "Every number on these pages is from one solution of the full equations"
                          : "Every number on these pages: two independent solutions agree to " +
                                enumerated(agreement);
    if (points > 0)
        text += proved == points ? fmt::format(", proved at {} points", whole_number(proved))
                                 : fmt::format(", proved at {} of {} points", whole_number(proved),
                                               whole_number(points));
    if (points > 0 && scene.find("proved"))  // with --quick
        text += " (the ends of the branches only)";
    text +=
        ". This is on the solvers, not on the model nor on the formulas of the outputs, which "
        "the solutions share.";
    const auto effects = scene.find("sensitivity");
    if (effects && !(*effects)["conclusive"].truth())
        text += " The effects of the scene's numbers are not confirmed.";
    return text;
}

namespace {

using compare::TradeRow;

// Of every method in the study of their cost.
std::vector<MethodRow> studied(const JsonCursor& scene, const JsonCursor& trade) {
    std::vector<MethodRow> rows;
    const auto points = read_rows<TradeRow>(trade["points"]);
    const auto study = scene.find("convergence");
    const auto steps = study ? read_rows<compare::StepRow>((*study)["step_errors"])
                             : std::vector<compare::StepRow>{};
    const auto equilibrium = std::ranges::find(points, "equilibrium", &TradeRow::leg);
    const double full = equilibrium == points.end() ? NAN : equilibrium->price;
    const auto share = [&](const TradeRow& r) {  // no looser than required
        return r.tolerance > trade["tolerance"]["mm"].number() ? INFINITY : r.share;
    };
    for (const auto& method : distinct(points, &TradeRow::method)) {
        auto wanted = where(where(points, &TradeRow::method, method), &TradeRow::leg, "recursive");
        std::erase_if(wanted, [&](const TradeRow& r) { return !std::isfinite(share(r)); });
        // the recommended one, else the cheapest that is good enough, else the cheapest of the most
        // accurate
        const TradeRow* best = nullptr;
        double least = INFINITY;
        for (const auto& r : wanted) least = std::min(least, share(r));
        for (const auto& r : wanted)
            if (share(r) <= std::max(1.0, 1.1 * least) &&
                (best == nullptr || r.price < best->price))
                best = &r;
        for (const auto& r : wanted)
            if (r.recommended) best = &r;
        if (best == nullptr) continue;
        MethodRow row{.method = method,
                      .setting = std::isfinite(best->steps)
                                     ? whole_number(std::lround(best->steps)) + "\u00a0steps"
                                 : std::isfinite(best->tolerance)
                                     ? "tolerance " + setting(best->tolerance, "mm")
                                     : "",
                      .mm = best->error,
                      .deg = best->angle_error,
                      .cost = best->price / full,
                      .within = share(*best) <= 1,
                      .chosen = best->recommended};
        add_across(row, scene, steps, best->steps);
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

std::vector<MethodRow> method_rows(const JsonCursor& scene) {
    std::vector<MethodRow> rows;
    if (const auto trade = scene.find("trade")) rows = studied(scene, *trade);
    if (const auto judgement = scene.find("judgement")) {
        rows.push_back({.method = (*judgement)["method"].text(),
                        .setting = "steps of the scene",
                        .mm = max_of(*judgement, "position"),
                        .deg = max_of(*judgement, "angle"),
                        .mm_across = max_of(*judgement, "position_across"),
                        .deg_across = max_of(*judgement, "angle_across"),
                        .within = (*judgement)["verdict"].text() == "pass"});
    }
    std::ranges::stable_sort(rows, [](const MethodRow& a, const MethodRow& b) {
        return a.within != b.within ? a.within : !(a.cost >= b.cost) && std::isfinite(a.cost);
    });
    return rows;
}

std::string tolerance_of(const JsonCursor& scene) {
    const auto trade = scene.find("trade"), judgement = scene.find("judgement");
    if (!trade && !judgement) return {};
    const JsonCursor tolerance = (trade ? *trade : *judgement)["tolerance"];
    std::vector<std::string> parts;
    for (const char* unit : {"mm", "deg"})
        if (const auto t = tolerance.find(unit)) parts.push_back(setting(t->number(), unit));
    return enumerated(parts);
}

std::string method_sentence(const JsonCursor& scene) {
    std::string text;
    if (scene.find("trade")) {
        const auto rows = method_rows(scene);
        const auto chosen = std::ranges::find_if(rows, &MethodRow::chosen);
        text = chosen != rows.end()
                   ? fmt::format(
                         "The cheapest method within {} is {}{}{}, at {} of the work of the "
                         "full solution.",
                         tolerance_of(scene), chosen->method, chosen->setting.empty() ? "" : ", ",
                         chosen->setting, percent(chosen->cost))
                   : fmt::format("No fast method that was tried is recommended within {}.",
                                 tolerance_of(scene));
    }
    const auto judgement = scene.find("judgement");
    if (!judgement) return text;
    const auto max = [&](const char* key) { return max_of(*judgement, key); };
    const std::string load = errors(max("position"), max("angle")),
                      travel = errors(max("position_across"), max("angle_across"));
    if (load.empty() && travel.empty()) return text;
    return fmt::format("{}{}The published recursion is off by up to {}{}{}{}.", text,
                       text.empty() ? "" : " ", load.empty() ? travel : load,
                       load.empty() ? " at equal travel" : " at equal load or drive",
                       load.empty() || travel.empty() ? "" : ", " + travel,
                       load.empty() || travel.empty() ? "" : " at equal travel");
}

}  // namespace elastocheck::reports
