#include "reports/tables/trade_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Accuracy;
using compare::TradePoint;

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.2e}", value) : "-"; }
std::string size(const Accuracy& accuracy, bool angles) {
    return angles ? fmt::format("{:.2e} mm, {:.2e} deg", accuracy.mm, accuracy.deg)
                  : fmt::format("{:.2e} mm", accuracy.mm);
}

std::string asked(const compare::Tolerance& tolerance) {
    std::string text;
    if (std::isfinite(tolerance.mm)) text += fmt::format("{:g} mm", tolerance.mm);
    if (std::isfinite(tolerance.deg))
        text += fmt::format("{}{:g} deg", text.empty() ? "" : ", ", tolerance.deg);
    return text;
}

// "40", "1e-05 m", "-"
std::string setting(const TradePoint& point) {
    if (point.steps > 0) return fmt::format("{}", point.steps);
    return point.own_tolerance > 0 ? fmt::format("{:.0e} m", point.own_tolerance) : "-";
}

std::string front(const TradePoint& point) {
    constexpr const char* letters = "sft";
    std::string text;
    for (std::size_t kind = 0; kind < 3; ++kind) text += point.on_front[kind] ? letters[kind] : ' ';
    return text;
}

json accuracy_json(const Accuracy& accuracy, bool angles) {
    json result = {{"mm", accuracy.mm}};
    result["deg"] = angles ? json(accuracy.deg) : json(nullptr);
    return result;
}

json point_json(const TradePoint& p, bool angles) {
    return {{"leg", compare::name(p.leg)},
            {"method", p.method},
            {"steps", p.steps > 0 ? json(p.steps) : json(nullptr)},
            {"own_tolerance_m", p.own_tolerance > 0 ? json(p.own_tolerance) : json(nullptr)},
            {"again", p.again},
            {"outcome", name(p.outcome)},
            {"detail", p.detail},
            {"solves", p.work.solves},
            {"factorisations", p.work.factorisations},
            {"evaluations", p.work.evaluations},
            {"seconds", p.work.seconds},
            {"time_ratio", p.ratio},
            {"error", accuracy_json(p.error, angles)},
            {"share_of_tolerance", p.share},
            {"ranked", p.ranked},
            {"not_ranked", p.not_ranked},
            {"on_front",
             {{"solves", p.on_front[0]},
              {"factorisations_and_evaluations", p.on_front[1]},
              {"time", p.on_front[2]}}}};
}

void recommendation(const compare::Trade& trade, std::string& text) {
    const auto out = std::back_inserter(text);
    for (const auto& reason : trade.inconclusive) fmt::format_to(out, "INCONCLUSIVE: {}\n", reason);
    for (const auto& line : trade.rejected) fmt::format_to(out, "Not confirmed: {}\n", line);
    if (!trade.recommendation) {
        fmt::format_to(out, "For {}: nothing here reaches it.\n", asked(trade.tolerance));
        return;
    }
    const auto& r = *trade.recommendation;
    const TradePoint& point = trade.points[r.point];
    fmt::format_to(out, "For {}: {}, at {:.3g} of the equilibrium leg's time.\n", asked(trade.tolerance),
                   describe(point), point.ratio);
    fmt::format_to(out, "  expected error {:.2e} mm ({:.2e} to {:.2e})", r.expected.mm, r.low.mm, r.high.mm);
    if (trade.angles)
        fmt::format_to(out, ", {:.2e} deg ({:.2e} to {:.2e})", r.expected.deg, r.low.deg, r.high.deg);
    fmt::format_to(
        out, "; band {}\n  confirmed at other points against a fresh reference: {}; {} numbers compared\n",
        r.band_from, size(r.confirmed, trade.angles), r.confirmed_numbers);
}

}  // namespace

std::string trade_table(const Model& model, const compare::Trade& trade) {
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "{}\nEvery row produces the same {} output points on each of {} branches. Error: the "
        "worst over branches, points\n"
        "and main channels, at equal parameter, from the equilibrium leg. Reference uncertainty: {}.\n"
        "Time: of the whole solve call as a ratio to the equilibrium leg, median of {} "
        "interleaved rounds; noise {:.1f} %.\n"
        "Front: no other row is as good for fewer (s) solves, (f) factorisations + evaluations, "
        "(t) less time.\n\n",
        model.name, trade.points_per_branch, model.branches.size(), size(trade.uncertainty, trade.angles),
        trade.rounds, 100 * trade.noise);
    fmt::format_to(out, "  {:<12}{:>9}{:>11}", "method", "steps", "error mm");
    if (trade.angles) fmt::format_to(out, "{:>11}", "error deg");
    fmt::format_to(out, "{:>9}{:>9}{:>9}{:>10}{:>9}  {:<6}{}\n", "solves", "factor.", "eval.", "ms", "ratio",
                   "front", "not ranked");
    std::string before;
    for (const auto& point : trade.points) {
        const bool first = point.method != before;
        before = point.method;
        fmt::format_to(out, "  {:<12}{:>9}{:>11}", first ? point.method : "", setting(point),
                       number(point.error.mm));
        if (trade.angles) fmt::format_to(out, "{:>11}", number(point.error.deg));
        fmt::format_to(out, "{:>9}{:>9}{:>9}", point.work.solves, point.work.factorisations,
                       point.work.evaluations);
        if (std::isfinite(point.ratio))
            fmt::format_to(out, "{:>10.3f}{:>9.3g}", 1e3 * point.work.seconds, point.ratio);
        else
            fmt::format_to(out, "{:>10}{:>9}", "-", "-");
        fmt::format_to(out, "  {:<6}{}", front(point), point.not_ranked);
        text.erase(text.find_last_not_of(' ') + 1);
        fmt::format_to(out, "\n");
    }
    fmt::format_to(out, "\n");
    recommendation(trade, text);
    return text;
}

std::string trade_csv(const compare::Trade& trade) {
    std::string csv =
        "method,again,steps,own tolerance [m],outcome,error [mm],error "
        "[deg],solves,factorisations,evaluations,"
        "time [s],time ratio,share of tolerance,ranked,front solves,front factorisations and "
        "evaluations,front time\n";
    for (const auto& p : trade.points) {
        csv +=
            fmt::format("{},{:d},{},{},{},{:.17g},{},{},{},{},{:.17g},{:.17g},{:.17g},{:d},{:d},{:d},{:d}\n",
                        p.method, p.again, p.steps > 0 ? fmt::format("{}", p.steps) : "",
                        p.own_tolerance > 0 ? fmt::format("{:g}", p.own_tolerance) : "", name(p.outcome),
                        p.error.mm, trade.angles ? fmt::format("{:.17g}", p.error.deg) : "", p.work.solves,
                        p.work.factorisations, p.work.evaluations, p.work.seconds, p.ratio, p.share, p.ranked,
                        p.on_front[0], p.on_front[1], p.on_front[2]);
    }
    return csv;
}

json trade_json(const compare::Trade& trade) {
    json points = json::array(), chosen = nullptr;
    for (const auto& point : trade.points) points.push_back(point_json(point, trade.angles));
    if (trade.recommendation) {
        const auto& r = *trade.recommendation;
        const TradePoint& point = trade.points[r.point];
        chosen = {{"position", r.point},
                  {"text", describe(point)},
                  {"method", point.method},
                  {"steps", point.steps > 0 ? json(point.steps) : json(nullptr)},
                  {"own_tolerance_m", point.own_tolerance > 0 ? json(point.own_tolerance) : json(nullptr)},
                  {"time_ratio", point.ratio},
                  {"expected_error", accuracy_json(r.expected, trade.angles)},
                  {"low", accuracy_json(r.low, trade.angles)},
                  {"high", accuracy_json(r.high, trade.angles)},
                  {"band_from", r.band_from},
                  {"confirmed_error", accuracy_json(r.confirmed, trade.angles)},
                  {"confirmed_numbers", r.confirmed_numbers}};
    }
    return {{"tolerance", {{"mm", trade.tolerance.mm}, {"deg", trade.tolerance.deg}}},
            {"output_points", trade.points_per_branch},
            {"rounds", trade.rounds},
            {"reference_uncertainty", accuracy_json(trade.uncertainty, trade.angles)},
            {"time_noise", trade.noise},
            {"points", points},
            {"recommendation", chosen},
            {"not_confirmed", trade.rejected},
            {"inconclusive", trade.inconclusive}};
}

}  // namespace elastocheck::reports
