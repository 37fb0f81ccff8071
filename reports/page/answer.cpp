#include "reports/page/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/outputs/not_a_number.hpp"
#include "reports/page/common.hpp"
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
void add_errors_at_abscissa(MethodRow& row, const SceneAnalyses& scene,
                            const std::vector<compare::StepRow>& steps, double count) {
    std::map<std::string, double> taken;  // per side, its largest allowed number of steps
    const auto allowed = [&](const std::string& side) {
        const auto& branches = scene.comparison.branches;
        return std::ranges::find(branches, side, &compare::BranchComparison::branch) !=
                       branches.end()
                   ? count
                   : count / 2;
    };
    const auto at_abscissa = [&](const compare::StepRow& r) {
        return r.method == row.method && r.reading != compare::parameter_reading("N") &&
               r.reading != compare::parameter_reading("");
    };
    for (const auto& r : steps)
        if (at_abscissa(r)) {
            double& most = taken[r.branch];
            if (r.steps <= allowed(r.branch)) most = std::max(most, r.steps);
        }
    for (const auto& [side, n] : taken)
        if (n == 0) return;  // not all branches were studied with so few steps
    double mm = -1, deg = -1;
    for (const auto& r : steps) {
        const auto n = taken.find(r.branch);
        if (!at_abscissa(r) || n == taken.end() || r.steps != n->second) continue;
        if (r.unit == "mm") mm = compare::worse(mm, std::abs(r.error));
        if (r.unit == "deg") deg = compare::worse(deg, std::abs(r.error));
    }
    if (mm >= 0) row.mm_at_abscissa = mm;
    if (deg >= 0) row.deg_at_abscissa = deg;
}

// A deviation of the published recursion; NaN without one.
double max_of(const std::optional<compare::Worst>& worst) {
    return worst ? worst->max : compare::nan;
}

}  // namespace

std::string trust_sentence(const SceneAnalyses& scene) {
    if (!scene.conclusive()) {
        std::string text = "Not judged: ";
        for (const auto& reason : scene.reasons) text += reason + "; ";
        return text + "the numbers below are no basis for a decision.";
    }
    std::vector<std::string> agreement;
    for (const auto unit : {compare::Unit::mm, compare::Unit::deg})
        if (const auto apart = compare::worst_disagreement(scene.comparison, unit))
            agreement.push_back(quantity(apart->max, symbol(unit)));
    int points = 0, proved = 0;
    for (const auto& branch : scene.comparison.branches) {
        const compare::Tally& tally = branch.run(compare::Leg::equilibrium).proved;
        points += tally.points;
        proved += tally.proved;
    }
    std::string text =
        agreement.empty() ? "Every number on these pages is from one solution of the full equations"
                          : "Every number on these pages: two independent solutions agree to " +
                                enumerated(agreement);
    if (points > 0)
        text += proved == points ? fmt::format(", proved at {} points", whole_number(proved))
                                 : fmt::format(", proved at {} of {} points", whole_number(proved),
                                               whole_number(points));
    if (points > 0 && scene.quick) text += " (the ends of the branches only)";
    text +=
        ". This is on the solvers, not on the model nor on the formulas of the outputs, which "
        "the solutions share.";
    if (scene.effects && !scene.effects->reasons.empty())
        text += " The effects of the scene's numbers are not confirmed.";
    return text;
}

namespace {

using compare::TradeRow;

// A row for every method of the work-precision study.
std::vector<MethodRow> studied(const SceneAnalyses& scene, const compare::Trade& trade) {
    std::vector<MethodRow> rows;
    const auto points = trade_rows(trade);
    const auto steps = scene.study ? step_rows(*scene.study) : std::vector<compare::StepRow>{};
    const auto equilibrium = std::ranges::find(points, "equilibrium", &TradeRow::leg);
    const double full = equilibrium == points.end() ? NAN : equilibrium->price;
    const auto share =
        [&](const TradeRow& r) {  // infinite for a solver tolerance above the required
            return r.tolerance > trade.tolerance.mm ? INFINITY : r.share;
        };
    for (const auto& method : distinct(points, &TradeRow::method)) {
        auto wanted = where(where(points, &TradeRow::method, method), &TradeRow::leg, "recursive");
        std::erase_if(wanted, [&](const TradeRow& r) { return !std::isfinite(share(r)); });
        // the recommended one, else the cheapest that is good enough, else the cheapest of
        // the most accurate
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
        add_errors_at_abscissa(row, scene, steps, best->steps);
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

std::vector<MethodRow> method_rows(const SceneAnalyses& scene) {
    std::vector<MethodRow> rows;
    if (scene.trade) rows = studied(scene, *scene.trade);
    if (const auto& judgement = scene.judgement)
        rows.push_back({.method = judgement->method,
                        .setting = "steps of the scene",
                        .mm = max_of(judgement->position),
                        .deg = max_of(judgement->angle),
                        .mm_at_abscissa = max_of(judgement->position_at_abscissa),
                        .deg_at_abscissa = max_of(judgement->angle_at_abscissa),
                        .within = judgement->verdict == compare::Grade::pass});
    std::ranges::stable_sort(rows, [](const MethodRow& a, const MethodRow& b) {
        return a.within != b.within ? a.within : !(a.cost >= b.cost) && std::isfinite(a.cost);
    });
    return rows;
}

std::string tolerance_of(const SceneAnalyses& scene) {
    if (!scene.trade && !scene.judgement) return {};
    const auto& tolerance = scene.trade ? scene.trade->tolerance : scene.judgement->tolerance;
    std::vector<std::string> parts;
    if (std::isfinite(tolerance.mm)) parts.push_back(setting(tolerance.mm, "mm"));
    if (std::isfinite(tolerance.deg)) parts.push_back(setting(tolerance.deg, "deg"));
    return enumerated(parts);
}

std::string method_sentence(const SceneAnalyses& scene) {
    std::string text;
    if (scene.trade) {
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
    const auto& judgement = scene.judgement;
    if (!judgement) return text;
    const std::string load = errors(max_of(judgement->position), max_of(judgement->angle)),
                      travel = errors(max_of(judgement->position_at_abscissa),
                                      max_of(judgement->angle_at_abscissa));
    if (load.empty() && travel.empty()) return text;
    return fmt::format("{}{}The published recursion is off by up to {}{}{}{}.", text,
                       text.empty() ? "" : " ", load.empty() ? travel : load,
                       load.empty() ? " at equal travel" : " at equal load or drive",
                       load.empty() || travel.empty() ? "" : ", " + travel,
                       load.empty() || travel.empty() ? "" : " at equal travel");
}

}  // namespace elastocheck::reports
