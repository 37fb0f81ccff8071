// The price of accuracy of every method, and the recommended one, for readers.
#include <fmt/format.h>

#include <cmath>

#include "compare/result/result.hpp"
#include "compare/studies/work_precision.hpp"
#include "compare/tables/rows.hpp"

namespace elastocheck::compare {
namespace {

std::string size(const Accuracy& accuracy, bool angles) {
    return angles ? fmt::format("{:.2e} mm, {:.2e} deg", accuracy.mm, accuracy.deg)
                  : fmt::format("{:.2e} mm", accuracy.mm);
}

std::string forces(double share) {
    return fmt::format("{:.2g} % of the extent of forces and moments", 100 * share);
}

std::string words_of(const Tolerance& tolerance) {
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (std::isfinite(tolerance.mm)) add(fmt::format("{:g} mm", tolerance.mm));
    if (std::isfinite(tolerance.deg)) add(fmt::format("{:g} deg", tolerance.deg));
    if (std::isfinite(tolerance.share)) add(forces(tolerance.share));
    return text;
}

std::string sentence(const Trade& trade) {
    if (!trade.recommendation)
        return trade.inconclusive.empty()
                   ? fmt::format("For {}: no method reaches it.", words_of(trade.tolerance))
                   : "";
    const Recommendation& r = *trade.recommendation;
    const TradePoint& point = trade.points[r.point];
    return fmt::format(
        "For {}: {}, at {:.3g} of the equilibrium leg's time.\n"
        "  expected error {:.2e} mm ({:.2e} to {:.2e}){}, {}; band {}\n"
        "  confirmed at other points against a fresh reference: {}, {}; {} numbers compared",
        words_of(trade.tolerance), describe(point), point.ratio, r.expected.mm, r.low.mm, r.high.mm,
        trade.angles
            ? fmt::format(", {:.2e} deg ({:.2e} to {:.2e})", r.expected.deg, r.low.deg, r.high.deg)
            : "",
        forces(r.expected.share), r.band_from, size(r.confirmed, trade.angles),
        forces(r.confirmed.share), r.confirmed_numbers);
}

// An accuracy that the study has found or was given.
struct NamedAccuracy {
    const char* name;
    Accuracy accuracy;
};

Table accuracies(const Trade& trade) {
    const Tolerance& t = trade.tolerance;
    std::vector<NamedAccuracy> rows{{"tolerance", {t.mm, t.deg, t.share}},
                                    {"reference uncertainty", trade.uncertainty}};
    if (const auto& r = trade.recommendation)
        rows.insert(rows.end(), {{"expected error", r->expected},
                                 {"expected at least", r->low},
                                 {"expected at most", r->high},
                                 {"confirmed error", r->confirmed}});
    using Named = NamedAccuracy;
    return table<Named>(
        {.id = "accuracies"},
        {{"accuracy", Digits::hidden, &Named::name},
         {"positions", Digits::hidden, [](const Named& a) { return a.accuracy.mm; }, "", "mm"},
         {"angles", Digits::hidden,
          [&](const Named& a) { return trade.angles ? a.accuracy.deg : nan; }, "", "deg"},
         {"share", Digits::hidden, [](const Named& a) { return a.accuracy.share; },
          "of the extent of forces and moments"}},
        rows);
}

}  // namespace

Result result_of(const Model& model, const Trade& trade) {
    Result result{.analysis = "trade"};
    result.about.push_back(fmt::format(
        "{}\nEvery row produces the same {} output points on each of {} branches. Error: the worst "
        "over branches, points\nand main channels, at equal parameter, from the equilibrium leg. "
        "Reference uncertainty: {}.\nTime: of the whole solve call as a ratio to the equilibrium "
        "leg, median of {} interleaved rounds; noise {:.1f} %.\nFront: no other row is as good for "
        "fewer (s) solves, (f) factorisations + evaluations, (t) less time.",
        model.name, trade.points_per_branch, model.branches.size(),
        size(trade.uncertainty, trade.angles), trade.rounds, 100 * trade.noise));
    result.tables = {table_of(trade_rows(trade)), accuracies(trade)};
    result.tables.front().id = "trade";
    result.charts = {{.id = "precision",
                      .title = "Work for an error",
                      .table = "trade",
                      .x = "price",
                      .y = {"error"},
                      .by = {"leg", "method"},
                      .log_x = true,
                      .log_y = true}};
    for (const auto& line : trade.rejected) result.notes.push_back("not confirmed: " + line);
    const auto& r = trade.recommendation;
    result.verdict = {.grade = r && trade.inconclusive.empty() ? Grade::pass : Grade::not_judged,
                      .sentence = sentence(trade),
                      .reasons = trade.inconclusive,
                      .compared = r ? r->confirmed_numbers : 0};
    return result;
}

}  // namespace elastocheck::compare
