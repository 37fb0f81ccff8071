#include "compare/candidate/measured.hpp"
#include "compare/deviation/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/definitions/definitions.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

// Curve of a leg along one branch in one reading; built once for all points.
struct Line {
    std::vector<double> over;     // values that place points; empty where not monotonic
    std::vector<double> channel;  // the requested output

    double at(double x) const { return reaches(over, x) ? interpolate(over, channel, x, 6) : nan; }
};
using Lines = std::vector<std::array<Line, legs.size()>>;  // per branch and leg

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
        return x_1 > x_0 ? y_0 + (y_1 - y_0) * (x - x_0) / (x_1 - x_0) : (y_0 + y_1) / 2;
    }
    return points.size() == 1 && points.front().first == x ? points.front().second : nan;
}

// Replaces the values of a column by the mean of both ways, where a branch has two, and returns the
// widths. A point that has no counterpart on the other way, at a turning point, stays.
std::vector<Hysteresis> take_means(PointColumn& column, const std::vector<double>& x,
                                   const std::vector<std::string>& branch) {
    std::vector<Hysteresis> loops;
    std::vector<std::string> names;
    for (const auto& name : branch)
        if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
    for (const auto& name : names) {
        std::vector<std::size_t> points;
        std::vector<double> at;
        for (std::size_t k = 0; k < x.size(); ++k)
            if (branch[k] == name && std::isfinite(x[k]) && std::isfinite(column.values[k]))
                points.push_back(k), at.push_back(x[k]);
        if (points.size() < 4) continue;
        const auto way = directions(at);
        std::array<std::vector<std::pair<double, double>>, 2> ways;  // down, up
        for (std::size_t k = 0; k < points.size(); ++k)
            ways[way[k] > 0 ? 1 : 0].emplace_back(at[k], column.values[points[k]]);
        if (ways[0].size() < 2 || ways[1].size() < 2) continue;
        Hysteresis loop{.branch = name, .channel = column.channel};
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
        if (loop.points > 0) loops.push_back(loop);
    }
    return loops;
}

// ---- Causes.

std::vector<std::string> causes_of(const Comparison& comparison, const Points& points,
                                   const std::vector<int>& branch,
                                   std::optional<std::size_t> placed, const std::vector<double>& x,
                                   const DefinedCurves& defined) {
    std::vector<std::string> causes;
    const auto equilibrium = [&](std::size_t b, std::size_t channel) {
        return comparison.branches[b].run(Leg::equilibrium).curve.channel(channel);
    };
    std::vector<std::vector<double>> over;
    for (const auto& of : comparison.branches)
        over.push_back(placed_by(of.run(Leg::equilibrium).curve, placed));
    const auto read = [&](std::size_t b, const std::vector<double>& values, double at) {
        return reaches(over[b], at) ? interpolate(over[b], values, at, 6) : nan;
    };
    for (std::size_t c = 0; c < points.columns.size(); ++c) {
        Beside b;
        b.column = c;
        b.channel = points.columns[c].channel;
        std::vector<std::pair<std::size_t, double>> places;  // branch, abscissa
        double worst = 0;
        for (std::size_t k = 0; k < x.size(); ++k) {
            if (branch[k] < 0 || !std::isfinite(points.columns[c].values[k])) continue;
            const auto of = static_cast<std::size_t>(branch[k]);
            const auto whole = equilibrium(of, b.channel);
            const double reference = read(of, whole, x[k]);
            if (!std::isfinite(reference)) continue;
            b.candidate.push_back(points.columns[c].values[k]);
            b.reference.push_back(reference);
            b.begin.push_back(whole[comparison.branches[of].run(Leg::equilibrium).curve.start]);
            b.at.push_back(x[k]);
            b.branch.push_back(comparison.branches[of].branch);
            places.emplace_back(of, x[k]);
            worst = std::max(worst, std::abs(b.candidate.back() - reference));
        }
        if (b.candidate.size() < 3) continue;
        const auto [low, high] = std::ranges::minmax(b.candidate);
        b.tolerance = of_measured * (high - low);
        if (!(worst > b.tolerance)) continue;
        const auto values_of = [&](const auto& curve_of_branch) {
            std::vector<double> values;
            for (const auto& [of, at] : places) values.push_back(read(of, curve_of_branch(of), at));
            return values;
        };
        for (const auto& other : points.columns)
            if (other.channel != b.channel &&
                comparison.channels[other.channel].unit == comparison.channels[b.channel].unit) {
                b.others.push_back(
                    values_of([&](std::size_t of) { return equilibrium(of, other.channel); }));
                b.other_channels.push_back(other.channel);
            }
        if (!defined.branches.empty())
            for (const Channel& definition :
                 definitions_of(defined.channels, comparison.channels[b.channel].name)) {
                const auto d =
                    static_cast<std::size_t>(find_channel(defined.channels, definition.name));
                b.definitions.push_back(
                    values_of([&](std::size_t of) { return defined.branches[of].channel(d); }));
                b.definition_names.push_back(definition.name);
            }
        // a point from which on it is wrong says nothing about a measurement
        if (const auto found = explain(b); found && found->kind != Explanation::Kind::from_there_on)
            causes.push_back(describe(*found, comparison, points));
    }
    return causes;
}

Lines lines_of(const Comparison& comparison, std::optional<std::size_t> placed) {
    Lines lines(comparison.branches.size());
    for (std::size_t b = 0; b < lines.size(); ++b)
        for (const Leg leg : legs)
            lines[b][static_cast<std::size_t>(leg)].over =
                placed_by(comparison.branches[b].run(leg).curve, placed);
    return lines;
}

}  // namespace

DefinedCurves defined_curves(const Model& model, const Comparison& comparison) {
    DefinedCurves defined{definition_channels(model), {}};
    for (std::size_t b = 0; b < comparison.branches.size(); ++b) {
        const Branch& branch = model.branches[b];
        const auto sides = sides_of(model, branch, comparison.branches[b].steps);
        const SolverSettings solver{.leg = Leg::equilibrium, .every = comparison.branches[b].every};
        defined.branches.push_back(walk(model, defined.channels, branch, sides, solver).curve);
    }
    return defined;
}

MeasuredComparison compare_measured(const Model& model, const Comparison& comparison,
                                    const Points& measured, const DefinedCurves& defined) {
    MeasuredComparison result;
    result.columns = as_they_stand(model, comparison, measured.columns);
    const auto read = [&](std::optional<std::size_t> placed, const std::vector<double>& x) {
        Lines lines = lines_of(comparison, placed);
        const auto branch = branches_of(model, comparison, measured.branch, x, placed);
        if (result.branch.empty())
            for (const int b : branch)
                result.branch.push_back(
                    b < 0 ? "" : comparison.branches[static_cast<std::size_t>(b)].branch);
        MeasuredReading reading{!placed, {}};
        Points means;
        means.columns = result.columns;
        for (auto& column : means.columns) {
            const auto loops = take_means(column, x, result.branch);
            if (result.readings.empty())
                result.loops.insert(result.loops.end(), loops.begin(), loops.end());
        }
        if (result.readings.empty())
            result.explanations = causes_of(comparison, means, branch, placed, x, defined);
        for (const auto& column : means.columns) {
            MeasuredRow row{.channel = column.channel, .off = {}};
            std::array<double, legs.size()> squares{};
            row.off.fill({nan, nan});
            for (std::size_t b = 0; b < lines.size(); ++b)
                for (const Leg leg : legs)
                    lines[b][static_cast<std::size_t>(leg)].channel =
                        comparison.branches[b].run(leg).curve.channel(column.channel);
            for (std::size_t k = 0; k < x.size(); ++k) {
                if (branch[k] < 0) continue;
                std::array<double, legs.size()> now{};
                for (const Leg leg : legs)
                    now[static_cast<std::size_t>(leg)] =
                        lines[static_cast<std::size_t>(branch[k])][static_cast<std::size_t>(leg)]
                            .at(x[k]) -
                        column.values[k];
                if (!std::ranges::all_of(now, [](double d) { return std::isfinite(d); })) continue;
                ++row.compared;
                for (std::size_t l = 0; l < legs.size(); ++l) {
                    squares[l] += now[l] * now[l];
                    if (!(std::abs(now[l]) <= std::abs(row.off[l].signed_max)))
                        row.off[l].signed_max = now[l];
                }
            }
            for (std::size_t l = 0; l < legs.size(); ++l)
                if (row.compared > 0) row.off[l].rms = std::sqrt(squares[l] / row.compared);
            result.compared += row.compared;
            reading.rows.push_back(row);
        }
        result.readings.push_back(std::move(reading));
    };
    if (!measured.a.empty()) read({}, measured.a);
    if (measured.abscissa && !measured.at.empty()) read({measured.abscissa}, measured.at);
    return result;
}

}  // namespace elastocheck::compare
