#include "reports/tables/studies/optimise_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "reports/render/render.hpp"
#include "reports/tables/studies/design_tables.hpp"

namespace elastocheck::reports {
namespace {

using compare::Table;
using Eigen::Index;
using Eigen::VectorXd;
using json = nlohmann::ordered_json;

constexpr double least_share_shown = 0.05;  // of a band in a conflict

double finite_bound(double bound) { return std::isfinite(bound) ? bound : compare::nan; }

ChangedNumbers changed_numbers(const OptimisedScene& scene) {
    return {scene.numbers,      scene.limits.start, scene.optimum.p,
            scene.limits.least, scene.limits.most,  scene.optimum.at_limit};
}

// The value of a goal that is nearest to leaving the band, or furthest outside.
double worst_of(const Goal& goal, const VectorXd& values, Index first) {
    double most = -std::numeric_limits<double>::infinity(), worst = compare::nan;
    for (Index k = 0; k < static_cast<Index>(goal.points.size()); ++k) {
        const double value = values[first + k];
        const double excess = std::max(goal.low - value, value - goal.high);
        if (excess > most) most = excess, worst = value;
    }
    return worst;
}

double largest_difference(const Goal& goal, const VectorXd& a, const VectorXd& b, Index first) {
    double most = compare::nan;
    for (Index k = 0; k < static_cast<Index>(goal.points.size()); ++k) {
        const double apart = std::abs(a[first + k] - b[first + k]);
        if (std::isfinite(apart) && !(apart <= most)) most = apart;
    }
    return most;
}

Table goals_table(const OptimisedScene& scene) {
    using enum Digits;
    Table table{
        {{"output", "", "", true, words},
         {"unit", "", "", true, words},
         {"at", "", "", true, words},
         {"points", "", "", false, whole},
         {"low", "", "lower bound", false, given},
         {"high", "", "upper bound", false, given},
         {"before", "", "value nearest to leaving the band, or furthest outside", false, given},
         {"after", "", "likewise, by the equilibrium leg", false, given},
         {"energy differs", "", "largest difference of the energy leg", false, size},
         {"series differs", "", "largest difference of the series", false, size},
         {"conflict", "", "share in the conflict of the bands", false, percent}},
        {}};
    const compare::Optimum& optimum = scene.optimum;
    const compare::Confirmation& by = scene.confirmation;
    Index first = 0;
    for (const Goal& goal : scene.goals) {
        const auto count = static_cast<Index>(goal.points.size());
        table.rows.push_back(
            {goal.output, goal.unit, goal.where, static_cast<double>(count), finite_bound(goal.low),
             finite_bound(goal.high), worst_of(goal, optimum.before, first),
             worst_of(goal, optimum.after, first),
             largest_difference(goal, by.energy, optimum.after, first),
             largest_difference(goal, by.series, optimum.after, first),
             optimum.met ? compare::nan : optimum.conflict.segment(first, count).norm()});
        first += count;
    }
    return table;
}

struct NamedPoint {
    const Goal* goal = nullptr;
    const GoalPoint* point = nullptr;
};
std::vector<NamedPoint> points_in_order(const OptimisedScene& scene) {
    std::vector<NamedPoint> all;
    for (const Goal& goal : scene.goals)
        for (const GoalPoint& point : goal.points) all.push_back({&goal, &point});
    return all;
}

// Amount by which a bound is relaxed when its price is stated: a power of ten, up to a tenth of the
// band or a hundredth of what the numbers move; of a number 1 mm or 1 %.
double relaxed_by(const OptimisedScene& scene, const compare::ActiveBound& one,
                  const std::vector<NamedPoint>& points) {
    const auto which = static_cast<std::size_t>(one.which);
    if (one.of_number) return compare::step_of(scene.numbers[which]);
    const Goal& goal = *points[which].goal;
    const double width = goal.high - goal.low,
                 most = std::isfinite(width) ? width / 10 : scene.optimum.scale[one.which] / 100;
    return std::pow(10, std::floor(std::log10(most) + 1e-9));
}

std::string bound_text(const OptimisedScene& scene, const compare::ActiveBound& one,
                       const std::vector<NamedPoint>& points) {
    const auto which = static_cast<std::size_t>(one.which);
    const char* sign = one.upper ? "<=" : ">=";
    if (one.of_number)
        return fmt::format("{} {} {:g} {}", scene.numbers[which].path, sign, one.bound,
                           scene.numbers[which].unit);
    return fmt::format("{} {} {:g} {} at {}", points[which].goal->output, sign, one.bound,
                       points[which].goal->unit, points[which].point->place);
}

Table prices_table(const OptimisedScene& scene) {
    using enum Digits;
    Table table{{{"bound", "", "", true, words},
                 {"unit", "", "", true, words},
                 {"relaxed by", "", "", false, given},
                 {"gain", "", "decrease of the cost, to first order", false, three}},
                {}};
    const auto points = points_in_order(scene);
    for (const auto& one : scene.optimum.active) {
        const double amount = relaxed_by(scene, one, points);
        const auto which = static_cast<std::size_t>(one.which);
        table.rows.push_back({bound_text(scene, one, points),
                              one.of_number ? scene.numbers[which].unit : points[which].goal->unit,
                              amount, amount * one.price});
    }
    return table;
}

Table searches_table(const OptimisedScene& scene) {
    using enum Digits;
    Table table{
        {{"start", "", "", false, whole},
         {"result", "", "", true, words},
         {"cost", "", "", false, three},
         {"excess", "", "over a band, as a share of its movement over the ranges", false, size},
         {"evaluations", "", "", false, whole}},
        {}};
    for (std::size_t k = 0; k < scene.searches.size(); ++k) {
        const compare::Search& search = scene.searches[k];
        table.rows.push_back({static_cast<double>(k + 1),
                              std::string(!search.has_value   ? "no value at its start"
                                          : !search.met       ? "outside of the bands"
                                          : !search.converged ? "within the bands, not converged"
                                                              : "within the bands"),
                              finite_bound(search.cost), std::max(finite_bound(search.excess), 0.0),
                              static_cast<double>(search.evaluations)});
    }
    return table;
}

void add_prices(const OptimisedScene& scene, std::back_insert_iterator<std::string> out) {
    const Table prices = prices_table(scene);
    fmt::format_to(out, "{}\n",
                   prices.rows.empty()
                       ? "No bound holds the result back."
                       : "Bounds that hold at the result, with their prices to first order:");
    for (const auto& row : prices.rows) {
        const auto words = [&](std::size_t c) { return std::get<std::string>(row[c]); };
        const double by = std::get<double>(row[2]), gain = std::get<double>(row[3]);
        fmt::format_to(out, "  {}: relaxing it by {:g} {} ", words(0), by, words(1));
        if (scene.minimised.empty())
            fmt::format_to(out, "reduces the change by {:.3g} % of the ranges\n", 100 * gain);
        else
            fmt::format_to(out, "lowers {} by {:.3g} {}\n", scene.minimised, gain,
                           scene.minimised_unit);
    }
}

void add_conflict(const OptimisedScene& scene, std::back_insert_iterator<std::string> out) {
    const compare::Optimum& optimum = scene.optimum;
    const auto points = points_in_order(scene);
    std::vector<std::string> bands;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto i = static_cast<Index>(k);
        if (!(optimum.conflict[i] > least_share_shown)) continue;
        const Goal& goal = *points[k].goal;
        const bool above = optimum.after[i] > goal.high;
        bands.push_back(bound_text(scene, {false, i, above, above ? goal.high : goal.low}, points));
    }
    fmt::format_to(out, "{}: {}.\n", bands.size() > 1 ? "In conflict" : "Out of reach",
                   fmt::join(bands, "; "));
    fmt::format_to(out, "{}", limits_text(changed_numbers(scene), "bands"));
}

}  // namespace

std::string optimise_text(const OptimisedScene& scene) {
    const compare::Optimum& optimum = scene.optimum;
    std::string all =
        text(numbers_table(changed_numbers(scene))) + "\n" + text(goals_table(scene)) + "\n";
    const auto out = std::back_inserter(all);
    for (const Goal& goal : scene.goals)
        if (!goal.not_moved.empty())
            fmt::format_to(out,
                           "{} at {}: within its band, but none of the numbers moves it:\n  {}\n",
                           goal.output, goal.where, goal.not_moved);
    if (scene.searches.size() > 1)
        fmt::format_to(out, "{} of {} starts end within the bands.\n",
                       std::ranges::count(scene.searches, true, &compare::Search::met),
                       scene.searches.size());
    if (optimum.met) {
        if (scene.minimised.empty())
            fmt::format_to(out,
                           "The bands are met with a change of {:.3g} % of the ranges (root of "
                           "the sum of squares), the smallest that was found.\n",
                           100 * optimum.cost);
        else
            fmt::format_to(out, "The bands are met; {}: {:g} {} from {:g}, the least found.\n",
                           scene.minimised, optimum.cost, scene.minimised_unit,
                           optimum.before[scene.limits.minimised]);
        add_prices(scene, out);
        if (!optimum.converged)
            fmt::format_to(out,
                           "The search has not converged (optimality {:.1e}): there may be a "
                           "better result, and the prices are not reliable.\n",
                           optimum.optimality);
    } else {
        fmt::format_to(out, "The bands cannot be met; these numbers come nearest.\n");
        add_conflict(scene, out);
        if (!optimum.converged)
            fmt::format_to(out, "The search has not converged: there may be nearer numbers.\n");
    }
    if (scene.between)
        fmt::format_to(out, "Between its points {} is outside of its band by {:.2g}.\n",
                       scene.between->what, scene.between->excess);
    all += confirmation_text(scene.confirmation);
    if (scene.certificate) fmt::format_to(out, "{}\n", result_of(*scene.certificate).verdict.sentence);
    return all;
}

json optimise_json(const OptimisedScene& scene) {
    const compare::Optimum& optimum = scene.optimum;
    json document = {{"met", optimum.met},
                     {"confirmed", scene.confirmation.confirmed},
                     {"not_confirmed", scene.confirmation.why_not},
                     {"converged", optimum.converged},
                     {"optimality", optimum.optimality},
                     {"minimised", scene.minimised.empty() ? "change" : scene.minimised},
                     {"cost", optimum.cost},
                     {"numbers", table_json(numbers_table(changed_numbers(scene)))},
                     {"goals", table_json(goals_table(scene))},
                     {"prices", table_json(prices_table(scene))},
                     {"searches", table_json(searches_table(scene))}};
    if (scene.between)
        document["between"] = {{"what", scene.between->what}, {"excess", scene.between->excess}};
    if (scene.certificate) document["certify"] = json_of(result_of(*scene.certificate));
    return document;
}

}  // namespace elastocheck::reports
