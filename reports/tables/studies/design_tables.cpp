#include "reports/tables/studies/design_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "reports/render/render.hpp"

namespace elastocheck::reports {
namespace {

using compare::Table;
using Eigen::Index;
using Eigen::VectorXd;
using json = nlohmann::ordered_json;

// Positions in falling order of size.
std::vector<Index> largest_first(const VectorXd& values) {
    std::vector<Index> order(static_cast<std::size_t>(values.size()));
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, std::ranges::greater{}, [&](Index i) { return std::abs(values[i]); });
    return order;
}

// ---- solve-for

constexpr double least_share = 0.05;  // of a wish in a conflict

ChangedNumbers changed_numbers(const SolvedFor& solved) {
    return {solved.numbers,    solved.wishes.start, solved.solution.p,
            solved.wishes.low, solved.wishes.high,  solved.solution.at_limit};
}

Table wishes_table(const SolvedFor& solved) {
    using enum Digits;
    Table table{
        {{"output", "", "", true, words},
         {"unit", "", "", true, words},
         {"at", "", "", true, words},
         {"wanted", "", "", false, given},
         {"before", "", "", false, given},
         {"after", "", "by the equilibrium leg", false, given},
         {"by energy", "", "", false, given},
         {"by series", "", "", false, given},
         {"range", "", "movement over the ranges of the numbers, to first order", false, three},
         {"conflict", "", "share in the conflict of the wishes", false, percent}},
        {}};
    const compare::Solution& found = solved.solution;
    for (std::size_t k = 0; k < solved.wanted.size(); ++k) {
        const auto& [figure, output, place] = solved.wanted[k];
        const auto i = static_cast<Index>(k);
        table.rows.push_back({figure.name, std::string(symbol(output.unit)), place,
                              solved.wishes.target[i], found.before[i], found.after[i],
                              solved.by.energy[i], solved.by.series[i], found.movement[i],
                              found.met ? compare::nan : found.conflict[i]});
    }
    return table;
}

// The wishes that conflict, and the limits.
std::string conflict_text(const SolvedFor& solved) {
    std::vector<std::string> wishes;
    for (std::size_t k = 0; k < solved.wanted.size(); ++k)
        if (solved.solution.conflict[static_cast<Index>(k)] > least_share)
            wishes.push_back(solved.wanted[k].figure.name + " at " + solved.wanted[k].place);
    std::string text = wishes.size() > 1
                           ? fmt::format(
                                 "In conflict: {}. Within the limits the numbers move "
                                 "them only together.\n",
                                 fmt::join(wishes, "; "))
                           : fmt::format("Out of reach: {}.\n", fmt::join(wishes, "; "));
    text += limits_text(changed_numbers(solved), "wishes");
    return text;
}

// ---- fit

std::string combination(const FittedScene& fit, const VectorXd& v) {
    std::string text;
    for (const Index i : largest_first(v)) {
        if (std::abs(v[i]) < 0.05) break;
        const Number& number = fit.numbers[static_cast<std::size_t>(i)];
        text += fmt::format("{}{} {:+.4g} {}", text.empty() ? "" : ", ", number.path,
                            v[i] * fit.measured.step[i] / v.cwiseAbs().maxCoeff(), number.unit);
    }
    return text;
}

Table fitted_table(const FittedScene& fit) {
    using enum Digits;
    Table table{{{"number", "", "", true, words},
                 {"unit", "", "", true, words},
                 {"start", "", "", false, given},
                 {"fitted", "", "", false, given},
                 {"change", "", "", false, given},
                 {"+-", "", "half of the 95 % interval", false, three},
                 {"note", "", "", true, words}},
                {}};
    for (std::size_t k = 0; k < fit.numbers.size(); ++k) {
        const auto i = static_cast<Index>(k);
        const bool open = !std::isfinite(fit.fitted.interval[i]);
        table.rows.push_back({fit.numbers[k].path, fit.numbers[k].unit, fit.measured.start[i],
                              fit.fitted.p[i], fit.fitted.p[i] - fit.measured.start[i],
                              fit.fitted.interval[i],
                              std::string(fit.fitted.at_limit[k] ? "at its limit"
                                          : open                 ? "not determined"
                                                                 : "")});
    }
    return table;
}

Table columns_table(const FittedScene& fit) {
    using enum Digits;
    Table table{{{"output", "", "", true, words},
                 {"unit", "", "", true, words},
                 {"values", "", "", false, whole},
                 {"rms before", "", "of calculated less measured values", false, three},
                 {"noise", "", "estimated standard deviation of the measurements", false, three},
                 {"outliers", "", "values with a residual of more than four times the noise", false,
                  whole}},
                {}};
    for (std::size_t c = 0; c < fit.columns.size(); ++c)
        table.rows.push_back(
            {fit.columns[c].name, std::string(symbol(fit.columns[c].unit)),
             static_cast<double>(std::ranges::count(fit.measured.column, static_cast<int>(c))),
             fit.fitted.rms_before[c], fit.fitted.noise[c],
             static_cast<double>(fit.fitted.outliers[c])});
    return table;
}

std::string proposal_text(const ProposedOutput& proposed) {
    if (proposed.output.empty())
        return "No output of the scene moves with it: no load case of its branches tells it apart.";
    return fmt::format(
        "{} at {}, which was not measured, tells it apart: the change moves it by {:.3g} {}, "
        "{:.3g} "
        "% of its extent.",
        proposed.output, proposed.place, proposed.movement, proposed.unit, 100 * proposed.share);
}

double condition(const compare::Fitted& fitted) {
    const auto& S = fitted.singular_values;
    return S.size() > 0 && S[S.size() - 1] > 0 ? S[0] / S[S.size() - 1] : INFINITY;
}

// ---- tolerances

Table scatter_table(const ToleratedScene& all) {
    using enum Digits;
    Table table{{{"output", "", "", true, words},
                 {"unit", "", "", true, words},
                 {"at", "", "", true, words},
                 {"nominal", "", "", false, given},
                 {"sd", "", "standard deviation", false, three},
                 {"worst case", "", "", false, three}},
                {}};
    for (const auto& figure : all.figures)
        table.rows.push_back({figure.named.figure.name,
                              std::string(symbol(figure.named.output.unit)), figure.named.place,
                              figure.nominal, figure.scatter.sd, figure.scatter.worst_case});
    return table;
}

// The shares, largest first; `most` of each figure, 0: all.
Table shares_table(const ToleratedScene& all, std::size_t most) {
    using enum Digits;
    Table table{{{"output", "", "", true, words},
                 {"at", "", "", true, words},
                 {"tolerance", "", "", true, words},
                 {"share", "", "of the variance", false, percent}},
                {}};
    for (const auto& figure : all.figures) {
        const VectorXd& share = figure.scatter.share;
        auto order = largest_first(share);
        if (most > 0) order.resize(std::min(order.size(), most));
        for (const Index i : order)
            if (share[i] != 0)
                table.rows.push_back({figure.named.figure.name, figure.named.place,
                                      all.numbers[static_cast<std::size_t>(i)].path, share[i]});
    }
    return table;
}

}  // namespace

Table numbers_table(const ChangedNumbers& changed) {
    using enum Digits;
    const auto& [numbers, from, to, low, high, at_limit] = changed;
    Table table{{{"number", "", "", true, words},
                 {"unit", "", "", true, words},
                 {"from", "", "", false, given},
                 {"to", "", "", false, given},
                 {"change", "", "", false, given},
                 {"low", "", "lower limit", false, given},
                 {"high", "", "upper limit", false, given},
                 {"at limit", "", "the figures would come nearer beyond this limit", true, words}},
                {}};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        const auto i = static_cast<Index>(k);
        const int at = at_limit.empty() ? 0 : at_limit[k];
        table.rows.push_back({numbers[k].path, numbers[k].unit, from[i], to[i], to[i] - from[i],
                              low[i], high[i],
                              std::string(at < 0   ? "at the lower"
                                          : at > 0 ? "at the upper"
                                                   : "")});
    }
    return table;
}

std::string limits_text(const ChangedNumbers& changed, const char* what) {
    std::vector<std::string> limits;
    for (std::size_t k = 0; k < changed.numbers.size(); ++k)
        if (const int at = changed.at_limit[k]; at != 0)
            limits.push_back(
                fmt::format("{} {} {:g}", changed.numbers[k].path, at < 0 ? "below" : "above",
                            (at < 0 ? changed.low : changed.high)[static_cast<Index>(k)]));
    return limits.empty()
               ? "No limit of a number causes this: more or other numbers are needed.\n"
               : fmt::format("The {} would come nearer with {}.\n", what, fmt::join(limits, "; "));
}

std::string confirmation_text(const compare::Confirmation& by) {
    return by.confirmed
               ? "The energy leg and the series, as far as they apply, confirm the values.\n"
               : "Not confirmed: " + by.why_not + "\n";
}

std::string solve_for_text(const SolvedFor& solved) {
    const compare::Solution& solution = solved.solution;
    std::string text = reports::text(numbers_table(changed_numbers(solved))) + "\n" +
                       reports::text(wishes_table(solved)) + "\n";
    text += solution.met
                ? "All wishes are met; of all such numbers within the limits, these "
                  "change least, as shares of their ranges.\n"
                : "The wishes cannot be met; these numbers come nearest.\n" + conflict_text(solved);
    if (!solution.met && !solution.converged)
        text += "The search has not converged: there may be nearer numbers.\n";
    return text + confirmation_text(solved.by);
}

json solve_for_json(const SolvedFor& solved) {
    return {{"met", solved.solution.met},
            {"confirmed", solved.by.confirmed},
            {"not_confirmed", solved.by.why_not},
            {"converged", solved.solution.converged},
            {"numbers", table_json(numbers_table(changed_numbers(solved)))},
            {"wishes", table_json(wishes_table(solved))}};
}

std::string fit_text(const FittedScene& fit) {
    const compare::Fitted& fitted = fit.fitted;
    std::string text =
        reports::text(fitted_table(fit)) + "\n" + reports::text(columns_table(fit)) + "\n";
    const auto out = std::back_inserter(text);
    if (!fitted.converged) fmt::format_to(out, "The fit has not converged.\n");
    if (fitted.freedom < 1)
        fmt::format_to(out, "Not more values than numbers: no interval can be given.\n");
    for (Index k = 0; k < fitted.undetermined.cols(); ++k)
        fmt::format_to(out, "The data do not determine this change: {}\n  {}\n",
                       combination(fit, fitted.undetermined.col(k)),
                       proposal_text(fit.proposed[static_cast<std::size_t>(k)]));
    fmt::format_to(out, "Condition of the numbers, in steps of 1 mm or 1 %: {:.1e}\n",
                   condition(fitted));
    for (const auto& left : fit.left_out) fmt::format_to(out, "Left out: {}\n", left);
    return text;
}

json fit_json(const FittedScene& fit) {
    json undetermined = json::array();
    for (Index k = 0; k < fit.fitted.undetermined.cols(); ++k) {
        json change = json::object();
        for (std::size_t n = 0; n < fit.numbers.size(); ++n)
            change[fit.numbers[n].path] = fit.fitted.undetermined(static_cast<Index>(n), k) *
                                          fit.measured.step[static_cast<Index>(n)];
        undetermined.push_back(change);
    }
    json proposals = json::array();
    for (const ProposedOutput& one : fit.proposed) {
        if (one.output.empty())
            proposals.push_back(nullptr);
        else
            proposals.push_back({{"output", one.output},
                                 {"unit", one.unit},
                                 {"at", one.place},
                                 {"movement", one.movement},
                                 {"share_of_extent", one.share}});
    }
    return {{"converged", fit.fitted.converged},
            {"robust", fit.measured.robust},
            {"freedom", fit.fitted.freedom},
            {"condition", condition(fit.fitted)},
            {"numbers", table_json(fitted_table(fit))},
            {"outputs", table_json(columns_table(fit))},
            {"undetermined", undetermined},
            {"proposals", proposals},
            {"left_out", fit.left_out}};
}

std::string tolerances_text(const ToleratedScene& all, int most) {
    return reports::text(scatter_table(all)) + "\n" +
           reports::text(shares_table(all, static_cast<std::size_t>(most)));
}

json tolerances_json(const ToleratedScene& all) {
    return {{"figures", table_json(scatter_table(all))},
            {"shares", table_json(shares_table(all, 0))}};
}

}  // namespace elastocheck::reports
