// Comparison with measured points, in three steps: the mean of a loop that goes out and back
// replaces its points; wrong signs, units and definitions are looked for; each column is compared
// with each leg on each branch.
#include "compare/candidate/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/slope.hpp"

namespace elastocheck::compare {
namespace {

// Smallest deviation that a measurement resolves, as a share of the range of its column.
constexpr double min_relative_deviation = 1e-2;

// ---- Loops: points of a branch that go out and back.

// Direction of the step to each point of one branch, +1 or -1; the first point has that of the
// second. A step of less than a thousandth of the range of x is noise of the abscissa and keeps the
// direction. x: parameter or abscissa of the points, in the order in which they were measured.
std::vector<int> directions(const std::vector<double>& x) {
    const auto [low, high] = std::ranges::minmax(x);
    const double noise = 1e-3 * (high - low);
    std::vector<int> direction(x.size(), 0);
    double last_x = x.front();
    int current = 0;
    for (std::size_t k = 1; k < x.size(); ++k) {
        const double step = x[k] - last_x;
        if (std::abs(step) > noise) {
            current = step > 0 ? 1 : -1;
            last_x = x[k];
        }
        direction[k] = current;
    }
    for (std::size_t k = direction.size(); k-- > 0;)
        if (direction[k] == 0) direction[k] = k + 1 < direction.size() ? direction[k + 1] : 0;
    return direction;
}

// Value at x of the piecewise linear curve through points in any order; NaN outside.
double piecewise_linear_value(std::vector<std::pair<double, double>> points, double x) {
    std::ranges::sort(points);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const auto& [x_0, y_0] = points[k];
        const auto& [x_1, y_1] = points[k + 1];
        if (x < x_0 || x > x_1) continue;
        return x_1 > x_0 ? std::lerp(y_0, y_1, (x - x_0) / (x_1 - x_0)) : (y_0 + y_1) / 2;
    }
    return points.size() == 1 && points.front().first == x ? points.front().second : nan;
}

// Where the points of a branch go out and back, replaces each value of a column by the mean of both
// sweeps at its place, ½ (y(x) + y_other(x)) with y_other interpolated linearly between the points
// of the other sweep. Returns the loops wider than zero. A point that the other sweep does not
// reach, at the end of the loop, keeps its value.
std::vector<Hysteresis> take_means(PointColumn& column, const std::vector<Place>& places,
                                   const Comparison& comparison) {
    std::vector<Hysteresis> loops;
    for (std::size_t b = 0; b < comparison.branches.size(); ++b)
        for (const bool by_parameter : {true, false}) {
            std::vector<std::size_t> points;
            std::vector<double> x;
            for (std::size_t k = 0; k < places.size(); ++k)
                if (places[k].branch == static_cast<int>(b) &&
                    places[k].by_parameter == by_parameter && std::isfinite(column.values[k])) {
                    points.push_back(k);
                    x.push_back(places[k].x);
                }
            if (points.size() < 4) continue;
            const auto direction = directions(x);
            std::array<std::vector<std::pair<double, double>>, 2> sweeps;  // down, up
            for (std::size_t k = 0; k < points.size(); ++k)
                sweeps[direction[k] > 0 ? 1 : 0].emplace_back(x[k], column.values[points[k]]);
            if (sweeps[0].size() < 2 || sweeps[1].size() < 2) continue;
            Hysteresis loop{.branch = comparison.branches[b].branch,
                            .channel = column.channel,
                            .by_parameter = by_parameter};
            std::vector<double> mean = column.values;
            for (std::size_t k = 0; k < points.size(); ++k) {
                const double value = column.values[points[k]],
                             other = piecewise_linear_value(sweeps[direction[k] > 0 ? 0 : 1], x[k]);
                if (!std::isfinite(other)) continue;
                ++loop.points;
                mean[points[k]] = (value + other) / 2;
                if (std::abs(value - other) > loop.width) {
                    loop.width = std::abs(value - other);
                    loop.at = x[k];
                }
            }
            column.values = std::move(mean);
            if (loop.width > 0) loops.push_back(loop);
        }
    return loops;
}

// ---- Causes of a deviation: wrong signs, units, offsets and definitions.

// Input of the search for causes.
struct MeasuredInput {
    const Comparison& comparison;
    const Points& points;  // the mean of both sweeps where the points go out and back
    const DefinedCurves& defined;
};

// Points of branch b with the values of a leg (one of the solvers) at their places, interpolated with degree 5;
// NaN beyond the curve of the leg. The equilibrium leg also gives the figures by other definitions.
CandidateReading values_beside_leg(const MeasuredInput& input, const std::vector<Place>& places,
                                   std::size_t b, Leg leg) {
    const auto& [comparison, points, defined] = input;
    const Curve& curve = comparison.branches[b].run(leg).curve;
    const std::array x_of_leg{
        points.abscissa ? abscissa_values(curve, points.abscissa) : std::vector<double>{},
        abscissa_values(curve, {})};
    CandidateReading reading;
    for (std::size_t k = 0; k < places.size(); ++k)
        if (places[k].branch == static_cast<int>(b) && std::isfinite(places[k].x)) {
            reading.points.push_back(k);
            reading.at.push_back(places[k].x);
        }
    const auto interpolated = [&](const std::vector<double>& y) {
        std::vector<double> values;
        for (const std::size_t k : reading.points) {
            const auto& x_samples = x_of_leg[places[k].by_parameter ? 1 : 0];
            values.push_back(
                reaches(x_samples, places[k].x) ? interpolate(x_samples, y, places[k].x, 6) : nan);
        }
        return values;
    };
    for (const auto& column : points.columns) {
        auto& measured = reading.candidate.emplace_back();
        for (const std::size_t k : reading.points) measured.push_back(column.values[k]);
        reading.truth.push_back(interpolated(curve.channel(column.channel)));
    }
    if (leg == Leg::equilibrium && !defined.branches.empty())
        for (std::size_t d = 0; d < defined.channels.size(); ++d)
            reading.defined.push_back(interpolated(defined.branches[b].channel(d)));
    return reading;
}

// Changes the sign of the places of a branch (parameter or abscissa x ← -x) where that explains its
// columns better than signs of columns do, and adds the reason to `causes`. With v the measured
// values, r the leg's at x and t the leg's at -x, s² = Σ (v - mean v)² the scatter of a column, and
// sums over the columns with at least three points and s > 0,
//
//   B = Σ |v - r|² / s²     C = Σ min(|v - r|², |v + r|²) / s²     P = Σ |v - t|² / s²
//
// that is where √(B / columns) > 0.3,  √(P / B) < 0.25  and  P < C.
void reverse_places(const MeasuredInput& input, std::vector<Place>& places,
                    std::vector<std::string>& causes) {
    constexpr double min_deviation = 0.3, max_remainder = 0.25;
    std::vector<Place> reversed = places;
    for (Place& place : reversed) place.x = -place.x;
    for (std::size_t b = 0; b < input.comparison.branches.size(); ++b) {
        // squares in units of the columns' scatter
        double before = 0, by_columns = 0, by_places = 0;
        int count = 0;
        const auto as_given = values_beside_leg(input, places, b, Leg::equilibrium),
                   as_reversed = values_beside_leg(input, reversed, b, Leg::equilibrium);
        for (std::size_t c = 0; c < input.points.columns.size(); ++c) {
            double n = 0, sum = 0, squares = 0, as_is = 0, sign = 0, place = 0;
            for (std::size_t k = 0; k < as_given.points.size(); ++k) {
                const double v = as_given.candidate[c][k], r = as_given.truth[c][k],
                             t = as_reversed.truth[c][k];
                if (!std::isfinite(v + r + t)) continue;
                n += 1;
                sum += v;
                squares += v * v;
                as_is += (v - r) * (v - r);
                sign += (v + r) * (v + r);
                place += (v - t) * (v - t);
            }
            const double scatter = squares - sum * sum / n;
            if (!(n >= 3) || !(scatter > 1e-12 * squares)) continue;
            ++count;
            before += as_is / scatter;
            by_columns += std::min(as_is, sign) / scatter;
            by_places += place / scatter;
        }
        if (!(before > min_deviation * min_deviation * count) ||
            !(by_places < max_remainder * max_remainder * before) || !(by_places < by_columns))
            continue;
        const bool by_parameter = places[as_given.points.front()].by_parameter;
        causes.push_back(fmt::format(
            "the columns of branch '{}' are nearer with the sign of {} turned: {:.2g} % of their "
            "scatter off instead of {:.2g} %",
            input.comparison.branches[b].branch,
            by_parameter ? "the parameter" : input.comparison.channels[*input.points.abscissa].name,
            100 * std::sqrt(by_places / count), 100 * std::sqrt(before / count)));
        for (const std::size_t k : as_given.points) places[k].x = reversed[k].x;
    }
}

// Causes that explain deviations of the columns, one sentence each.
std::vector<std::string> causes_of(const MeasuredInput& input, std::vector<Place> places) {
    const auto& [comparison, points, defined] = input;
    std::vector<std::string> causes;
    reverse_places(input, places, causes);
    std::vector<CandidateReading> readings;
    for (std::size_t b = 0; b < comparison.branches.size(); ++b)
        readings.push_back(values_beside_leg(input, places, b, Leg::equilibrium));
    std::vector<BranchReading> branches;
    for (std::size_t b = 0; b < readings.size(); ++b)
        branches.push_back({&comparison.branches[b], &readings[b]});
    for (std::size_t c = 0; c < points.columns.size(); ++c) {
        ColumnWithReference b =
            column_with_reference(comparison, points.columns, defined.channels, branches, c);
        if (b.candidate.size() < 3) continue;
        const auto [low, high] = std::ranges::minmax(b.candidate);
        b.tolerance = min_relative_deviation * (high - low);
        if (!(deviation_of(b.reference, b.candidate, b.at).max > b.tolerance)) continue;
        // That a column is wrong from some point on does not explain a measurement.
        if (const auto found = explain(b); found && found->kind != Explanation::Kind::from_there_on)
            causes.push_back(describe(*found, comparison, points));
        else if (const auto nearer = nearer_with(b, comparison.channels[b.channel]);
                 !nearer.empty())
            causes.push_back(nearer);
    }
    return causes;
}

// Deviations of column c from each leg on one branch, over the points that have values of all legs; marks
// these points in `used`.
MeasuredRow measured_row(const std::array<CandidateReading, legs.size()>& beside, std::size_t c,
                         std::vector<bool>& used) {
    MeasuredRow row;
    std::vector<double> x, measured;
    std::array<std::vector<double>, legs.size()> values;
    for (std::size_t k = 0; k < beside[0].points.size(); ++k) {
        const auto finite = [&](const CandidateReading& leg) {
            return std::isfinite(leg.truth[c][k]) && std::isfinite(leg.candidate[c][k]);
        };
        if (!std::ranges::all_of(beside, finite)) continue;
        used[beside[0].points[k]] = true;
        x.push_back(beside[0].at[k]);
        measured.push_back(beside[0].candidate[c][k]);
        for (std::size_t l = 0; l < legs.size(); ++l) values[l].push_back(beside[l].truth[c][k]);
    }
    for (std::size_t l = 0; l < legs.size(); ++l) row.off[l] = deviation_of(measured, values[l], x);
    row.measured_gradient = slope(x, measured);
    row.gradient = slope(x, values[static_cast<std::size_t>(Leg::equilibrium)]);
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
    result.columns = as_absolute_values(model, comparison, measured.columns);
    result.places = places_of(model, comparison, measured);
    result.used.assign(result.places.size(), false);
    Points means;
    means.abscissa = measured.abscissa;
    means.columns = result.columns;
    for (auto& column : means.columns)
        for (auto& loop : take_means(column, result.places, comparison))
            result.loops.push_back(std::move(loop));
    const MeasuredInput input{comparison, means, defined};
    result.explanations = causes_of(input, result.places);
    for (const bool by_parameter : {true, false}) {
        const auto& x = by_parameter ? measured.a : measured.at;
        if (std::ranges::none_of(x, [](double v) { return std::isfinite(v); })) continue;
        std::vector<Place> places = result.places;
        for (std::size_t k = 0; k < places.size(); ++k) {
            places[k].by_parameter = by_parameter;
            places[k].x = x[k];
        }
        MeasuredReading reading{by_parameter, {}};
        std::vector<std::array<CandidateReading, legs.size()>> branches(comparison.branches.size());
        for (std::size_t b = 0; b < branches.size(); ++b)
            for (const Leg leg : legs)
                branches[b][static_cast<std::size_t>(leg)] =
                    values_beside_leg(input, places, b, leg);
        for (std::size_t c = 0; c < means.columns.size(); ++c)
            for (std::size_t b = 0; b < branches.size(); ++b) {
                auto row = measured_row(branches[b], c, result.used);
                if (row.compared() == 0) continue;
                row.branch = comparison.branches[b].branch;
                row.channel = means.columns[c].channel;
                result.compared += row.compared();
                reading.rows.push_back(std::move(row));
            }
        result.readings.push_back(std::move(reading));
    }
    return result;
}

}  // namespace elastocheck::compare
