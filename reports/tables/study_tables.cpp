#include "reports/tables/study_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "reports/text/escape.hpp"
#include "reports/text/readings.hpp"

namespace elastocheck::reports {
namespace {

using compare::Behaviour;
using compare::BranchAttribution;
using compare::ChannelStudy;
using compare::GapShare;
using json = nlohmann::ordered_json;

constexpr bool readings[] = {true, false};  // at equal parameter, at equal abscissa

std::string unit_of(const Model& model, const std::string& branch) {
    const auto found = std::ranges::find(model.branches, branch, &Branch::name);
    return found == model.branches.end() ? "" : symbol(compare::unit_of(found->unit));
}

// "at equal load", "at equal travel"
std::string reading_name(const Model& model, const compare::BranchStudy& branch, bool by_parameter) {
    return by_parameter ? at_equal_parameter(unit_of(model, branch.belongs_to))
                        : at_equal_abscissa(branch.abscissa);
}

// Below 1e-9 of a mm or deg it is the arithmetic's.
std::string small(double value) { return std::abs(value) < 1e-9 ? "0" : fmt::format("{:.2e}", value); }
std::string signed_small(double value) {
    return std::abs(value) < 1e-9 ? "0" : fmt::format("{:+.3e}", value);
}
std::string percent(double part, double whole) {
    return std::abs(whole) < 1e-9 ? "-" : fmt::format("{:.1f} %", 100 * part / whole);
}

std::string order(const compare::StepConvergence& c) {
    if (c.behaviour != Behaviour::converging) return name(c.behaviour);
    return std::isnan(c.order_error) ? fmt::format("{:.2f}", c.order)
                                     : fmt::format("{:.2f} ± {:.2f}", c.order, c.order_error);
}

void method_table(const Model& model, const compare::Study& study, const compare::BranchStudy& branch,
                  const compare::MethodStudy& method, std::string& text) {
    const auto out = std::back_inserter(text);
    if (!method.not_studied.empty()) {
        fmt::format_to(out, "\n  method '{}': not studied, {}\n", method.method, method.not_studied);
        return;
    }
    for (const bool load : readings) {
        const auto& reading = load ? method.equal_parameter : method.equal_abscissa;
        if (!load && reading.empty())
            fmt::format_to(out, "\n  method '{}' {}: nothing, {}\n", method.method,
                           reading_name(model, branch, load), method.no_abscissa);
        if (reading.empty()) continue;
        fmt::format_to(out,
                       "\n  method '{}' {}: step error (largest over the branch), its order, and what no "
                       "step count removes\n",
                       method.method, reading_name(model, branch, load));
        fmt::format_to(out, "  {:<22}", "steps");
        for (const int N : branch.steps) fmt::format_to(out, "{:>10}", N);
        fmt::format_to(out, "  {:>14}  {:>11} {:>9}  {:>7}  {:>9}\n", "order", "gap at end", "± band",
                       "growth", "reference");
        for (std::size_t c = 0; c < reading.size(); ++c) {
            const ChannelStudy& s = reading[c];
            fmt::format_to(out, "  {:<22}",
                           fmt::format("{} [{}]", study.channels[c].name, symbol(study.channels[c].unit)));
            for (const double error : s.step_error_max) fmt::format_to(out, "{:>10}", small(error));
            fmt::format_to(out, "  {:>14}  {:>11} {:>9}  {:>7}  {:>9}\n", order(s.end), signed_small(s.gap),
                           std::isnan(s.end.band) ? "-" : small(s.end.band),
                           std::isnan(s.gap_exponent) ? "-" : fmt::format("a^{:.1f}", s.gap_exponent),
                           fmt::format("{:.0e}", s.uncertainty));
        }
    }
    fmt::format_to(out, "  {:<22}", "|Φ|, eq. (31) [m; rad]");
    for (const double error : method.constraint_error)
        fmt::format_to(out, "{:>10}", fmt::format("{:.2e}", error));
    fmt::format_to(out, "  {:>14}\n",
                   std::isnan(method.constraint_order.order)
                       ? "at its floor"
                       : fmt::format("{:.2f} ± {:.2f}", method.constraint_order.order,
                                     method.constraint_order.order_error));
}

void attribution_table(const Model& model, const compare::Study& study, const compare::BranchStudy& branch,
                       const BranchAttribution& attribution, std::string& text) {
    const auto out = std::back_inserter(text);
    if (!attribution.not_attributed.empty()) {
        fmt::format_to(out, "\n  gap attribution: none, {}\n", attribution.not_attributed);
        return;
    }
    for (const bool load : readings) {
        const auto& shares = load ? attribution.equal_parameter : attribution.equal_abscissa;
        if (shares.empty()) continue;
        fmt::format_to(
            out, "\n  what the gap of the recursion is made of, {}: whole = lever + axis + load + rest\n",
            reading_name(model, branch, load));
        fmt::format_to(out, "  {:<22}{:>11}{:>23}{:>23}{:>23}{:>12}{:>10}\n", "", "whole",
                       "stored force's lever", "its axis and law", "load's lever", "rest", "± band");
        for (std::size_t c = 0; c < shares.size(); ++c) {
            const GapShare& s = shares[c];
            const auto part = [&](double value) {
                return fmt::format("{} {:>8}", signed_small(value), percent(value, s.whole));
            };
            fmt::format_to(out, "  {:<22}{:>11}{:>23}{:>23}{:>23}{:>12}{:>10}\n",
                           fmt::format("{} [{}]", study.channels[c].name, symbol(study.channels[c].unit)),
                           signed_small(s.whole), part(s.lever), part(s.axis), part(s.load),
                           signed_small(s.rest), small(s.band));
        }
    }
}

json channel_json(const compare::Channel& channel, const ChannelStudy& s) {
    return {{"channel", channel.name},
            {"unit", symbol(channel.unit)},
            {"behaviour", name(s.end.behaviour)},
            {"order", s.end.order},
            {"order_error", s.end.order_error},
            {"limit", s.end.limit},
            {"band", s.end.band},
            {"as_formal", s.end.as_formal},
            {"step_error_end", s.step_error_end},
            {"step_error_max", s.step_error_max},
            {"step_error_rms", s.step_error_rms},
            {"gap", s.gap},
            {"gap_max", s.gap_max},
            {"gap_rms", s.gap_rms},
            {"gap_exponent", s.gap_exponent},
            {"reference_uncertainty", s.uncertainty},
            {"range", s.range}};
}

json share_json(const compare::Channel& channel, const GapShare& s) {
    return {{"channel", channel.name},
            {"unit", symbol(channel.unit)},
            {"whole", s.whole},
            {"lever", s.lever},
            {"axis", s.axis},
            {"load", s.load},
            {"rest", s.rest},
            {"band", s.band},
            {"combinations", s.combinations}};
}

}  // namespace

std::string study_tables(const Model& model, const compare::Study& study,
                         const std::vector<BranchAttribution>& attribution) {
    std::string text = fmt::format(
        "{}\nvalue - truth = step error (to the method's own limit) + formulation gap (own limit - "
        "reference) + reference uncertainty\n",
        model.name);
    for (std::size_t b = 0; b < study.branches.size(); ++b) {
        text += fmt::format("\nbranch '{}'\n", study.branches[b].branch);
        for (const auto& method : study.branches[b].methods)
            method_table(model, study, study.branches[b], method, text);
        for (const auto& a : attribution)
            if (a.branch == study.branches[b].branch)
                attribution_table(model, study, study.branches[b], a, text);
    }
    for (const auto& reason : study.inconclusive) text += fmt::format("\ninconclusive: {}", reason);
    text += study.conclusive() ? "\nconclusive\n" : "\nINCONCLUSIVE\n";
    return text;
}

std::string study_csv(const Model& model, const compare::Study& study) {
    std::string csv =
        "branch,method,reading,channel,unit,steps,step error end,step error max,step error rms,constraint "
        "error (31) [m; rad],"
        "behaviour,order,order error,limit,band,gap,gap max,gap rms,gap exponent,reference "
        "uncertainty,range\n";
    const auto out = std::back_inserter(csv);
    for (const auto& branch : study.branches)
        for (const auto& method : branch.methods)
            for (const bool load : readings) {
                const auto& channels = load ? method.equal_parameter : method.equal_abscissa;
                const std::string reading = reading_name(model, branch, load);
                for (std::size_t c = 0; c < channels.size(); ++c)
                    for (std::size_t l = 0; l < branch.steps.size(); ++l) {
                        const ChannelStudy& s = channels[c];
                        fmt::format_to(out,
                                       "{},{},{},{},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{},{:.17g},{:.17g},"
                                       "{:.17g},{:.17g},"
                                       "{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n",
                                       for_csv(branch.branch), method.method, for_csv(reading),
                                       for_csv(study.channels[c].name), symbol(study.channels[c].unit),
                                       branch.steps[l], s.step_error_end[l], s.step_error_max[l],
                                       s.step_error_rms[l], method.constraint_error[l], name(s.end.behaviour),
                                       s.end.order, s.end.order_error, s.end.limit, s.end.band, s.gap,
                                       s.gap_max, s.gap_rms, s.gap_exponent, s.uncertainty, s.range);
                    }
            }
    return csv;
}

std::string attribution_csv(const Model& model, const compare::Study& study,
                            const std::vector<BranchAttribution>& attribution) {
    std::string csv = "branch,reading,channel,unit,whole,lever,axis,load,rest,band\n";
    for (const auto& branch : attribution)
        for (const bool load : readings) {
            const auto& shares = load ? branch.equal_parameter : branch.equal_abscissa;
            const auto studied =
                std::ranges::find(study.branches, branch.branch, &compare::BranchStudy::branch);
            if (studied == study.branches.end()) continue;
            const std::string reading = reading_name(model, *studied, load);
            for (std::size_t c = 0; c < shares.size(); ++c) {
                const GapShare& s = shares[c];
                csv += fmt::format("{},{},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n",
                                   for_csv(branch.branch), for_csv(reading), for_csv(study.channels[c].name),
                                   symbol(study.channels[c].unit), s.whole, s.lever, s.axis, s.load, s.rest,
                                   s.band);
            }
        }
    return csv;
}

json study_json(const Model& model, const compare::Study& study,
                const std::vector<BranchAttribution>& attribution) {
    json branches = json::array();
    for (const auto& branch : study.branches) {
        json methods = json::array();
        for (const auto& m : branch.methods) {
            json outcomes = json::array(), load = json::array(), travel = json::array();
            for (const auto outcome : m.outcomes) outcomes.push_back(elastocheck::name(outcome));
            for (std::size_t c = 0; c < m.equal_parameter.size(); ++c)
                load.push_back(channel_json(study.channels[c], m.equal_parameter[c]));
            for (std::size_t c = 0; c < m.equal_abscissa.size(); ++c)
                travel.push_back(channel_json(study.channels[c], m.equal_abscissa[c]));
            methods.push_back({{"method", m.method},
                               {"outcomes", outcomes},
                               {"not_studied", m.not_studied},
                               {"constraint_error", m.constraint_error},
                               {"constraint_order", m.constraint_order.order},
                               {"no_abscissa", m.no_abscissa},
                               {"at_equal_parameter", load},
                               {"at_equal_abscissa", travel}});
        }
        json shares = {{"not_attributed", "not asked for"},
                       {"at_equal_parameter", json::array()},
                       {"at_equal_abscissa", json::array()}};
        for (const auto& a : attribution) {
            if (a.branch != branch.branch) continue;
            shares["not_attributed"] = a.not_attributed;
            for (std::size_t c = 0; c < a.equal_parameter.size(); ++c)
                shares["at_equal_parameter"].push_back(share_json(study.channels[c], a.equal_parameter[c]));
            for (std::size_t c = 0; c < a.equal_abscissa.size(); ++c)
                shares["at_equal_abscissa"].push_back(share_json(study.channels[c], a.equal_abscissa[c]));
        }
        branches.push_back({{"name", branch.branch},
                            {"of", branch.belongs_to},
                            {"unit", unit_of(model, branch.belongs_to)},
                            {"abscissa", branch.abscissa.empty() ? json(nullptr) : json(branch.abscissa)},
                            {"steps", branch.steps},
                            {"methods", methods},
                            {"gap_attribution", shares}});
    }
    return {{"conclusive", study.conclusive()},
            {"reasons", study.inconclusive},
            {"steps", study.steps},
            {"branches", branches}};
}

}  // namespace elastocheck::reports
