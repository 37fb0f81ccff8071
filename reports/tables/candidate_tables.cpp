#include "reports/tables/candidate_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/outputs/readings.hpp"
#include "reports/tables/judgement.hpp"
#include "reports/text/numbers.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {
namespace {

using compare::CandidateBranch;
using compare::CandidateJudgement;
using compare::CandidateReading;
using compare::CandidateWorst;
using compare::ColumnOf;
using compare::Deviation;
using compare::Digits;
using compare::Grade;
using compare::nan;
using compare::ReadingKind;
using compare::Unit;

std::string tolerance_of(const CandidateJudgement& j) {
    return tolerance_text(j.tolerance, j.others > 0, j.tolerance_given);
}

std::string worst_of(const CandidateJudgement& j, const compare::Comparison& comparison) {
    std::string text;
    for (const CandidateWorst& w : j.worst) {
        const auto& branch =
            *std::ranges::find(comparison.branches, w.branch, &compare::BranchComparison::branch);
        const std::string abscissa =
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
                      : compare::abscissa_reading(abscissa));
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

// ---- Tables.

// A column of the candidate on one branch.
struct Row {
    const CandidateBranch* branch = nullptr;
    const compare::Channel* channel = nullptr;
    bool judged = false;
    Deviation parameter, abscissa;  // `compared` is 0 where nothing was
};

std::vector<Row> rows_of(const CandidateBranch& branch, const CandidateJudgement& j,
                         const compare::Comparison& comparison) {
    const auto deviation = [](const CandidateReading& reading, std::size_t c) {
        return reading.columns.empty() ? Deviation{} : reading.columns[c];
    };
    std::vector<Row> rows;
    for (std::size_t c = 0; c < j.columns.size(); ++c) {
        const Row row{&branch, &comparison.channels[j.columns[c].channel], j.judged[c],
                      deviation(branch.equal_parameter, c), deviation(branch.equal_abscissa, c)};
        if (row.parameter.compared + row.abscissa.compared > 0) rows.push_back(row);
    }
    return rows;
}

// Adds the columns of one reading, at equal parameter or abscissa; `place_unit` is the unit of the
// latter.
void add_reading(std::vector<ColumnOf<Row>>& columns, const std::string& kind,
                 const std::string& reading, const std::string& place_unit,
                 Deviation Row::*member) {
    const auto add = [&](const char* name, Digits digits, double Deviation::*field,
                         const char* description, const std::string& heading) {
        columns.push_back(
            {fmt::format("{} {}", name, kind), digits,
             [=](const Row& r) { return (r.*member).compared > 0 ? r.*member.*field : nan; },
             description, "", heading});
    };
    add("deviation", Digits::three, &Deviation::signed_max,
        "candidate less reference where it is largest, in the unit of the output", reading);
    add("place", Digits::given, &Deviation::at, "where it is largest: parameter or abscissa",
        fmt::format("at {}", place_unit));
    add("rms", Digits::hidden, &Deviation::rms, "root mean square over the points", "");
    add("end", Digits::hidden, &Deviation::end, "at the last point", "");
    columns.push_back({fmt::format("share {}", kind), Digits::percent,
                       [=](const Row& r) {
                           const Deviation& d = r.*member;
                           return d.compared > 0 && d.range > 0 ? d.max / d.range : nan;
                       },
                       "of the range of the output on the branch", "", "share"});
    columns.push_back({fmt::format("numbers {}", kind), Digits::hidden,
                       [=](const Row& r) { return (r.*member).compared; }, "compared"});
}

compare::Table deviations(const CandidateBranch& branch, const CandidateJudgement& j,
                          const compare::Comparison& comparison) {
    const compare::Channel* abscissa =
        branch.abscissa < 0 ? nullptr
                            : &comparison.channels[static_cast<std::size_t>(branch.abscissa)];
    const std::string load = compare::parameter_reading(symbol(branch.unit)),
                      travel = compare::abscissa_reading(abscissa == nullptr ? "" : abscissa->name);
    std::vector<ColumnOf<Row>> columns{
        {"branch", Digits::hidden, [](const Row& r) { return r.branch->branch; }},
        {"output", Digits::words, [](const Row& r) { return r.channel->name; }},
        {"unit", Digits::words, [](const Row& r) { return symbol(r.channel->unit); }},
        {"judged", Digits::words, [](const Row& r) { return r.judged ? "" : "no"; },
         "no: not a main output, or no tolerance in its unit"},
        {"range", Digits::three,
         [](const Row& r) { return std::max(r.parameter.range, r.abscissa.range); },
         "of the reference on the branch"}};
    add_reading(columns, "at equal parameter", load, symbol(branch.unit), &Row::parameter);
    add_reading(columns, "at equal abscissa", travel,
                abscissa == nullptr ? "" : symbol(abscissa->unit), &Row::abscissa);
    compare::Table table = compare::table(
        {.id = "deviations",
         .caption = fmt::format("branch '{}': {} points", branch.branch, branch.points)},
        columns, rows_of(branch, j, comparison));
    if (!std::isnan(branch.from))
        table.caption += fmt::format(" from {:.6g} to {:.6g} {}", branch.from + 0.0,
                                     branch.to + 0.0, symbol(branch.unit));
    for (const auto& [reading, how] :
         {std::pair{&branch.equal_parameter, &load}, {&branch.equal_abscissa, &travel}}) {
        if (!reading->not_compared.empty())
            table.notes.push_back(fmt::format("{}: not compared, {}", *how, reading->not_compared));
        if (reading->outside > 0)
            table.notes.push_back(fmt::format("{}: {} {} outside the range of the reference", *how,
                                              reading->outside,
                                              reading->outside == 1 ? "point lies" : "points lie"));
    }
    return table;
}

// Residuals of a state of the candidate in the equations of one leg.
struct StateRow {
    const compare::StateResiduals* source = nullptr;
    const char* leg = "";
    double a = 0;
    Residuals residuals;
};

std::vector<ColumnOf<StateRow>> columns_of_states(bool of_all) {
    const Digits digits = of_all ? Digits::hidden : Digits::size;
    return {{"branch", Digits::hidden, [](const StateRow& s) { return s.source->branch; }},
            {"equations of", of_all ? Digits::hidden : Digits::words, &StateRow::leg},
            {"parameter", of_all ? Digits::hidden : Digits::given, &StateRow::a,
             "of the state; of the largest force", "", "at"},
            {"force", digits, [](const StateRow& s) { return s.residuals.force; }, "", "N"},
            {"moment", digits, [](const StateRow& s) { return s.residuals.moment; }, "", "N·m"},
            {"constraint", digits, [](const StateRow& s) { return 1e3 * s.residuals.length; }, "",
             "mm"},
            {"direction", digits, [](const StateRow& s) { return s.residuals.direction; }}};
}

// The largest residuals of the states on a branch, and those of every state.
void add_states(const compare::StateResiduals& source, compare::Result& result) {
    std::vector<StateRow> states, largest;
    for (const auto& [leg, list] : {std::pair{"equilibrium", &source.truth},
                                    {compare::name(source.second), &source.by_second}}) {
        StateRow worst{&source, leg, nan, {}};
        for (std::size_t k = 0; k < list->size(); ++k) {
            const Residuals& r = (*list)[k];
            states.push_back({&source, leg, source.a[k], r});
            if (std::isnan(worst.a) ||
                compare::worse(r.force, worst.residuals.force) != worst.residuals.force)
                worst.a = source.a[k];
            for (double Residuals::*field :
                 {&Residuals::force, &Residuals::moment, &Residuals::length, &Residuals::direction})
                worst.residuals.*field = compare::worse(r.*field, worst.residuals.*field);
        }
        if (!list->empty()) largest.push_back(worst);
    }
    compare::Table table = compare::table(
        {.id = "states",
         .caption = fmt::format("branch '{}': its {} states in the equations of the legs",
                                source.branch, source.a.size())},
        columns_of_states(false), largest);
    if (!source.why_not.empty())
        table.notes.push_back(fmt::format("{} of its states are not judged: {}",
                                          source.truth.empty() ? "all" : "some", source.why_not));
    result.tables.push_back(std::move(table));
    result.tables.push_back(compare::table({.id = "residuals"}, columns_of_states(true), states));
}

// Largest imbalance of the states in the equilibrium leg [N], [N·m]; 0 without states;
// NaN is ignored.
std::pair<double, double> imbalance(const CandidateJudgement& j) {
    double force = 0, moment = 0;
    for (const auto& branch : j.state_residuals)
        for (const auto& residuals : branch.truth) {
            force = std::max(force, residuals.force);
            moment = std::max(moment, residuals.moment);
        }
    return {force, moment};
}

}  // namespace

std::string sentence(const CandidateJudgement& j, const compare::Comparison& comparison) {
    const std::string subject = fmt::format("the candidate ‘{}’", j.name);
    std::string remarks =
        j.not_given.empty() ? "" : fmt::format(" It does not give {}.", joined(j.not_given, 3));
    if (j.outside > 0)
        remarks += fmt::format(" {} of its points {} outside the range of the full solution.",
                               j.outside, j.outside == 1 ? "lies" : "lie");
    // Forces are judged where they have a tolerance; a state out of balance is reported
    // in any case.
    constexpr double balanced = 1e-2;  // [N], [N·m]: imbalance of poses accurate to the last digit
    const auto [force, moment] = imbalance(j);
    const bool in_balance = !(force > balanced) && !(moment > balanced);
    if (!in_balance)
        remarks += fmt::format(" Its states are out of balance by up to {:.2g} N and {:.2g} N·m.",
                               force, moment);
    if (j.others == 0 && j.has_forces) remarks += " No force or moment was compared.";
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
                    subject, j.not_given.empty() ? "" : " where it has values", tolerance_of(j),
                    remarks);
            return fmt::format("Pass: {} is within {} of the full solution{}, off by at most {}.{}",
                               subject, tolerance_of(j),
                               j.not_given.empty() ? " everywhere" : " where it has values",
                               worst_of(j, comparison), remarks);
        case Grade::fail:
            if (!j.hints.empty() && std::ranges::all_of(j.worst, [](const CandidateWorst& w) {
                    return w.max <= w.limit;
                }))
                return fmt::format("Fail: {} is not a solution: {}. The tolerance is {}.{}",
                                   subject, joined(j.hints, 4), tolerance_of(j), remarks);
            return fmt::format(
                "Fail: {} is off from the full solution by up to {}. The tolerance is {}.{}{}",
                subject, worst_of(j, comparison), tolerance_of(j), hints, remarks);
    }
    return {};
}

compare::Result result_of(const CandidateJudgement& j, const compare::Comparison& comparison) {
    compare::Result result{.analysis = "judge"};
    result.verdict = {j.verdict, sentence(j, comparison), j.reasons, j.compared};
    result.about = {
        fmt::format("candidate '{}', compared with the equilibrium leg at its own points; largest "
                    "deviations in "
                    "the units of the outputs",
                    j.name)};
    for (const auto& branch : j.branches) {
        result.tables.push_back(deviations(branch, j, comparison));
        for (const auto& states : j.state_residuals)
            if (states.branch == branch.branch) add_states(states, result);
    }
    for (const auto& missing : j.not_given) result.notes.push_back("not given: " + missing);
    for (const auto& note : j.notes) result.notes.push_back("note: " + note);
    result.notes.insert(result.notes.end(), j.hints.begin(), j.hints.end());
    result.notes.push_back(fmt::format("{} numbers compared", j.compared));
    return result;
}

}  // namespace elastocheck::reports
