#include "compare/tables/compare_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compare/comparison/compare.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/outputs/readings.hpp"
#include "compare/studies/findings.hpp"
#include "compare/tables/rows.hpp"
#include "compare/warnings/lift_off.hpp"
#include "elastocheck/model.hpp"

namespace elastocheck::compare {
namespace {

// Displayed channels: every main one, the worst force and moment component of each joint, and of the
// characteristics of one unit the worst, or each.
std::vector<std::size_t> shown(const Comparison& comparison, const BranchComparison& branch,
                               const Reading& reading, bool each_rate) {
    std::vector<std::size_t> rows;
    for (std::size_t c = 0; c < comparison.channels.size(); ++c)
        if (comparison.channels[c].main && branch.determined[c]) rows.push_back(c);
    for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
        const Channel& channel = comparison.channels[c];
        if (channel.main || channel.kinematic() || !branch.determined[c]) continue;
        if (!rows.empty() && !comparison.channels[rows.back()].main &&
            (!each_rate || !channel.joints().empty()) &&
            comparison.channels[rows.back()].joints() == channel.joints() &&
            comparison.channels[rows.back()].unit == channel.unit) {
            if (reading.channels[c].max > reading.channels[rows.back()].max) rows.back() = c;
        } else {
            rows.push_back(c);
        }
    }
    std::erase_if(rows, [&](std::size_t c) {
        return !comparison.channels[c].main && reading.channels[c].max < 1e-6;
    });
    return rows;
}

double share_of_range(const Deviation& d) { return d.range > 1e-9 ? d.max / d.range : nan; }

// Solver name of a run in these tables.
std::string solver_of(const LegRun& run) {
    return run.method.empty() || run.method == "published" ? name(run.leg) : run.method;
}

std::string judged_by_others(const BranchComparison& branch, const LegRun& run) {
    std::string text;
    for (const Leg judging_leg : legs) {
        if (judging_leg == run.leg || run.curve.a.empty()) continue;  // no points to judge
        if (judging_leg == Leg::energy && branch.second != Leg::energy) continue;
        const Residuals& r = run.judged[static_cast<std::size_t>(judging_leg)];
        text += fmt::format("{}{}: {:.1e} {:.1e} {:.1e}", text.empty() ? "" : "   ",
                            name(judging_leg), r.force, r.moment, 1e3 * r.length);
    }
    return text;
}

// Interval proofs of the points at the start, the middle and the ends.
void add_proofs(std::vector<std::string>& notes, const BranchComparison& branch) {
    std::string line;
    for (const auto& run : branch.runs) {
        const Tally& t = run.proved;
        if (t.points == 0) continue;
        line += fmt::format("{} {} {} of {}", line.empty() ? "proved:" : ",", name(run.leg),
                            t.proved, t.points);
        if (t.proved > 0) line += fmt::format(" within {:.1e} mm", 1e3 * t.error.length);
        if (t.excluded > 0)
            line += fmt::format(" ({} provably off by more than 1e-6 mm or deg)", t.excluded);
    }
    if (!line.empty()) notes.push_back(line);
    std::string before;
    for (const auto& run : branch.runs) {
        const Tally& t = run.proved;
        if (t.open == 0 || t.not_proved == before) continue;
        notes.push_back(fmt::format("not proved: {}: {}", solver_of(run), t.not_proved));
        before = t.not_proved;
    }
}

// Wheel rates, and with a tyre ride rates, of the branches that lift a wheel.
void add_rates(std::vector<std::string>& notes, const std::vector<RateError>& errors,
               const BranchComparison& branch) {
    for (const auto& e : errors) {
        if (e.branch != branch.branch) continue;
        const auto rate = [](double k, double off) {
            return fmt::format(
                "{:.4g} N/mm ({} %)", k,
                std::abs(100 * off) < 1e-9 ? "0" : fmt::format("{:+.3g}", 100 * off));
        };
        notes.push_back(fmt::format(
            "wheel rate{} from 0 to {:g} {}: {}{}", e.wheel.empty() ? "" : " " + e.wheel, e.to,
            symbol(e.unit), rate(e.wheel_rate, e.off),
            std::isfinite(e.ride_rate) ? "; ride rate: " + rate(e.ride_rate, e.ride_off) : ""));
    }
}

// The substitute of the energy leg, and where it is used.
std::string instead_of_energy(const Comparison& comparison) {
    bool none = false, large = false;
    for (const auto& branch : comparison.branches)
        if (!branch.why_not_energy.empty()) (energy_judges_states(branch) ? large : none) = true;
    if (!none && !large) return "";
    return fmt::format(", or series where {}{}{},", none ? "no energy exists" : "",
                       none && large ? " or " : "", large ? "the scene is too large for it" : "");
}

// The judging legs where the energy leg computes no states, and the reason.
void add_substitute(std::vector<std::string>& notes, const BranchComparison& branch) {
    const std::string who =
        fmt::format("the equilibrium leg and {} judge each other; ", name(branch.second));
    if (!energy_judges_states(branch)) {
        notes.push_back(who + "no energy exists: " + branch.why_not_energy);
        return;
    }
    notes.push_back(who + branch.why_not_energy);
    const Residuals& left = branch.runs[1].judged[static_cast<std::size_t>(Leg::energy)];
    const Bounds& b = branch.bounds;
    notes.push_back(fmt::format(
        "the energy leg judges the states: the equilibrium leg's states have residuals of {:.2g} "
        "N, {:.2g} N·m, {:.2g} mm in its equations, at most {:.2g} N, {:.2g} N·m, {:.2g} mm are "
        "allowed",
        left.force, left.moment, 1e3 * left.length, b.residual_force, b.residual_moment,
        b.residual_length));
}

// "branch 'jounce': 0 to 3000 N in 300 steps, travel 0.00 to 102.22 mm"
std::string caption_of(const Comparison& comparison, const BranchComparison& branch,
                       const Branch& requested) {
    const double unit = in_unit(branch.unit);
    const auto& steps = branch.runs.front().curve.a;
    std::string text = fmt::format("branch '{}': {:g} to {:g} {}", branch.branch,
                                   unit * requested.from, unit * requested.to, symbol(branch.unit));
    if (branch.every > 1)
        text += fmt::format(" in {} steps, compared after each {} of a side", branch.steps,
                            branch.every);
    else if (!steps.empty())
        text += fmt::format(" in {} steps", steps.size() - 1);
    if (!steps.empty()) {  // in the order of the parameter
        const auto [low, high] = std::ranges::minmax(steps);
        const double length = unit * std::abs(requested.to - requested.from);
        if (high - low < length - 1e-9 * length)
            text += fmt::format(", reached from {:g} to {:g} {}", low, high, symbol(branch.unit));
    }
    const Curve& reference = branch.runs[1].curve;
    if (branch.abscissa >= 0 && !branch.deviation.equal_abscissa.channels.empty()) {
        const auto c = static_cast<std::size_t>(branch.abscissa);
        const auto to_hundredths = [](double value) { return std::round(100 * value) / 100 + 0.0; };
        const double from = to_hundredths(reference.values.front()[c]),
                     to = to_hundredths(reference.values.back()[c]);
        if (from != to)  // almost constant: no range
            text += fmt::format(", {} {:.2f} to {:.2f} {}", comparison.channels[c].name, from, to,
                                symbol(comparison.channels[c].unit));
    }
    return text;
}

// A largest deviation of the assessment.
struct NamedWorst {
    const char *kind, *reading;
    const std::optional<Worst>* worst;
};

Table worst_of(const Assessment& a) {
    using W = NamedWorst;
    std::vector<W> rows{{"position", "parameter", &a.position},
                        {"angle", "parameter", &a.angle},
                        {"position", "abscissa", &a.position_at_abscissa},
                        {"angle", "abscissa", &a.angle_at_abscissa},
                        {"other", "parameter", &a.other},
                        {"other", "abscissa", &a.other_at_abscissa}};
    std::erase_if(rows, [](const W& row) { return !row.worst->has_value(); });
    constexpr Digits hidden = Digits::hidden;
    return table<W>(
        {.id = "worst"},
        {{"kind", hidden, &W::kind, "of the output: a position, an angle, or any other"},
         {"at equal", hidden, &W::reading},
         {"branch", hidden, [](const W& w) { return (*w.worst)->branch; }},
         {"output", hidden, [](const W& w) { return (*w.worst)->channel; }},
         {"unit", hidden, [](const W& w) { return symbol((*w.worst)->unit); }},
         {"deviation", hidden, [](const W& w) { return (*w.worst)->max; }},
         {"limit", hidden, [](const W& w) { return (*w.worst)->limit; }},
         {"share", hidden,
          [](const W& w) {
              return (*w.worst)->extent > 0 ? (*w.worst)->max / (*w.worst)->extent : nan;
          },
          "of the extent of the output"}},
        rows);
}

std::string about(const Model& model, const Comparison& comparison) {
    std::string method =
        comparison.branches.empty() ? "" : comparison.branches.front().runs.front().method;
    if (method.empty()) method = "published";
    return fmt::format(
        "{}: the method '{}' of the linear recursion beside two full solutions\n"
        "{} coordinates, {} constraints, {} unknowns. Deviation: of {} from the equilibrium leg;\n"
        "share: of the channel's range over the branch; uncertainty: the energy leg{} against the "
        "equilibrium leg;\n"
        "rates: of the reference, with the recursion's error.",
        model.name, method, coordinates(model), constraint_rows(model),
        coordinates(model) + constraint_rows(model),
        method == "published" ? "eq. (29)" : fmt::format("the method '{}'", method),
        instead_of_energy(comparison));
}

}  // namespace

// Deviations of the recursion, and the distance of the references. Readers see the unit of `at` in
// the headings.
Table deviation_table(const Comparison& comparison, const BranchComparison& branch,
                      bool each_rate) {
    using enum Digits;
    const Reading &load = branch.deviation.equal_parameter,
                  &travel = branch.deviation.equal_abscissa,
                  &doubt = branch.uncertainty.equal_parameter;
    const auto at_load = [&](std::size_t c) -> const Deviation& { return load.channels[c]; };
    Deviation none;
    none.max = none.signed_max = none.rms = none.range = none.at = nan;
    const auto at_travel = [&](std::size_t c) {
        return travel.channels.empty() ? none : travel.channels[c];
    };
    const Channel* abscissa_channel =
        branch.abscissa < 0 ? nullptr
                            : &comparison.channels[static_cast<std::size_t>(branch.abscissa)];
    const std::string over =
        abscissa_reading(abscissa_channel == nullptr ? "" : abscissa_channel->name);
    using C = std::size_t;
    const std::vector<ColumnOf<C>> columns{
        {"branch", hidden, [&](C) { return branch.branch; }},
        {"output", words, [&](C c) { return comparison.channels[c].name; }},
        {"unit", words, [&](C c) { return symbol(comparison.channels[c].unit); }},
        {"range", three, [&](C c) { return at_load(c).range; }, "of the reference over the branch"},
        {"deviation", deviation, [&](C c) { return at_load(c).signed_max; },
         "of the recursion from the equilibrium leg at equal parameter, largest over the branch",
         "", parameter_reading(symbol(branch.unit)) + ": max"},
        {"at", given, [&](C c) { return at_load(c).at; }, "parameter there", "",
         fmt::format("at {}", symbol(branch.unit))},
        {"rms", rounded, [&](C c) { return at_load(c).rms; }, "over the branch"},
        {"share", percent, [&](C c) { return share_of_range(at_load(c)); },
         "of the deviation in the range"},
        {"deviation across", deviation, [&](C c) { return at_travel(c).signed_max; },
         "likewise at equal abscissa", "", over + ": max"},
        {"at abscissa", three, [&](C c) { return at_travel(c).at; }, "abscissa there", "",
         fmt::format("at {}", abscissa_channel == nullptr ? "" : symbol(abscissa_channel->unit))},
        {"rms across", rounded, [&](C c) { return at_travel(c).rms; }, "", "", "rms"},
        {"share across", percent, [&](C c) { return share_of_range(at_travel(c)); }, "", "",
         "share"},
        {"uncertainty", size, [&](C c) { return doubt.channels[c].max; },
         "distance of the references, largest over the branch"}};
    const bool compared = !load.channels.empty() && !doubt.channels.empty();
    Table result = table({.id = "deviation"}, columns,
                         compared ? shown(comparison, branch, load, each_rate) : std::vector<C>{});
    if (!compared) {
        result.notes.push_back("nothing compared: " +
                               (load.channels.empty() ? load.not_compared : doubt.not_compared));
        return result;
    }
    if (!travel.not_compared.empty())
        result.notes.push_back(fmt::format("{}: not compared, {}", over, travel.not_compared));
    if (travel.outside > 0)
        result.notes.push_back(fmt::format(
            "{}: {} points of the reference lie beyond the recursion's and are not compared", over,
            travel.outside));
    return result;
}

Table leg_table(std::span<const BranchComparison> branches) {
    using enum Digits;
    struct OfRun {
        const BranchComparison* branch;
        const LegRun* run;
    };
    std::vector<OfRun> runs;
    for (const auto& branch : branches)
        for (const auto& run : branch.runs) runs.push_back({&branch, &run});
    return table<OfRun>(
        {.id = "legs"},
        {{"branch", hidden, [](const OfRun& o) { return o.branch->branch; }},
         {"leg", words, [](const OfRun& o) { return solver_of(*o.run); }},
         {"outcome", words, [](const OfRun& o) { return elastocheck::name(o.run->outcome); }},
         {"detail", hidden, [](const OfRun& o) { return o.run->detail; }, "of the outcome"},
         {"points", whole, [](const OfRun& o) { return o.run->curve.a.size(); }},
         {"factorisations", whole, [](const OfRun& o) { return o.run->counts.factorisations; }, "",
          "", "factor."},
         {"iterations", whole, [](const OfRun& o) { return o.run->counts.iterations; }, "", "",
          "iter."},
         {"evaluations", whole, [](const OfRun& o) { return o.run->counts.evaluations; }, "", "",
          "eval."},
         {"time", three, [](const OfRun& o) { return 1e3 * o.run->seconds; }, "", "ms"},
         {"residuals", words, [](const OfRun& o) { return judged_by_others(*o.branch, *o.run); },
          "of its states in the equations of the other legs: force [N], moment [N·m], constraint "
          "[mm]",
          "", "its states in the others' equations: force N, moment N·m, constraint mm"}},
        runs);
}

std::string not_determined(std::span<const Channel> channels,
                           const std::function<bool(std::size_t)>& is_undefined) {
    std::string names, why;
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (!channels[c].joints().empty() && is_undefined(c)) {
            names += (names.empty() ? "" : ", ") + channels[c].name;
            why = why_undefined(channels[c]);
        }
    return names.empty() ? "" : fmt::format("no value of {}: {}", names, why);
}

Result result_of(const Model& model, const Comparison& comparison, const Assessment& assessment) {
    Result result{.analysis = "compare", .about = {about(model, comparison)}};
    const auto errors = rate_errors(model, comparison);
    for (std::size_t k = 0; k < comparison.branches.size(); ++k) {
        const BranchComparison& branch = comparison.branches[k];
        Table deviation = deviation_table(comparison, branch);
        deviation.caption = caption_of(comparison, branch, model.branches[k]);
        add_rates(deviation.notes, errors, branch);
        for (const auto& event : lift_offs(model, model.branches[k], Leg::equilibrium))
            deviation.notes.push_back(event.text());
        result.tables.push_back(std::move(deviation));

        Table runs = leg_table({&branch, 1});
        add_proofs(runs.notes, branch);
        if (!branch.why_not_energy.empty()) add_substitute(runs.notes, branch);
        if (const auto why = not_determined(
                comparison.channels,
                [&](std::size_t c) { return is_undefined_somewhere(c, branch.runs[1].curve); });
            !why.empty())
            runs.notes.push_back(why);
        runs.notes.push_back("the references have to agree: " + describe(branch.bounds));
        result.tables.push_back(std::move(runs));
        for (const auto& reason : branch.inconclusive.texts())
            result.verdict.reasons.push_back(branch.branch + ": " + reason);
    }
    result.tables.push_back(worst_of(assessment));
    if (comparison.compared == 0) result.verdict.reasons.emplace_back("nothing was compared");
    result.notes.push_back(fmt::format("{}: {} numbers compared",
                                       comparison.conclusive() ? "conclusive" : "INCONCLUSIVE",
                                       comparison.compared));
    result.verdict.compared = comparison.compared;
    result.verdict.grade = !comparison.conclusive() ? Grade::not_judged : assessment.verdict;
    result.verdict.requested = assessment.requested;
    return result;
}

namespace {

Table rate_error_table(const std::vector<RateError>& errors) {
    using enum Digits;
    using E = RateError;
    return table<E>(
        {.id = "rate_errors"},
        {{"branch", words, &E::branch},
         {"wheel", words, &E::wheel},
         {"to", place, &E::to, "end of the branch"},
         {"unit", words, [](const E& e) { return symbol(e.unit); }},
         {"error", percent, &E::off, "of the recursion's wheel rate; positive is too stiff"},
         {"over", four, &E::over, "travel of the reference", "mm"},
         {"travel", deviation, &E::travel, "recursion less reference at the end", "mm"},
         {"force", deviation, &E::force, "likewise", "N"},
         {"wheel rate", four, &E::wheel_rate, "of the reference", "N/mm"},
         {"ride rate", four, &E::ride_rate, "with the tyre in series", "N/mm"},
         {"ride error", percent, &E::ride_off}},
        errors);
}

}  // namespace

void add_tables(Result& result, const Model& model, const Comparison& comparison) {
    const auto add = [&](const char* id, Table table) {
        table.id = id;
        table.detail = true;
        result.tables.push_back(std::move(table));
    };
    add("agreement", agreement_table(comparison));
    add("residuals", residual_table(comparison));
    add("proofs", proof_table(comparison));
    if (!model.wheels.empty() && !comparison.branches.empty()) {
        add("rates", table_of(characteristic_rows(comparison)));
        add("compliance", table_of(compliance_rows(model, comparison)));
    }
    add("rate_errors", rate_error_table(rate_errors(model, comparison)));
    add("forces", table_of(force_rows(model, comparison)));
    add("largest_forces", table_of(largest_force_rows(comparison)));
}

void add_definitions(Result& result, const Model& model, const Comparison& comparison) {
    const auto rows = definition_rows(model, comparison);
    for (const auto& branch : distinct(rows, &DefinitionRow::branch)) {
        Table& part =
            result.tables.emplace_back(table_of(where(rows, &DefinitionRow::branch, branch)));
        part.id = "definitions";
        part.caption =
            fmt::format("branch '{}': figures by other definitions less as defined here", branch);
    }
    result.notes.push_back(
        rows.empty()
            ? "no figure of this scene has another definition"
            : "A correct tool with another definition differs from this one by the difference.");
}

void add_formulations(Result& result, const FormulationStudy& study, const Comparison& comparison) {
    const auto rows = formulation_rows(study, comparison);
    for (const auto& branch : study.branches) {
        Table& part = result.tables.emplace_back(
            table_of(where(rows, &FormulationRow::branch, branch.branch)));
        part.id = "formulations";
        part.caption = fmt::format("branch '{}': largest less smallest value over {} formulations",
                                   branch.branch, branch.solved.size());
        for (const auto& why : branch.not_solved) part.notes.push_back("not solved: " + why);
    }
    for (const auto& why : study.inconclusive)
        result.verdict.reasons.push_back("formulations: " + why);
    result.notes.push_back(fmt::format("formulations of the bushings ({}): {}", formulations.size(),
                                       fmt::join(study.bushings, ", ")));
    if (study.conclusive())
        result.notes.push_back(
            "A correct tool with the same input may differ from this one by the spread.");
    else
        result.verdict.grade = Grade::not_judged;
}

}  // namespace elastocheck::compare
