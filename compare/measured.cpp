#include "compare/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace elastocheck::compare {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const Curve& curve_of(const BranchComparison& branch, Leg leg) {
    return branch.runs[static_cast<std::size_t>(leg)].curve;
}

// What the points are placed by: the parameter, or a channel.
struct Place {
    std::optional<std::size_t> channel;
    std::vector<double> over(const Curve& curve) const { return channel ? curve.channel(*channel) : curve.a; }
};

// A leg's curve along one branch as it is read; made once, for points may be many.
struct Line {
    std::vector<double> over;     // what points are placed by; empty where it turns back
    std::vector<double> channel;  // the output that is asked for

    bool reaches(double x) const {
        return !over.empty() && x >= std::min(over.front(), over.back()) &&
               x <= std::max(over.front(), over.back());
    }
    double at(double x) const { return reaches(x) ? interpolate(over, channel, x, 6) : nan; }
};
using Lines = std::vector<std::array<Line, legs.size()>>;  // per branch and leg

Lines lines_of(const Comparison& comparison, const Place& place) {
    Lines lines(comparison.branches.size());
    for (std::size_t b = 0; b < lines.size(); ++b)
        for (const Leg leg : legs) {
            auto& over = lines[b][static_cast<std::size_t>(leg)].over;
            over = place.over(curve_of(comparison.branches[b], leg));
            if (!trend(over).monotonic()) over.clear();
        }
    return lines;
}

// Whether two branches go to different sides of a = 0: then a point without a name belongs to one at most.
bool apart(const Branch& a, const Branch& b) {
    const auto low = [](const Branch& x) { return std::min(x.from, x.to); };
    const auto high = [](const Branch& x) { return std::max(x.from, x.to); };
    return high(a) <= 0 ? low(b) >= 0 : low(a) >= 0 && high(b) <= 0;
}

// Position in Comparison::branches of each point's branch, or -1.
std::vector<int> branches_of(const Model& model, const Comparison& comparison, const Measured& measured,
                             const Lines& lines, const std::vector<double>& x) {
    const auto& all = comparison.branches;
    std::vector<int> result;
    if (!measured.branch.empty()) {
        for (const auto& name : measured.branch) {
            const auto found = std::ranges::find(all, name, &BranchComparison::branch);
            if (found == all.end())
                throw std::invalid_argument(fmt::format("the scene has no branch '{}'", name));
            result.push_back(static_cast<int>(found - all.begin()));
        }
        return result;
    }
    for (std::size_t a = 0; a < all.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
            if (!apart(model.branches[a], model.branches[b]))
                throw std::invalid_argument(fmt::format(
                    "branches '{}' and '{}' lie on the same side; a point has to say which one it "
                    "belongs to",
                    all[b].branch, all[a].branch));
    for (const double at : x) {
        const auto found = std::ranges::find_if(lines, [&](const auto& of_branch) {
            return of_branch[static_cast<std::size_t>(Leg::equilibrium)].reaches(at);
        });
        result.push_back(found == lines.end() ? -1 : static_cast<int>(found - lines.begin()));
    }
    return result;
}

}  // namespace

MeasuredComparison compare_measured(const Model& model, const Comparison& comparison,
                                    const Measured& measured) {
    MeasuredComparison result;
    const auto drawn = evaluate(model, comparison.channels, design_state(model));
    result.columns = measured.columns;
    for (auto& column : result.columns) {
        if (column.change)
            for (double& value : column.values) value += drawn[column.channel];
        column.change = false;
    }
    const auto read = [&](const Place& place, const std::vector<double>& x) {
        Lines lines = lines_of(comparison, place);
        const auto branch = branches_of(model, comparison, measured, lines, x);
        if (result.branch.empty())
            for (const int b : branch)
                result.branch.push_back(b < 0 ? "" : comparison.branches[static_cast<std::size_t>(b)].branch);
        MeasuredReading reading{!place.channel, {}};
        for (const auto& column : result.columns) {
            MeasuredRow row{.channel = column.channel, .off = {}};
            std::array<double, legs.size()> squares{};
            row.off.fill({nan, nan});
            for (std::size_t b = 0; b < lines.size(); ++b)
                for (const Leg leg : legs)
                    lines[b][static_cast<std::size_t>(leg)].channel =
                        curve_of(comparison.branches[b], leg).channel(column.channel);
            for (std::size_t k = 0; k < x.size(); ++k) {
                if (branch[k] < 0) continue;
                std::array<double, legs.size()> now{};
                for (const Leg leg : legs)
                    now[static_cast<std::size_t>(leg)] =
                        lines[static_cast<std::size_t>(branch[k])][static_cast<std::size_t>(leg)].at(x[k]) -
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
