#include "reports/tables/studies/work_precision_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "compare/tables/rows.hpp"
#include "reports/tables/render.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Accuracy;
using compare::TradePoint;

std::string size(const Accuracy& accuracy, bool angles) {
    return angles ? fmt::format("{:.2e} mm, {:.2e} deg", accuracy.mm, accuracy.deg)
                  : fmt::format("{:.2e} mm", accuracy.mm);
}

std::string forces(double share) {
    return fmt::format("{:.2g} % of the extent of forces and moments", 100 * share);
}

std::string tolerance_text(const compare::Tolerance& tolerance) {
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (std::isfinite(tolerance.mm)) add(fmt::format("{:g} mm", tolerance.mm));
    if (std::isfinite(tolerance.deg)) add(fmt::format("{:g} deg", tolerance.deg));
    if (std::isfinite(tolerance.share)) add(forces(tolerance.share));
    return text;
}

json accuracy_json(const Accuracy& accuracy, bool angles) {
    json result = {{"mm", accuracy.mm}};
    result["deg"] = angles ? json(accuracy.deg) : json(nullptr);
    result["share"] = accuracy.share;
    return result;
}

void recommendation(const compare::Trade& trade, std::string& text) {
    const auto out = std::back_inserter(text);
    for (const auto& reason : trade.inconclusive) fmt::format_to(out, "INCONCLUSIVE: {}\n", reason);
    for (const auto& line : trade.rejected) fmt::format_to(out, "Not confirmed: {}\n", line);
    if (!trade.recommendation) {
        fmt::format_to(out, "For {}: no method reaches it.\n", tolerance_text(trade.tolerance));
        return;
    }
    const auto& r = *trade.recommendation;
    const TradePoint& point = trade.points[r.point];
    fmt::format_to(out, "For {}: {}, at {:.3g} of the equilibrium leg's time.\n",
                   tolerance_text(trade.tolerance), describe(point), point.ratio);
    fmt::format_to(out, "  expected error {:.2e} mm ({:.2e} to {:.2e})", r.expected.mm, r.low.mm,
                   r.high.mm);
    if (trade.angles)
        fmt::format_to(out, ", {:.2e} deg ({:.2e} to {:.2e})", r.expected.deg, r.low.deg,
                       r.high.deg);
    fmt::format_to(out, ", {}; band {}\n", forces(r.expected.share), r.band_from);
    fmt::format_to(
        out, "  confirmed at other points against a fresh reference: {}, {}; {} numbers compared\n",
        size(r.confirmed, trade.angles), forces(r.confirmed.share), r.confirmed_numbers);
}

}  // namespace

std::string trade_text(const Model& model, const compare::Trade& trade) {
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "{}\nEvery row produces the same {} output points on each of {} branches. Error: the "
        "worst over branches, points\n"
        "and main channels, at equal parameter, from the equilibrium leg. Reference uncertainty: "
        "{}.\n"
        "Time: of the whole solve call as a ratio to the equilibrium leg, median of {} "
        "interleaved rounds; noise {:.1f} %.\n"
        "Front: no other row is as good for fewer (s) solves, (f) factorisations + evaluations, "
        "(t) less time.\n\n",
        model.name, trade.points_per_branch, model.branches.size(),
        size(trade.uncertainty, trade.angles), trade.rounds, 100 * trade.noise);
    text += reports::text(trade_rows(trade)) + "\n";
    recommendation(trade, text);
    return text;
}

json trade_json(const compare::Trade& trade) {
    json chosen = nullptr;
    if (trade.recommendation) {
        const auto& r = *trade.recommendation;
        const TradePoint& point = trade.points[r.point];
        chosen = {{"position", r.point},
                  {"text", describe(point)},
                  {"method", point.method},
                  {"steps", point.steps > 0 ? json(point.steps) : json(nullptr)},
                  {"own_tolerance_m",
                   point.own_tolerance > 0 ? json(point.own_tolerance) : json(nullptr)},
                  {"factorisations", point.work.factorisations},
                  {"time_ratio", point.ratio},
                  {"expected_error", accuracy_json(r.expected, trade.angles)},
                  {"low", accuracy_json(r.low, trade.angles)},
                  {"high", accuracy_json(r.high, trade.angles)},
                  {"band_from", r.band_from},
                  {"confirmed_error", accuracy_json(r.confirmed, trade.angles)},
                  {"confirmed_numbers", r.confirmed_numbers}};
    }
    return {{"tolerance",
             {{"mm", trade.tolerance.mm},
              {"deg", trade.tolerance.deg},
              {"share", trade.tolerance.share}}},
            {"output_points", trade.points_per_branch},
            {"rounds", trade.rounds},
            {"reference_uncertainty", accuracy_json(trade.uncertainty, trade.angles)},
            {"time_noise", trade.noise},
            {"points", table_json(trade_rows(trade))},
            {"recommendation", chosen},
            {"not_confirmed", trade.rejected},
            {"inconclusive", trade.inconclusive}};
}

}  // namespace elastocheck::reports
