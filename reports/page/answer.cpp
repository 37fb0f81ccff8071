#include "reports/page/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/outputs/readings.hpp"
#include "compare/tables/table.hpp"
#include "reports/page/common.hpp"
#include "reports/tables/render.hpp"
#include "reports/tables/select.hpp"
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

double worse(double a, double b) {
    return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN()
                                          : std::max(a, b);
}

// Largest error at equal abscissa of a method at the ends of the branches, with as many steps a branch
// or, as the study has them, fewer. A side of a two-sided branch takes half of them.
void add_across(MethodRow& row, const JsonCursor& scene, const compare::Table& steps,
                double count) {
    std::map<std::string, double> taken;  // of each side, the most that are not more
    const auto allowed = [&](const std::string& side) {
        for (const auto& branch : scene["branches"].items())
            if (branch["name"].text() == side) return count;
        return count / 2;
    };
    const auto across = [&](std::size_t r) {
        const std::string& reading = words(steps, r, "reading");
        return words(steps, r, "method") == row.method &&
               reading != compare::parameter_reading("N") &&
               reading != compare::parameter_reading("");
    };
    for (std::size_t r = 0; r < steps.rows.size(); ++r)
        if (across(r)) {
            const double n = number(steps, r, "steps");
            double& most = taken[words(steps, r, "branch")];
            if (n <= allowed(words(steps, r, "branch"))) most = std::max(most, n);
        }
    for (const auto& [side, n] : taken)
        if (n == 0) return;  // not all branches were studied with so few steps
    double mm = -1, deg = -1;
    for (std::size_t r = 0; r < steps.rows.size(); ++r) {
        const auto n = taken.find(words(steps, r, "branch"));
        if (!across(r) || n == taken.end() || number(steps, r, "steps") != n->second) continue;
        const double error = std::abs(number(steps, r, "error"));
        const std::string& unit = words(steps, r, "unit");
        if (unit == "mm") mm = worse(mm, error);
        if (unit == "deg") deg = worse(deg, error);
    }
    if (mm >= 0) row.mm_across = mm;
    if (deg >= 0) row.deg_across = deg;
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
    return text + ".";
}

namespace {

// Of every method in the study of their cost.
std::vector<MethodRow> studied(const JsonCursor& scene, const JsonCursor& trade) {
    std::vector<MethodRow> rows;
    const auto points = read_table(trade["points"], compare::trade_table({}));
    const auto study = scene.find("convergence");
    const auto steps = study ? read_table((*study)["step_errors"], compare::step_table({}))
                             : compare::step_table({});
    double full = NAN;
    for (std::size_t r = 0; r < points.rows.size() && std::isnan(full); ++r)
        if (words(points, r, "leg") == "equilibrium") full = number(points, r, "price");
    for (const auto& method : distinct(points, "method")) {
        // the recommended one, else the cheapest that is good enough, else the cheapest of the most
        // accurate
        std::optional<std::size_t> best;
        double least = INFINITY;
        const auto share = [&](std::size_t r) {
            const double own = number(points, r, "told");  // no looser than what is asked
            return 1e3 * own > trade["tolerance"]["mm"].number() ? INFINITY
                                                                 : number(points, r, "share");
        };
        const auto good = [&](std::size_t r) { return share(r) <= 1; };
        const auto wanted = [&](std::size_t r) {
            return words(points, r, "method") == method && words(points, r, "leg") == "recursive" &&
                   std::isfinite(share(r));
        };
        for (std::size_t r = 0; r < points.rows.size(); ++r)
            if (wanted(r)) least = std::min(least, share(r));
        for (std::size_t r = 0; r < points.rows.size(); ++r) {
            if (!wanted(r) || share(r) > std::max(1.0, 1.1 * least)) continue;
            if (!best || number(points, r, "price") < number(points, *best, "price")) best = r;
        }
        for (std::size_t r = 0; r < points.rows.size(); ++r)
            if (wanted(r) && words(points, r, "recommended") == "yes") best = r;
        if (!best) continue;
        const double count = number(points, *best, "steps"), own = number(points, *best, "told");
        MethodRow row{.method = method,
                      .setting = std::isfinite(count)
                                     ? whole_number(std::lround(count)) + "\u00a0steps"
                                 : std::isfinite(own) ? "tolerance " + setting(1e3 * own, "mm")
                                                      : "",
                      .mm = number(points, *best, "error"),
                      .deg = number(points, *best, "angle error"),
                      .cost = number(points, *best, "price") / full,
                      .within = good(*best),
                      .chosen = words(points, *best, "recommended") == "yes"};
        add_across(row, scene, steps, count);
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

std::vector<MethodRow> method_rows(const JsonCursor& scene) {
    std::vector<MethodRow> rows;
    if (const auto trade = scene.find("trade")) rows = studied(scene, *trade);
    if (const auto judgement = scene.find("judgement")) {
        const auto max = [&](const char* key) {
            const auto worst = judgement->find(key);
            return worst ? (*worst)["max"].number() : std::numeric_limits<double>::quiet_NaN();
        };
        rows.push_back({.method = (*judgement)["method"].text(),
                        .setting = "steps of the scene",
                        .mm = max("position"),
                        .deg = max("angle"),
                        .mm_across = max("position_across"),
                        .deg_across = max("angle_across"),
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
    const auto max = [&](const char* key) {
        const auto worst = judgement->find(key);
        return worst ? (*worst)["max"].number() : NAN;
    };
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
