#include "compare/candidate/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

constexpr double of_measured = 1e-2;  // of a column's range: what a measurement resolves

// ---- Loops: points of a branch that go out and back.

// Direction of the step to each point of one branch, +1 or -1; that of the first is that of the
// second. A step of less than a thousandth of the range is noise of the abscissa and keeps the
// direction.
std::vector<int> directions(const std::vector<double>& x) {
    const auto [low, high] = std::ranges::minmax(x);
    const double noise = 1e-3 * (high - low);
    std::vector<int> way(x.size(), 0);
    double turned_at = x.front();
    int now = 0;
    for (std::size_t k = 1; k < x.size(); ++k) {
        const double step = x[k] - turned_at;
        if (std::abs(step) > noise) now = step > 0 ? 1 : -1, turned_at = x[k];
        way[k] = now;
    }
    for (std::size_t k = way.size(); k-- > 0;)
        if (way[k] == 0) way[k] = k + 1 < way.size() ? way[k + 1] : 0;
    return way;
}

// Value at x of a polygon through points in any order; NaN outside.
double polygon(std::vector<std::pair<double, double>> points, double x) {
    std::ranges::sort(points);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const auto& [x_0, y_0] = points[k];
        const auto& [x_1, y_1] = points[k + 1];
        if (x < x_0 || x > x_1) continue;
        return x_1 > x_0 ? std::lerp(y_0, y_1, (x - x_0) / (x_1 - x_0)) : (y_0 + y_1) / 2;
    }
    return points.size() == 1 && points.front().first == x ? points.front().second : nan;
}

// Replaces the values of a column by the mean of both ways, where a branch has two, and returns the
// widths above zero. A point that has no counterpart on the other way, at a turning point, stays.
std::vector<Hysteresis> take_means(PointColumn& column, const std::vector<Place>& places,
                                   const Comparison& comparison) {
    std::vector<Hysteresis> loops;
    for (std::size_t b = 0; b < comparison.branches.size(); ++b)
        for (const bool by_parameter : {true, false}) {
            std::vector<std::size_t> points;
            std::vector<double> at;
            for (std::size_t k = 0; k < places.size(); ++k)
                if (places[k].branch == static_cast<int>(b) &&
                    places[k].by_parameter == by_parameter && std::isfinite(column.values[k]))
                    points.push_back(k), at.push_back(places[k].x);
            if (points.size() < 4) continue;
            const auto way = directions(at);
            std::array<std::vector<std::pair<double, double>>, 2> ways;  // down, up
            for (std::size_t k = 0; k < points.size(); ++k)
                ways[way[k] > 0 ? 1 : 0].emplace_back(at[k], column.values[points[k]]);
            if (ways[0].size() < 2 || ways[1].size() < 2) continue;
            Hysteresis loop{.branch = comparison.branches[b].branch,
                            .channel = column.channel,
                            .by_parameter = by_parameter};
            std::vector<double> mean = column.values;
            for (std::size_t k = 0; k < points.size(); ++k) {
                const double here = column.values[points[k]],
                             other = polygon(ways[way[k] > 0 ? 0 : 1], at[k]);
                if (!std::isfinite(other)) continue;
                ++loop.points;
                mean[points[k]] = (here + other) / 2;
                if (std::abs(here - other) > loop.width)
                    loop.width = std::abs(here - other), loop.at = at[k];
            }
            column.values = std::move(mean);
            if (loop.width > 0) loops.push_back(loop);
        }
    return loops;
}

// ---- Causes.

struct Given {
    const Comparison& comparison;
    const Points& points;  // means of both ways
    const DefinedCurves& defined;
};

// The points of one branch beside a leg, and the other definitions by the equilibrium leg; NaN where
// the leg does not reach.
CandidateReading beside_leg(const Given& given, const std::vector<Place>& places, std::size_t b,
                            Leg leg) {
    const auto& [comparison, points, defined] = given;
    const Curve& curve = comparison.branches[b].run(leg).curve;
    const std::array over{
        points.abscissa ? placed_by(curve, points.abscissa) : std::vector<double>{},
        placed_by(curve, {})};
    CandidateReading reading;
    for (std::size_t k = 0; k < places.size(); ++k)
        if (places[k].branch == static_cast<int>(b) && std::isfinite(places[k].x))
            reading.points.push_back(k), reading.at.push_back(places[k].x);
    const auto along = [&](const std::vector<double>& of) {
        std::vector<double> values;
        for (const std::size_t k : reading.points) {
            const auto& x = over[places[k].by_parameter ? 1 : 0];
            values.push_back(reaches(x, places[k].x) ? interpolate(x, of, places[k].x, 6) : nan);
        }
        return values;
    };
    for (const auto& column : points.columns) {
        auto& theirs = reading.candidate.emplace_back();
        for (const std::size_t k : reading.points) theirs.push_back(column.values[k]);
        reading.truth.push_back(along(curve.channel(column.channel)));
    }
    if (leg == Leg::equilibrium && !defined.branches.empty())
        for (std::size_t d = 0; d < defined.channels.size(); ++d)
            reading.defined.push_back(along(defined.branches[b].channel(d)));
    return reading;
}

// Turns the places of a branch whose columns agree better so, and says so.
void turn_places(const Given& given, std::vector<Place>& places, std::vector<std::string>& causes) {
    constexpr double much = 0.3, quarter = 0.25;  // of a column's scatter; of the deviation
    std::vector<Place> turned = places;
    for (Place& place : turned) place.x = -place.x;
    for (std::size_t b = 0; b < given.comparison.branches.size(); ++b) {
        // squares in units of the columns' scatter
        double before = 0, by_columns = 0, by_places = 0;
        int count = 0;
        const auto as_given = beside_leg(given, places, b, Leg::equilibrium),
                   otherwise = beside_leg(given, turned, b, Leg::equilibrium);
        for (std::size_t c = 0; c < given.points.columns.size(); ++c) {
            double n = 0, sum = 0, squares = 0, as_is = 0, sign = 0, place = 0;
            for (std::size_t k = 0; k < as_given.points.size(); ++k) {
                const double v = as_given.candidate[c][k], r = as_given.truth[c][k],
                             t = otherwise.truth[c][k];
                if (!std::isfinite(v + r + t)) continue;
                n += 1, sum += v, squares += v * v;
                as_is += (v - r) * (v - r), sign += (v + r) * (v + r);
                place += (v - t) * (v - t);
            }
            const double scatter = squares - sum * sum / n;
            if (!(n >= 3) || !(scatter > 1e-12 * squares)) continue;
            ++count;
            before += as_is / scatter, by_columns += std::min(as_is, sign) / scatter;
            by_places += place / scatter;
        }
        if (!(before > much * much * count) || !(by_places < quarter * quarter * before) ||
            !(by_places < by_columns))
            continue;
        const bool by_parameter = places[as_given.points.front()].by_parameter;
        causes.push_back(fmt::format(
            "the columns of branch '{}' are nearer with the sign of {} turned: {:.2g} % of their "
            "scatter off instead of {:.2g} %",
            given.comparison.branches[b].branch,
            by_parameter ? "the parameter" : given.comparison.channels[*given.points.abscissa].name,
            100 * std::sqrt(by_places / count), 100 * std::sqrt(before / count)));
        for (const std::size_t k : as_given.points) places[k].x = turned[k].x;
    }
}

std::vector<std::string> causes_of(const Given& given, std::vector<Place> places) {
    const auto& [comparison, points, defined] = given;
    std::vector<std::string> causes;
    turn_places(given, places, causes);
    std::vector<CandidateReading> readings;
    for (std::size_t b = 0; b < comparison.branches.size(); ++b)
        readings.push_back(beside_leg(given, places, b, Leg::equilibrium));
    std::vector<ReadBranch> branches;
    for (std::size_t b = 0; b < readings.size(); ++b)
        branches.push_back({&comparison.branches[b], &readings[b]});
    for (std::size_t c = 0; c < points.columns.size(); ++c) {
        Beside b = beside(comparison, points.columns, defined.channels, branches, c);
        if (b.candidate.size() < 3) continue;
        const auto [low, high] = std::ranges::minmax(b.candidate);
        b.tolerance = of_measured * (high - low);
        if (!(deviation_of(b.reference, b.candidate, b.at).max > b.tolerance)) continue;
        // a point from which on it is wrong says nothing about a measurement
        if (const auto found = explain(b); found && found->kind != Explanation::Kind::from_there_on)
            causes.push_back(describe(*found, comparison, points));
        else if (const auto nearer = nearer_with(b, comparison.channels[b.channel]);
                 !nearer.empty())
            causes.push_back(nearer);
    }
    return causes;
}

// Slope of the straight line through these points.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
    const double n = static_cast<double>(x.size());
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) mean_x += x[k] / n, mean_y += y[k] / n;
    for (std::size_t k = 0; k < x.size(); ++k) {
        xx += (x[k] - mean_x) * (x[k] - mean_x);
        xy += (x[k] - mean_x) * (y[k] - mean_y);
    }
    return xx > 0 ? xy / xx : nan;
}

// The row of a column and a branch, beside each leg.
MeasuredRow measured_row(const std::array<CandidateReading, legs.size()>& beside, std::size_t c,
                         std::vector<bool>& used) {
    MeasuredRow row;
    std::vector<double> at, measured;
    std::array<std::vector<double>, legs.size()> values;
    for (std::size_t k = 0; k < beside[0].points.size(); ++k) {
        const auto finite = [&](const CandidateReading& leg) {
            return std::isfinite(leg.truth[c][k]) && std::isfinite(leg.candidate[c][k]);
        };
        if (!std::ranges::all_of(beside, finite)) continue;
        used[beside[0].points[k]] = true;
        at.push_back(beside[0].at[k]), measured.push_back(beside[0].candidate[c][k]);
        for (std::size_t l = 0; l < legs.size(); ++l) values[l].push_back(beside[l].truth[c][k]);
    }
    for (std::size_t l = 0; l < legs.size(); ++l)
        row.off[l] = deviation_of(measured, values[l], at);
    row.measured_gradient = slope(at, measured);
    row.gradient = slope(at, values[static_cast<std::size_t>(Leg::equilibrium)]);
    return row;
}

}  // namespace

DefinedCurves defined_curves(const Model& model, const Comparison& comparison) {
    DefinedCurves defined{definition_channels(model), {}};
    for (std::size_t b = 0; b < comparison.branches.size(); ++b) {
        const Branch& branch = model.branches[b];
        const auto sides = sides_of(model, branch, comparison.branches[b].steps);
        const SolverSettings solver{.leg = Leg::equilibrium, .every = comparison.branches[b].every};
        defined.branches.push_back(
            solve_branch(model, defined.channels, branch, sides, solver).curve);
    }
    return defined;
}

MeasuredComparison compare_measured(const Model& model, const Comparison& comparison,
                                    const Points& measured, const DefinedCurves& defined) {
    MeasuredComparison result;
    result.columns = as_they_stand(model, comparison, measured.columns);
    result.places = places_of(model, comparison, measured);
    result.used.assign(result.places.size(), false);
    Points means;
    means.abscissa = measured.abscissa;
    means.columns = result.columns;
    for (auto& column : means.columns)
        for (auto& loop : take_means(column, result.places, comparison))
            result.loops.push_back(std::move(loop));
    const Given given{comparison, means, defined};
    result.explanations = causes_of(given, result.places);
    for (const bool by_parameter : {true, false}) {
        const auto& x = by_parameter ? measured.a : measured.at;
        if (std::ranges::none_of(x, [](double v) { return std::isfinite(v); })) continue;
        std::vector<Place> places = result.places;
        for (std::size_t k = 0; k < places.size(); ++k)
            places[k].by_parameter = by_parameter, places[k].x = x[k];
        MeasuredReading reading{by_parameter, {}};
        std::vector<std::array<CandidateReading, legs.size()>> branches(comparison.branches.size());
        for (std::size_t b = 0; b < branches.size(); ++b)
            for (const Leg leg : legs)
                branches[b][static_cast<std::size_t>(leg)] = beside_leg(given, places, b, leg);
        for (std::size_t c = 0; c < means.columns.size(); ++c)
            for (std::size_t b = 0; b < branches.size(); ++b) {
                auto row = measured_row(branches[b], c, result.used);
                if (row.compared() == 0) continue;
                row.branch = comparison.branches[b].branch, row.channel = means.columns[c].channel;
                result.compared += row.compared();
                reading.rows.push_back(std::move(row));
            }
        result.readings.push_back(std::move(reading));
    }
    return result;
}

}  // namespace elastocheck::compare
