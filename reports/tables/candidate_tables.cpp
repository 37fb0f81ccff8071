#include "reports/tables/candidate_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "compare/outputs/readings.hpp"
#include "reports/tables/comparison_tables.hpp"
#include "reports/tables/judgement.hpp"
#include "reports/render/render.hpp"
#include "reports/text/numbers.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {
namespace {

using compare::CandidateJudgement;
using compare::CandidateReading;
using compare::CandidateWorst;
using compare::Grade;
using compare::Unit;

std::string tolerance_of(const CandidateJudgement& j) {
    return tolerance_text(j.tolerance, j.others > 0, j.tolerance_given);
}

std::string worst_of(const CandidateJudgement& j, const compare::Comparison& comparison) {
    std::string text;
    for (const CandidateWorst& w : j.worst) {
        const auto& branch =
            *std::ranges::find(comparison.branches, w.branch, &compare::BranchComparison::branch);
        const std::string by =
            branch.abscissa < 0
                ? ""
                : comparison.channels[static_cast<std::size_t>(branch.abscissa)].name;
        const bool parameter = w.kind == compare::ReadingKind::equal_parameter;
        text += fmt::format(
            "{}{}{} ({}, branch {}, {})", text.empty() ? "" : " and ",
            deviation_text(w.max, w.limit, symbol(w.unit)),
            w.extent > 0 ? fmt::format(", {} of its extent", percent(w.max / w.extent)) : "",
            as_words(w.channel), w.branch,
            parameter ? compare::parameter_reading(symbol(branch.unit))
                      : compare::abscissa_reading(by));
    }
    return text;
}

std::string joined(const std::vector<std::string>& list, std::size_t most) {
    std::string text;
    for (std::size_t k = 0; k < list.size() && k < most; ++k)
        text += (k == 0 ? "" : "; ") + list[k];
    if (list.size() > most) text += fmt::format("; and {} more", list.size() - most);
    return text;
}

void leftover_line(const compare::Leftover& left, std::string& text) {
    if (left.truth.empty()) {
        text += fmt::format("  its states are not judged: {}\n", left.why_not);
        return;
    }
    const auto line = [&](const char* who, const std::vector<Residuals>& of) {
        double force = 0, moment = 0, length = 0, direction = 0, at = left.a.front();
        for (std::size_t k = 0; k < of.size(); ++k) {
            if (compare::worse(of[k].force, force) != force) at = left.a[k];
            force = compare::worse(of[k].force, force),
            moment = compare::worse(of[k].moment, moment);
            length = compare::worse(of[k].length, length),
            direction = compare::worse(of[k].direction, direction);
        }
        const auto number = [](double x) {
            return std::isnan(x) ? std::string("-") : fmt::format("{:.1e}", x);
        };
        text += fmt::format(
            "  its states in the {} leg's equations: force {} N{}, moment {} N·m, constraints {} "
            "mm, {}\n",
            who, number(force),
            std::isnan(force) ? "" : fmt::format(" (at {:.6g} {})", at, symbol(left.unit)),
            number(moment), number(1e3 * length), number(direction));
    };
    line("equilibrium", left.truth);
    line(name(left.second), left.by_second);
    if (!left.why_not.empty())
        text += fmt::format("  some of its states are not judged: {}\n", left.why_not);
}

// Largest imbalance of the states in the equilibrium leg [N], [N·m]; 0 without states; NaN is
// ignored.
std::pair<double, double> imbalance(const CandidateJudgement& j) {
    double force = 0, moment = 0;
    for (const auto& left : j.leftovers)
        for (const auto& of : left.truth)
            force = std::max(force, of.force), moment = std::max(moment, of.moment);
    return {force, moment};
}

}  // namespace

std::string sentence(const CandidateJudgement& j, const compare::Comparison& comparison) {
    const std::string who = fmt::format("the candidate ‘{}’", j.name);
    std::string partly =
        j.not_given.empty() ? "" : fmt::format(" It does not give {}.", joined(j.not_given, 3));
    if (j.outside > 0)
        partly += fmt::format(" {} of its points {} outside the range of the full solution.",
                              j.outside, j.outside == 1 ? "lies" : "lie");
    // Forces are judged where they have a tolerance; a state out of balance is reported in any
    // case.
    constexpr double balanced = 1e-2;  // [N], [N·m]: imbalance of poses accurate to the last digit
    const auto [force, moment] = imbalance(j);
    const bool in_balance = !(force > balanced) && !(moment > balanced);
    if (!in_balance)
        partly += fmt::format(" Its states are out of balance by up to {:.2g} N and {:.2g} N·m.",
                              force, moment);
    if (j.others == 0 && j.has_forces) partly += " No force or moment was compared.";
    const std::string hints = j.hints.empty() ? "" : fmt::format(" {}.", joined(j.hints, 4));
    const bool incomplete = std::ranges::all_of(j.reasons, [](const std::string& reason) {
        return reason.starts_with("it does not give ");
    });
    switch (j.verdict) {
        case Grade::not_judged:
            if (incomplete)
                return fmt::format(
                    "Not judged: it does not give {}; with --partial it is judged on what it "
                    "gives.{}",
                    joined(j.not_given, j.not_given.size()), hints);
            return not_judged(j.reasons) + hints;
        case Grade::pass:
            if (in_balance && std::ranges::all_of(j.worst, [](const CandidateWorst& w) {
                    return w.max < (w.extent > 0 ? 1e-6 * w.extent : 1e-9);
                }))
                return fmt::format(
                    "Pass: {} equals the full solution{} to round-off; the tolerance is "
                    "{}.{}",
                    who, j.not_given.empty() ? "" : " where it has values", tolerance_of(j),
                    partly);
            return fmt::format("Pass: {} is within {} of the full solution{}, off by at most {}.{}",
                               who, tolerance_of(j),
                               j.not_given.empty() ? " everywhere" : " where it has values",
                               worst_of(j, comparison), partly);
        case Grade::fail:
            if (!j.hints.empty() && std::ranges::all_of(j.worst, [](const CandidateWorst& w) {
                    return w.max <= w.limit;
                }))
                return fmt::format("Fail: {} is no solution: {}. The tolerance is {}.{}", who,
                                   joined(j.hints, 4), tolerance_of(j), partly);
            return fmt::format(
                "Fail: {} is off from the full solution by up to {}. The tolerance is {}.{}{}", who,
                worst_of(j, comparison), tolerance_of(j), hints, partly);
    }
    return {};
}

std::string candidate_text(const CandidateJudgement& j, const compare::Comparison& comparison) {
    std::string text = fmt::format(
        "candidate '{}', compared with the equilibrium leg at its own points\n", j.name);
    const auto out = std::back_inserter(text);
    for (const auto& branch : j.branches) {
        fmt::format_to(out, "\nbranch '{}': {} points", branch.branch, branch.points);
        if (!std::isnan(branch.from))
            fmt::format_to(out, " from {:.6g} to {:.6g} {}", branch.from + 0.0, branch.to + 0.0,
                           symbol(branch.unit));
        fmt::format_to(out, "\n\n");
        const compare::Channel* by =
            branch.abscissa < 0 ? nullptr
                                : &comparison.channels[static_cast<std::size_t>(branch.abscissa)];
        const CandidateReading &load = branch.equal_parameter, &travel = branch.equal_abscissa;
        const std::string by_load = compare::parameter_reading(symbol(branch.unit)),
                          by_travel = compare::abscissa_reading(by == nullptr ? "" : by->name);
        if (!load.columns.empty() || !travel.columns.empty()) {
            fmt::format_to(out, "  {:<30}{:>11}   {:<36}   {}\n", "the candidate's", "", by_load,
                           by_travel);
            fmt::format_to(
                out, "  {:<30}{:>11}   {:>9}{:>9}{:>9}{:>9}   {:>9}{:>9}{:>9}{:>9}\n", "deviation",
                "range", "max", fmt::format("at {}", symbol(branch.unit)), "rms", "share", "max",
                fmt::format("at {}", by == nullptr ? "" : symbol(by->unit)), "rms", "share");
            int hidden = 0;
            for (std::size_t c = 0; c < j.columns.size(); ++c) {
                const auto& channel = comparison.channels[j.columns[c].channel];
                const auto cells = [&](const CandidateReading& reading) {
                    if (reading.columns.empty() || reading.columns[c].compared == 0)
                        return fmt::format("{:>9}{:27}", "-", "");
                    return deviation_cells(reading.columns[c]);
                };
                const auto& some = load.columns.empty() ? travel : load;
                if (some.columns[c].compared == 0 &&
                    (travel.columns.empty() || travel.columns[c].compared == 0))
                    continue;
                const bool small = some.columns[c].max < 1e-6;
                if (!j.judged[c] && !channel.main && small) {
                    ++hidden;
                    continue;
                }
                fmt::format_to(out, "  {:<30}{:>11.5g}   {}   {}\n",
                               fmt::format("{} [{}]{}", channel.name, symbol(channel.unit),
                                           j.judged[c] ? "" : " *"),
                               some.columns[c].range, cells(load), cells(travel));
            }
            text = text.substr(0, text.find_last_not_of(" \n") + 1) + "\n";
            if (std::ranges::find(j.judged, false) != j.judged.end())
                fmt::format_to(
                    out, "  * not judged: no main output, or no tolerance in its unit{}\n",
                    hidden > 0 ? fmt::format("; {} more have errors below 1e-6", hidden) : "");
        }
        for (const auto& [reading, how] : {std::pair{&load, &by_load}, {&travel, &by_travel}}) {
            if (!reading->not_compared.empty())
                fmt::format_to(out, "  {}: not compared, {}\n", *how, reading->not_compared);
            if (reading->outside > 0)
                fmt::format_to(out, "  {}: {} points lie outside the range of the reference\n",
                               *how, reading->outside);
        }
        for (const auto& left : j.leftovers)
            if (left.branch == branch.branch) leftover_line(left, text);
    }
    fmt::format_to(out, "\n");
    for (const auto& missing : j.not_given) fmt::format_to(out, "  not given: {}\n", missing);
    for (const auto& note : j.notes) fmt::format_to(out, "  note: {}\n", note);
    for (const auto& hint : j.hints) fmt::format_to(out, "  {}\n", hint);
    for (const auto& reason : j.reasons) fmt::format_to(out, "  could not judge: {}\n", reason);
    fmt::format_to(out, "{} numbers compared.\n\n", j.compared);
    return text;
}

}  // namespace elastocheck::reports
