#include "reports/tables/studies/study_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "reports/render/render.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Accuracy;
using compare::GapRow;
using compare::StepRow;
using compare::StudyRow;
using compare::TradePoint;

// ---- Convergence

// Levels side by side: one row per method, or method and output, one column per step count.
std::string over_steps(const std::vector<StepRow>& levels, bool by_output, double StepRow::*value,
                       const char* unit) {
    compare::Table wide;
    for (const char* key : {"method", "output", "unit"})
        if (by_output || wide.columns.empty())
            wide.columns.push_back({.name = key, .words = true, .digits = Digits::words});
    const std::size_t keys = wide.columns.size();
    const auto steps = distinct(levels, &StepRow::steps);
    for (const double n : steps)
        wide.columns.push_back(
            {.name = fmt::format("{:g}", n), .unit = unit, .digits = Digits::size});
    for (const auto& level : levels) {
        std::vector<compare::Cell> row{level.method, level.output, level.unit};
        row.resize(keys);
        auto into = std::ranges::find_if(wide.rows, [&](const auto& other) {
            return std::equal(row.begin(), row.end(), other.begin());
        });
        if (into == wide.rows.end()) {
            row.resize(keys + steps.size(), compare::nan);
            into = wide.rows.insert(into, std::move(row));
        }
        const auto at = std::ranges::find(steps, level.steps) - steps.begin();
        (*into)[keys + static_cast<std::size_t>(at)] = level.*value;
    }
    return text(wide);
}

}  // namespace

std::string study_text(const Model& model, const compare::Study& study,
                       const std::vector<compare::BranchAttribution>& attribution) {
    std::string all = fmt::format(
        "{}\nvalue - truth = step error (to the method's own limit) + formulation gap (own limit - "
        "reference) + reference uncertainty\nStudied are positions and angles; forces, moments and "
        "rates are "
        "compared by `elastocheck compare`.\n",
        model.name);
    const auto out = std::back_inserter(all);
    const auto outputs = study_rows(study);
    const auto steps = step_rows(study);
    const auto gaps = gap_rows(study.channels, attribution);
    for (const auto& branch : distinct(outputs, &StudyRow::branch)) {
        const auto levels = where(steps, &StepRow::branch, branch);
        const auto found = where(outputs, &StudyRow::branch, branch);
        for (const auto& reading : distinct(levels, &StepRow::reading))
            fmt::format_to(
                out,
                "\nbranch '{0}' {1}: order at which the largest step error over the branch falls, "
                "and what no step count removes\n{2}"
                "\nbranch '{0}' {1}: step errors, largest over the branch, over the steps\n{3}",
                branch, reading, text(where(found, &StudyRow::reading, reading)),
                over_steps(where(levels, &StepRow::reading, reading), true, &StepRow::largest, ""));
        // A candidate does not give |Φ|.
        if (std::ranges::any_of(
                levels, [](const StepRow& row) { return std::isfinite(row.constraint_error); }))
            fmt::format_to(out, "\nbranch '{}': |Φ| at its end, eq. (31), over the steps\n{}",
                           branch, over_steps(levels, false, &StepRow::constraint_error, "m"));
        const auto made = where(gaps, &GapRow::branch, branch);
        for (const auto& reading : distinct(made, &GapRow::reading))
            fmt::format_to(
                out,
                "\nbranch '{}' {}: what the gap of the recursion is made of, whole = lever + axis "
                "+ load + rest\n{}",
                branch, reading, text(where(made, &GapRow::reading, reading)));
    }
    for (const auto& reason : study.inconclusive) fmt::format_to(out, "\ninconclusive: {}", reason);
    all += study.conclusive() ? "\nconclusive\n" : "\nINCONCLUSIVE\n";
    return all;
}

json study_json(const compare::Study& study,
                const std::vector<compare::BranchAttribution>& attribution) {
    return {{"conclusive", study.conclusive()},
            {"reasons", study.inconclusive},
            {"steps", study.steps},
            {"outputs", table_json(study_rows(study))},
            {"step_errors", table_json(step_rows(study))},
            {"gap", table_json(gap_rows(study.channels, attribution))}};
}

// ---- Order of the series

std::string order_text(const std::vector<compare::OrderRow>& orders) {
    std::string all;
    const auto out = std::back_inserter(all);
    for (const auto& branch : distinct(orders, &compare::OrderRow::branch)) {
        const auto levels = where(orders, &compare::OrderRow::branch, branch);
        const compare::OrderRow &first = levels.front(), &last = levels.back();
        fmt::format_to(
            out, "\nbranch '{}', the series over its order; error to the equilibrium leg", branch);
        if (!first.not_compared.empty())
            fmt::format_to(out, ", which is none: {}\n", first.not_compared);
        else
            fmt::format_to(out, ", references {:.1e} mm, {:.1e} deg apart\n", first.apart,
                           first.angles_apart);
        all += text(levels);
        if (std::isfinite(last.singularity))  // a linear branch has none
            fmt::format_to(
                out,
                "  nearest singularity of the branch as seen from its start: at {:.3g} times its "
                "length, {:.0f}° from the direction of the branch\n",
                last.singularity, last.its_angle * 180 / std::numbers::pi);
    }
    return all;
}

// ---- Work-precision

namespace {

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
        if (trade.inconclusive.empty())
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

std::string definition_text(const std::vector<compare::DefinitionRow>& rows) {
    if (rows.empty()) return "\nno figure of this scene has another definition\n";
    std::string all;
    for (const auto& branch : distinct(rows, &compare::DefinitionRow::branch))
        all += fmt::format("\nbranch '{}': figures by other definitions less as defined here\n{}",
                           branch, text(where(rows, &compare::DefinitionRow::branch, branch)));
    return all +
           "\nA correct tool with another definition differs from this one by the difference.\n";
}

// ---- Formulations of bushings

std::string formulation_text(const compare::FormulationStudy& study,
                             const compare::Comparison& comparison) {
    std::string all;
    const auto out = std::back_inserter(all);
    fmt::format_to(out, "\nformulations of the bushings ({}): {}\n", compare::formulations.size(),
                   fmt::join(study.bushings, ", "));
    const auto rows = formulation_rows(study, comparison);
    for (const auto& branch : study.branches) {
        fmt::format_to(out, "\nbranch '{}': largest less smallest value over {} formulations\n",
                       branch.branch, branch.solved.size());
        for (const auto& why : branch.not_solved) fmt::format_to(out, "  not solved: {}\n", why);
        all += text(where(rows, &compare::FormulationRow::branch, branch.branch));
    }
    for (const auto& why : study.inconclusive) fmt::format_to(out, "  inconclusive: {}\n", why);
    if (study.conclusive())
        fmt::format_to(
            out, "\nA correct tool with the same input may differ from this one by the spread.\n");
    return all;
}

}  // namespace elastocheck::reports
