#include "reports/tables/comparison_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "compare/comparison/elements.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/outputs/readings.hpp"
#include "compare/studies/findings.hpp"
#include "compare/warnings/lift_off.hpp"

namespace elastocheck::reports {
namespace {

using compare::Channel;
using compare::Leg;

// Share of the channel's range; "-" for a constant channel.
std::string share(double value, double range) {
    if (!(range > 1e-9)) return "-";
    if (value < 1e-9) return "0";
    const double percent = 100 * value / range;
    if (percent < 0.001) return "<0.001 %";
    if (percent > 1000) return ">1000 %";
    return percent < 10 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

// A deviation with its sign; 0 below 1e-9 of a mm, deg, N or N·m, which is rounding.
std::string signed_value(double value) {
    return std::abs(value) < 1e-9 ? "0" : fmt::format("{:+.3g}", value);
}
std::string value_or_zero(double value) {
    return std::abs(value) < 1e-9 ? "0"
           : value < 10           ? fmt::format("{:.2g}", value)
                                  : fmt::format("{:.0f}", value);
}

// Displayed channels: every main one, and the worst force and moment component of each joint.
std::vector<std::size_t> shown(const compare::Comparison& all,
                               const compare::BranchComparison& branch,
                               const compare::Reading& reading) {
    std::vector<std::size_t> rows;
    for (std::size_t c = 0; c < all.channels.size(); ++c)
        if (all.channels[c].main && branch.determined[c]) rows.push_back(c);
    for (std::size_t c = 0; c < all.channels.size(); ++c) {
        const Channel& channel = all.channels[c];
        if (channel.main || channel.kinematic() || !branch.determined[c]) continue;
        if (!rows.empty() && !all.channels[rows.back()].main &&
            all.channels[rows.back()].joints() == channel.joints() &&
            all.channels[rows.back()].unit == channel.unit) {
            if (reading.channels[c].max > reading.channels[rows.back()].max) rows.back() = c;
        } else {
            rows.push_back(c);
        }
    }
    std::erase_if(rows, [&](std::size_t c) {
        return !all.channels[c].main && reading.channels[c].max < 1e-6;
    });
    return rows;
}

void deviation_table(const compare::Comparison& all, const compare::BranchComparison& branch,
                     std::string& text) {
    const auto out = std::back_inserter(text);
    const Channel* by =
        branch.abscissa < 0 ? nullptr : &all.channels[static_cast<std::size_t>(branch.abscissa)];
    const std::string by_abscissa = compare::abscissa_reading(by == nullptr ? "" : by->name);
    const auto& load = branch.deviation.equal_parameter;
    const auto& travel = branch.deviation.equal_abscissa;
    const auto& doubt = branch.uncertainty.equal_parameter;
    if (load.channels.empty() || doubt.channels.empty()) {
        fmt::format_to(out, "  nothing compared: {}\n",
                       load.channels.empty() ? load.not_compared : doubt.not_compared);
        return;
    }
    fmt::format_to(out, "  {:<24}{:>11}   {:<36}   {:<36}   {}\n", "the recursion's", "",
                   compare::parameter_reading(symbol(branch.unit)), by_abscissa, "the references'");
    fmt::format_to(out, "  {:<24}{:>11}   {:>9}{:>9}{:>9}{:>9}   {:>9}{:>9}{:>9}{:>9}   {:>11}\n",
                   "deviation", "range", "max", fmt::format("at {}", symbol(branch.unit)), "rms",
                   "share", "max", fmt::format("at {}", by == nullptr ? "" : symbol(by->unit)),
                   "rms", "share", "uncertainty");
    for (const std::size_t c : shown(all, branch, load)) {
        const auto& d = load.channels[c];
        fmt::format_to(out, "  {:<24}{:>11.5g}   {}   ",
                       fmt::format("{} [{}]", all.channels[c].name, symbol(all.channels[c].unit)),
                       d.range, deviation_cells(d));
        if (travel.channels.empty()) {
            fmt::format_to(out, "{:<36}", "-");
        } else {
            text += deviation_cells(travel.channels[c]);
        }
        fmt::format_to(out, "   {:>11.1e}\n", doubt.channels[c].max);
    }
    if (!travel.not_compared.empty())
        fmt::format_to(out, "  {}: not compared, {}\n", by_abscissa, travel.not_compared);
    if (travel.outside > 0)
        fmt::format_to(out,
                       "  {}: {} points of the reference lie beyond the recursion's and are not "
                       "compared\n",
                       by_abscissa, travel.outside);
}

// Solver name of a run in these tables.
std::string solver_of(const compare::LegRun& run) {
    return run.method.empty() || run.method == "published" ? name(run.leg) : run.method;
}

void legs_table(const compare::BranchComparison& branch, std::string& text) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "  {:<13}{:<18}{:>8}{:>9}{:>9}{:>9}{:>10}   {}\n", "leg", "outcome",
                   "points", "factor.", "iter.", "eval.", "ms",
                   "its states in the others' equations: force N, moment N·m, constraint mm");
    for (const auto& run : branch.runs) {
        fmt::format_to(out, "  {:<13}{:<18}{:>8}{:>9}{:>9}{:>9}{:>10.1f}   ", solver_of(run),
                       elastocheck::name(run.outcome), run.curve.a.size(),
                       run.counts.factorisations, run.counts.iterations, run.counts.evaluations,
                       1e3 * run.seconds);
        for (const Leg by : compare::legs) {
            if (by == run.leg) continue;
            const auto& r = run.judged[static_cast<std::size_t>(by)];
            if (run.curve.a.empty()) continue;  // no points to judge
            if (by == Leg::energy && branch.second != Leg::energy) continue;
            fmt::format_to(out, "{}: {:.1e} {:.1e} {:.1e}   ", name(by), r.force, r.moment,
                           1e3 * r.length);
        }
        text.erase(text.find_last_not_of(' ') + 1);
        fmt::format_to(out, "\n");
    }
}

// Interval proofs of the points at the start, the middle and the ends.
void proofs(const compare::BranchComparison& branch, std::string& text) {
    std::string line;
    for (const auto& run : branch.runs) {
        const compare::Tally& t = run.proved;
        if (t.points == 0) continue;
        line += fmt::format("{} {} {} of {}", line.empty() ? "  proved:" : ",", name(run.leg),
                            t.proved, t.points);
        if (t.proved > 0) line += fmt::format(" within {:.1e} mm", 1e3 * t.error.length);
        if (t.excluded > 0)
            line += fmt::format(" ({} provably off by more than 1e-6 mm or deg)", t.excluded);
    }
    if (!line.empty()) text += line + '\n';
    std::string before;
    for (const auto& run : branch.runs) {
        const compare::Tally& t = run.proved;
        if (t.open == 0 || t.not_proved == before) continue;
        text += fmt::format("  not proved: {}: {}\n", solver_of(run), t.not_proved);
        before = t.not_proved;
    }
}

// Wheel rates, and with a tyre ride rates, of the branches that lift a wheel.
void rates(const std::vector<compare::RateError>& errors, const compare::BranchComparison& branch,
           std::string& text) {
    for (const auto& e : errors) {
        if (e.branch != branch.branch) continue;
        const auto rate = [](double k, double off) {
            return fmt::format("{:.4g} N/mm ({} %)", k, signed_value(100 * off));
        };
        text += fmt::format("  wheel rate{} from 0 to {:g} {}: {}",
                            e.wheel.empty() ? "" : " " + e.wheel, e.to, symbol(e.unit),
                            rate(e.wheel_rate, e.off));
        if (std::isfinite(e.ride_rate)) text += "; ride rate: " + rate(e.ride_rate, e.ride_off);
        text += '\n';
    }
}

// Method of "the recursion" in these tables.
std::string recursion_of(const compare::Comparison& comparison) {
    const std::string method =
        comparison.branches.empty() ? "" : comparison.branches.front().runs.front().method;
    return method.empty() || method == "published" ? "eq. (29)"
                                                   : fmt::format("the method '{}'", method);
}

std::string method_of(const compare::Comparison& comparison) {
    const std::string method =
        comparison.branches.empty() ? "" : comparison.branches.front().runs.front().method;
    return method.empty() ? "published" : method;
}

// The substitute of the energy leg, and where it is used.
std::string instead_of_energy(const compare::Comparison& comparison) {
    bool none = false, large = false;
    for (const auto& branch : comparison.branches)
        if (!branch.why_not_energy.empty()) (energy_judges_states(branch) ? large : none) = true;
    if (!none && !large) return "";
    return fmt::format(", or series where {}{}{},", none ? "no energy exists" : "",
                       none && large ? " or " : "", large ? "the scene is too large for it" : "");
}

// The judging legs where the energy leg computes no states, and the reason.
std::string not_asked(const compare::BranchComparison& branch) {
    const std::string who =
        fmt::format("  the equilibrium leg and {} judge each other", name(branch.second));
    if (!energy_judges_states(branch))
        return fmt::format("{}; no energy exists: {}\n", who, branch.why_not_energy);
    const Residuals& left = branch.runs[1].judged[static_cast<std::size_t>(compare::Leg::energy)];
    const compare::Bounds& b = branch.bounds;
    return fmt::format(
        "{}; {}\n  the energy leg judges the states: the equilibrium leg's states have residuals "
        "of {:.2g} N, {:.2g} N·m, {:.2g} mm in its equations, at most {:.2g} N, {:.2g} N·m, {:.2g} "
        "mm are allowed\n",
        who, branch.why_not_energy, left.force, left.moment, 1e3 * left.length, b.residual_force,
        b.residual_moment, b.residual_length);
}

}  // namespace

std::string deviation_cells(const compare::Deviation& d) {
    return fmt::format("{:>9}{:>9.4g}{:>9}{:>9}", signed_value(d.signed_max), d.at,
                       value_or_zero(d.rms), share(d.max, d.range));
}

std::string tables(const Model& model, const compare::Comparison& comparison) {
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "{}: the method '{}' of the linear recursion beside two full solutions\n"
        "{} coordinates, {} constraints, {} unknowns. The recursion is {}, read against "
        "the equilibrium leg;\n"
        "share: of the channel's range over the branch; uncertainty: the energy leg{} against the "
        "equilibrium leg;\n"
        "rates: of the reference, with the recursion's error.\n",
        model.name, method_of(comparison), coordinates(model), constraint_rows(model),
        coordinates(model) + constraint_rows(model), recursion_of(comparison),
        instead_of_energy(comparison));
    const auto errors = compare::rate_errors(model, comparison);
    for (std::size_t k = 0; k < comparison.branches.size(); ++k) {
        const auto& branch = comparison.branches[k];
        const auto& definition = model.branches[k];
        const double unit = in_unit(branch.unit);
        const auto& steps = branch.runs.front().curve.a;
        fmt::format_to(out, "\nbranch '{}': {:g} to {:g} {}", branch.branch, unit * definition.from,
                       unit * definition.to, symbol(branch.unit));
        if (branch.every > 1)
            fmt::format_to(out, " in {} steps, compared after each {} of a side", branch.steps,
                           branch.every);
        else if (!steps.empty())
            fmt::format_to(out, " in {} steps", steps.size() - 1);
        if (!steps.empty()) {  // in the order of the parameter
            const auto [low, high] = std::ranges::minmax(steps);
            const double length = unit * std::abs(definition.to - definition.from),
                         rounding = 1e-9 * length;
            if (high - low < length - rounding)
                fmt::format_to(out, ", reached from {:g} to {:g} {}", low, high,
                               symbol(branch.unit));
        }
        const auto& reference = branch.runs[1].curve;
        if (branch.abscissa >= 0 && !branch.deviation.equal_abscissa.channels.empty()) {
            const auto c = static_cast<std::size_t>(branch.abscissa);
            const auto rounded = [](double value) { return std::round(100 * value) / 100 + 0.0; };
            const double from = rounded(reference.values.front()[c]),
                         to = rounded(reference.values.back()[c]);
            if (from != to)  // almost constant: no range
                fmt::format_to(out, ", {} {:.2f} to {:.2f} {}", comparison.channels[c].name, from,
                               to, symbol(comparison.channels[c].unit));
        }
        fmt::format_to(out, "\n\n");
        deviation_table(comparison, branch, text);
        rates(errors, branch, text);
        for (const auto& event : compare::lift_offs(model, definition, Leg::equilibrium))
            fmt::format_to(out, "  {}\n", event.text());
        fmt::format_to(out, "\n");
        legs_table(branch, text);
        proofs(branch, text);
        if (!branch.why_not_energy.empty()) text += not_asked(branch);
        if (const auto why =
                not_determined(comparison.channels,
                               [&](std::size_t c) { return is_undefined_somewhere(c, reference); });
            !why.empty())
            fmt::format_to(out, "  {}\n", why);
        fmt::format_to(out, "  the references have to agree: {}\n",
                       compare::describe(branch.bounds));
        for (const auto& reason : branch.inconclusive.texts())
            fmt::format_to(out, "  inconclusive: {}\n", reason);
    }
    fmt::format_to(out, "\n{}: {} numbers compared.\n",
                   comparison.conclusive() ? "conclusive" : "INCONCLUSIVE", comparison.compared);
    return text;
}

std::string not_determined(std::span<const Channel> channels,
                           const std::function<bool(std::size_t)>& is_undefined) {
    std::string names, why;
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (!channels[c].joints().empty() && is_undefined(c))
            names += (names.empty() ? "" : ", ") + channels[c].name,
                why = why_undefined(channels[c]);
    return names.empty() ? "" : fmt::format("no value of {}: {}", names, why);
}

}  // namespace elastocheck::reports
