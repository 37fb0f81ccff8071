#include "compare/candidate/measured.hpp"
#include "compare/deviation/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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

Lines lines_of(const Comparison& comparison, std::optional<std::size_t> placed) {
    Lines lines(comparison.branches.size());
    for (std::size_t b = 0; b < lines.size(); ++b)
        for (const Leg leg : legs)
            lines[b][static_cast<std::size_t>(leg)].over =
                placed_by(comparison.branches[b].run(leg).curve, placed);
    return lines;
}

}  // namespace

MeasuredComparison compare_measured(const Model& model, const Comparison& comparison,
                                    const Points& measured) {
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
        for (const auto& column : result.columns) {
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
