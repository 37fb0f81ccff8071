#include "compare/design/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <ranges>

#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using enum Digits;

constexpr double min_share = 0.05;  // of a figure in a conflict, of a number in a combination

using Columns = std::vector<ColumnOf<Index>>;  // of rows by their positions
Table rows_of(const char* id, Index count, const Columns& columns) {
    return table({.id = id}, columns, std::views::iota(Index{0}, count));
}
template <class Item>
const Item& item(const std::vector<Item>& list, Index k) {
    return list[static_cast<std::size_t>(k)];
}

// Positions in falling order of size.
std::vector<Index> largest_first(const VectorXd& values) {
    std::vector<Index> order(static_cast<std::size_t>(values.size()));
    std::iota(order.begin(), order.end(), Index{0});
    std::ranges::stable_sort(order, std::ranges::greater{},
                             [&](Index i) { return std::abs(values[i]); });
    return order;
}

// Numbers of a scene before and after a search. `interval` may be empty.
Table numbers_table(const Varied& varied, const VectorXd& to, const VectorXd& interval,
                    const std::function<const char*(std::size_t)>& note) {
    return rows_of("numbers", to.size(),
                   {{"number", words, [&](Index k) { return item(varied.numbers, k).path; }},
                    {"unit", words, [&](Index k) { return item(varied.numbers, k).unit; }},
                    {"from", given, [&](Index k) { return varied.start[k]; }},
                    {"to", given, [&](Index k) { return to[k]; }},
                    {"change", given, [&](Index k) { return to[k] - varied.start[k]; }},
                    {"+-", three, [&](Index k) { return interval.size() > 0 ? interval[k] : nan; },
                     "half of the 95 % interval"},
                    {"low", given, [&](Index k) { return varied.low[k]; }, "lower limit"},
                    {"high", given, [&](Index k) { return varied.high[k]; }, "upper limit"},
                    {"note", words, [&](Index k) { return note(static_cast<std::size_t>(k)); },
                     "at a limit: the figures would come nearer beyond it"}});
}
// `at_limit` of Solution; empty: none is.
Table numbers_table(const Varied& varied, const VectorXd& to, const std::vector<int>& at_limit) {
    return numbers_table(varied, to, {}, [&](std::size_t k) {
        const int at = at_limit.empty() ? 0 : at_limit[k];
        return at < 0 ? "at the lower limit" : at > 0 ? "at the upper limit" : "";
    });
}

// Notes what prevents a solution: the `conflicting` wishes or bands, followed by `together` if
// there are several, and limits of numbers. `noun`: "bands".
void add_conflict(Result& result, const std::vector<std::string>& conflicting,
                  const std::string& together, const Varied& varied,
                  const std::vector<int>& at_limit, const char* noun) {
    result.notes.push_back(
        fmt::format("{}: {}.{}", conflicting.size() > 1 ? "In conflict" : "Out of reach",
                    fmt::join(conflicting, "; "), conflicting.size() > 1 ? together : ""));
    std::vector<std::string> limits;
    for (std::size_t k = 0; k < at_limit.size(); ++k)
        if (const auto i = static_cast<Index>(k); at_limit[k] != 0)
            limits.push_back(fmt::format("{} {} {:g}", varied.numbers[k].path,
                                         at_limit[k] < 0 ? "below" : "above",
                                         (at_limit[k] < 0 ? varied.low : varied.high)[i]));
    result.notes.push_back(
        limits.empty()
            ? "No limit of a number causes this: more or other numbers are needed."
            : fmt::format("The {} would come nearer with {}.", noun, fmt::join(limits, "; ")));
}

// Without convergence the numbers are neither known to be the nearest ones (not met) nor those of
// the smallest change (met).
Grade grade_of(bool met, bool converged) {
    return !converged ? Grade::not_judged : met ? Grade::pass : Grade::fail;
}

void set_confirmation(Result& result, const Confirmation& by, Grade otherwise) {
    result.verdict.grade = by.confirmed ? otherwise : Grade::not_judged;
    if (by.confirmed)
        result.notes.emplace_back(
            "The energy leg and the series, as far as they apply, confirm the values.");
    else
        result.verdict.reasons.push_back("not confirmed: " + by.why_not);
}

// ---- optimise

// The value of a goal that is nearest to leaving the band, or furthest outside; of its `values`.
double worst_of(const Goal& goal, const VectorXd& values) {
    double largest_excess = -INFINITY, worst = nan;
    for (const double value : values)
        if (const double excess = std::max(goal.low - value, value - goal.high);
            excess > largest_excess) {
            largest_excess = excess;
            worst = value;
        }
    return worst;
}
double largest_difference(const VectorXd& a, const VectorXd& b) {
    double largest = nan;
    for (const double difference : (a - b).cwiseAbs().eval())
        if (std::isfinite(difference) && !(difference <= largest)) largest = difference;
    return largest;
}

Table goals_table(const OptimisedScene& scene) {
    const Optimum& optimum = scene.optimum;
    // the values of a goal's points
    const auto values_of = [&](const VectorXd& values, Index goal) -> VectorXd {
        Index first = 0;
        for (Index g = 0; g < goal; ++g) first += std::ssize(item(scene.goals, g).points);
        return values.segment(first, std::ssize(item(scene.goals, goal).points));
    };
    const auto goal = [&](Index g) -> const Goal& { return item(scene.goals, g); };
    return rows_of(
        "goals", std::ssize(scene.goals),
        {{"output", words, [&](Index g) { return goal(g).output(); }},
         {"unit", words, [&](Index g) { return goal(g).points.front().unit; }},
         {"at", words, [&](Index g) { return goal(g).where; }},
         {"points", whole, [&](Index g) { return std::ssize(goal(g).points); }},
         {"low", given, [&](Index g) { return goal(g).low; }, "lower bound"},
         {"high", given, [&](Index g) { return goal(g).high; }, "upper bound"},
         {"before", given,
          [&](Index g) { return worst_of(goal(g), values_of(optimum.start.value, g)); },
          "value nearest to leaving the band, or furthest outside"},
         {"after", given, [&](Index g) { return worst_of(goal(g), values_of(optimum.after, g)); },
          "likewise, by the equilibrium leg"},
         {"energy differs", size,
          [&](Index g) {
              return largest_difference(values_of(scene.by.energy, g), values_of(optimum.after, g));
          },
          "largest difference of the energy leg"},
         {"series differs", size,
          [&](Index g) {
              return largest_difference(values_of(scene.by.series, g), values_of(optimum.after, g));
          },
          "largest difference of the series"},
         {"conflict", percent,
          [&](Index g) { return optimum.met ? nan : values_of(optimum.conflict, g).sum(); },
          "share in the conflict of the bands"}});
}

std::string bound_text(const OptimisedScene& scene, const Bound& bound) {
    const char* sign = bound.upper ? "<=" : ">=";
    if (bound.of_number) {
        const Number& number = item(scene.varied.numbers, bound.index);
        return fmt::format("{} {} {:g} {}", number.path, sign, bound.bound, number.unit);
    }
    const Figure& figure = item(scene.figures, bound.index);
    return fmt::format("{}{} {} {:g} {} at {}", figure.name, figure.change ? " (change)" : "", sign,
                       bound.bound, figure.unit, figure.station_text);
}

// Amount by which a bound is relaxed when its price is stated: a power of ten, up to a tenth of the
// band or a hundredth of what the numbers move; of a number 1 mm or 1 %.
double relaxed_by(const OptimisedScene& scene, const Bound& bound) {
    if (bound.of_number) return step_of(item(scene.varied.numbers, bound.index));
    Index first = 0;
    const auto goal = std::ranges::find_if(scene.goals, [&](const Goal& candidate) {
        return bound.index < (first += std::ssize(candidate.points));
    });
    const double width = goal->high - goal->low;
    const double largest =
        std::isfinite(width) ? width / 10 : scene.optimum.scale[bound.index] / 100;
    return std::pow(10, std::floor(std::log10(largest) + 1e-9));
}

Table prices_table(const OptimisedScene& scene) {
    const auto& active = scene.optimum.active;
    const auto relaxed = [&](Index k) { return relaxed_by(scene, item(active, k)); };
    Table prices = rows_of(
        "prices", std::ssize(active),
        {{"bound", words, [&](Index k) { return bound_text(scene, item(active, k)); }},
         {"relaxed by", given, relaxed},
         {"gain", three,
          [&](Index k) { return (scene.minimised ? 1 : 100) * relaxed(k) * item(active, k).price; },
          "decrease of the figure, or of the change in % of the ranges, to first order"}});
    prices.caption =
        active.empty() ? "No bound holds the result back."
        : scene.minimised
            ? fmt::format("Bounds that hold the result back. Relaxing one lowers {} at {} [{}] by:",
                          scene.minimised->name, scene.minimised->station_text,
                          scene.minimised->unit)
            : "Bounds that hold the result back. Relaxing one reduces the change [% of the ranges] "
              "by:";
    return prices;
}

Table searches_table(const OptimisedScene& scene) {
    const auto search = [&](Index k) -> const Search& { return item(scene.searches, k); };
    return rows_of("searches", std::ssize(scene.searches),
                   {{"start", hidden, [](Index k) { return k + 1; }},
                    {"result", hidden,
                     [&](Index k) {
                         return !search(k).has_value   ? "no value at its start"
                                : !search(k).met       ? "outside of the bands"
                                : !search(k).converged ? "within the bands, not converged"
                                                       : "within the bands";
                     }},
                    {"cost", hidden, [&](Index k) { return search(k).cost; }},
                    {"excess", hidden, [&](Index k) { return std::max(search(k).excess, 0.0); },
                     "over a band, as a share of its movement over the ranges"},
                    {"evaluations", hidden, [&](Index k) { return search(k).evaluations; }}});
}

// ---- fit

// A change of the numbers, in steps, by its parts.
std::string combination(const FittedScene& fit, const VectorXd& v) {
    std::vector<std::string> parts;
    for (const Index i : largest_first(v))
        if (std::abs(v[i]) >= min_share)
            parts.push_back(fmt::format("{} {:+.4g} {}", item(fit.varied.numbers, i).path,
                                        v[i] * fit.measured.step[i] / v.cwiseAbs().maxCoeff(),
                                        item(fit.varied.numbers, i).unit));
    return fmt::format("{}", fmt::join(parts, ", "));
}

Table columns_table(const FittedScene& fit) {
    const auto column = [&](Index c) -> const FittedColumn& { return item(fit.fitted.columns, c); };
    return rows_of("outputs", std::ssize(fit.columns),
                   {{"output", words, [&](Index c) { return item(fit.columns, c).name; }},
                    {"unit", words, [&](Index c) { return symbol(item(fit.columns, c).unit); }},
                    {"values", whole, [&](Index c) { return column(c).values; }},
                    {"rms before", three, [&](Index c) { return column(c).rms_before; },
                     "of calculated less measured values"},
                    {"noise", three, [&](Index c) { return column(c).noise; },
                     "estimated standard deviation of the measurements"},
                    {"outliers", whole, [&](Index c) { return column(c).outliers; },
                     "values with a residual of more than four times the noise"}});
}

Table combinations_table(const FittedScene& fit) {
    const auto proposed_for = [&](Index k) -> const ProposedOutput& {
        return item(fit.proposed, k);
    };
    Table table_of_changes = rows_of(
        "undetermined", std::ssize(fit.proposed),
        {{"change", words,
          [&](Index k) { return combination(fit, fit.fitted.undetermined.col(k)); }},
         {"measure", words,
          [&](Index k) {
              return proposed_for(k).by.figure < 0 ? "no output moves"
                                                   : proposed_for(k).figure.name;
          },
          "output that was not measured and moves most with the change"},
         {"at", words, [&](Index k) { return proposed_for(k).figure.station_text; }},
         {"movement", three, [&](Index k) { return proposed_for(k).by.movement; }, "by the change"},
         {"unit", words, [&](Index k) { return proposed_for(k).figure.unit; }},
         {"share", percent, [&](Index k) { return proposed_for(k).by.share; },
          "of the output's extent"}});
    if (!fit.proposed.empty())
        table_of_changes.caption =
            "The data do not determine these changes; what was not measured tells them apart:";
    return table_of_changes;
}

}  // namespace

Result result_of(const SolvedFor& solved) {
    const Solution& solution = solved.solution;
    const bool met = solved.met();
    const auto figure = [&](Index k) -> const Figure& { return item(solved.wanted, k); };
    Result result{.analysis = "solve-for"};
    result.tables.push_back(
        numbers_table(solved.varied, solution.p, met ? std::vector<int>{} : solution.at_limit));
    result.tables.push_back(rows_of(
        "wishes", solved.target.size(),
        {{"output", words, [&](Index k) { return figure(k).name; }},
         {"unit", words, [&](Index k) { return figure(k).unit; }},
         {"at", words, [&](Index k) { return figure(k).station_text; }},
         {"wanted", given, [&](Index k) { return solved.target[k]; }},
         {"before", given, [&](Index k) { return solved.start.value[k]; }},
         {"after", given, [&](Index k) { return solved.after[k]; }, "by the equilibrium leg"},
         {"by energy", given, [&](Index k) { return solved.by.energy[k]; }},
         {"by series", given, [&](Index k) { return solved.by.series[k]; }},
         {"range", three, [&](Index k) { return solved.start.movement[k]; },
          "movement over the ranges of the numbers, to first order"},
         {"conflict", percent, [&](Index k) { return met ? nan : solution.conflict()[k]; },
          "share in the conflict of the wishes"}}));
    if (!met) {
        std::vector<std::string> wishes;
        for (std::size_t k = 0; k < solved.wanted.size(); ++k)
            if (solution.conflict()[static_cast<Index>(k)] > min_share)
                wishes.push_back(solved.wanted[k].name + " at " + solved.wanted[k].station_text);
        add_conflict(result, wishes, " Within the limits the numbers move them only together.",
                     solved.varied, solution.at_limit, "wishes");
        if (!solution.converged)
            result.notes.emplace_back("The search has not converged: there may be nearer numbers.");
    }
    set_confirmation(result, solved.by, grade_of(met, solution.converged));
    result.verdict.sentence =
        !solution.converged ? fmt::format("The wishes are {}met, and the search has not converged.",
                                          met ? "" : "not ")
        : met ? "All wishes are met; of all such numbers within the limits, these change least, as "
                "shares of their ranges."
              : "The wishes cannot be met; these numbers come nearest.";
    result.verdict.compared = static_cast<int>(solved.target.size());
    return result;
}

std::string Goal::output() const {
    return points.front().name + (points.front().change ? " (change)" : "");
}

Result result_of(const OptimisedScene& scene) {
    const Optimum& optimum = scene.optimum;
    Result result{.analysis = "optimise"};
    const auto note = [&](std::string line) { result.notes.push_back(std::move(line)); };
    result.tables = {numbers_table(scene.varied, optimum.p,
                                   optimum.met ? std::vector<int>{} : optimum.nearest.at_limit),
                     goals_table(scene), searches_table(scene)};
    for (const Goal& goal : scene.goals)
        if (!goal.not_moved.empty())
            note(fmt::format("{} at {}: within its band, but none of the numbers moves it:\n  {}",
                             goal.output(), goal.where, goal.not_moved));
    if (scene.searches.size() > 1)
        note(fmt::format("{} of {} starts end within the bands.",
                         std::ranges::count(scene.searches, true, &Search::met),
                         scene.searches.size()));
    std::string& sentence = result.verdict.sentence;
    if (optimum.met) {
        result.tables.push_back(prices_table(scene));
        sentence = "The bands are met with a change of " +
                   fmt::format(
                       "{:.3g} % of the ranges (root of the sum of squares), the smallest "
                       "that was found.",
                       100 * optimum.cost);
        if (const auto& least = scene.minimised)
            sentence =
                fmt::format("The bands are met; {} at {}: {:g} {} from {:g}, the least found.",
                            least->name, least->station_text, optimum.cost, least->unit,
                            optimum.start.value[std::ssize(scene.figures) - 1]);
    } else {
        std::vector<std::string> bands;
        Index k = 0;
        for (const Goal& goal : scene.goals)
            for (std::size_t point = 0; point < goal.points.size(); ++point, ++k)
                if (const bool above = optimum.after[k] > goal.high;
                    optimum.conflict[k] > min_share)
                    bands.push_back(
                        bound_text(scene, {false, k, above, above ? goal.high : goal.low}));
        add_conflict(result, bands, "", scene.varied, optimum.nearest.at_limit, "bands");
        sentence = optimum.converged ? "The bands cannot be met; these numbers come nearest."
                                     : "The bands are not met, and the search has not converged.";
    }
    if (scene.between)
        note(fmt::format("Between its points {} is outside of its band by {:.2g}.",
                         scene.between->what, scene.between->excess));
    set_confirmation(result, scene.by, grade_of(optimum.met, optimum.converged));
    if (!optimum.converged)
        note(optimum.met
                 ? fmt::format("The search has not converged (optimality {:.1e}): there may be a "
                               "better result, and the prices are not reliable.",
                               optimum.optimality)
                 : "The search has not converged: there may be nearer numbers.");
    if (scene.certificate) note(result_of(*scene.certificate).verdict.sentence);
    const bool open = scene.between && !std::isfinite(scene.between->excess);
    if (optimum.met && (open || !scene.certificate->conclusive()))
        result.verdict.grade = Grade::not_judged;
    result.verdict.compared = static_cast<int>(scene.figures.size());
    return result;
}

Result result_of(const FittedScene& fit) {
    const Fitted& fitted = fit.fitted;
    Result result{.analysis = "fit"};
    if (!fitted.why_not.empty()) {
        result.verdict.sentence = "No fit: " + fitted.why_not + ".";
        return result;
    }
    const auto note = [&](std::size_t k) {
        return fitted.at_limit[k]                                      ? "at its limit"
               : std::isfinite(fitted.interval[static_cast<Index>(k)]) ? ""
                                                                       : "not determined";
    };
    result.tables = {numbers_table(fit.varied, fitted.p, fitted.interval, note), columns_table(fit),
                     combinations_table(fit)};
    if (!fitted.converged) result.notes.emplace_back("The fit has not converged.");
    if (fitted.freedom < 1)
        result.notes.emplace_back("Not more values than numbers: no interval can be given.");
    const VectorXd& S = fitted.singular_values;
    result.notes.push_back(fmt::format("Condition of the numbers, in steps of 1 mm or 1 %: {:.1e}",
                                       S[S.size() - 1] > 0 ? S[0] / S[S.size() - 1] : INFINITY));
    for (const auto& left : fit.left_out) result.notes.push_back("Left out: " + left);
    const bool determined = fitted.converged && fitted.interval.allFinite();
    result.verdict = {
        determined ? Grade::pass : Grade::not_judged,
        determined ? "The data determine all numbers." : "The data do not determine all numbers.",
        {},
        static_cast<int>(fit.measured.value.size())};
    return result;
}

Result result_of(const ToleratedScene& scene, int max_shares) {
    const auto figure_of = [&](Index k) -> const Figure& { return item(scene.figures, k); };
    Result result{.analysis = "tolerances"};
    result.tables.push_back(rows_of(
        "figures", std::ssize(scene.figures),
        {{"output", words, [&](Index k) { return figure_of(k).name; }},
         {"unit", words, [&](Index k) { return figure_of(k).unit; }},
         {"at", words, [&](Index k) { return figure_of(k).station_text; }},
         {"nominal", given, [&](Index k) { return item(scene.nominal, k); }},
         {"sd", three, [&](Index k) { return item(scene.scatter, k).sd; }, "standard deviation"},
         {"worst case", three, [&](Index k) { return item(scene.scatter, k).worst_case; }}}));
    struct Share {
        const Figure* figure;
        std::string number;
        double share;
    };
    std::vector<Share> shares;
    for (std::size_t k = 0; k < scene.figures.size(); ++k) {
        const VectorXd& share_of = scene.scatter[k].share;
        auto order = largest_first(share_of);
        if (max_shares > 0)
            order.resize(std::min(order.size(), static_cast<std::size_t>(max_shares)));
        for (const Index i : order)
            if (share_of[i] != 0)
                shares.push_back(
                    {&scene.figures[k], item(scene.tolerances.numbers, i), share_of[i]});
    }
    result.tables.push_back(
        table({.id = "shares"},
              std::vector<ColumnOf<Share>>{
                  {"output", words, [](const Share& s) { return s.figure->name; }},
                  {"at", words, [](const Share& s) { return s.figure->station_text; }},
                  {"tolerance", words, &Share::number},
                  {"share", percent, &Share::share, "of the variance"}},
              shares));
    result.verdict.grade =
        scene.missing.empty() && !scene.figures.empty() ? Grade::pass : Grade::not_judged;
    result.verdict.reasons = scene.missing;
    result.verdict.compared = static_cast<int>(scene.figures.size());
    return result;
}

}  // namespace elastocheck::compare
