#include "reports/page/sections/kinematics/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <ranges>

#include "reports/page/chart.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using Rows = std::vector<std::vector<double>>;
using compare::Presentation;

// Range of all curves of a figure, and the largest extent of one of them.
struct CurveRange {
    double low = INFINITY, high = -INFINITY, moved = 0;
};

// The curve of a wheel in one case; a gap where the quantity is undefined or passes through infinity.
Rows rows_of(const std::vector<double>& x, const std::vector<double>& values, Scale scale,
             const Quantity& quantity, CurveRange& extent) {
    Rows rows;
    double low = INFINITY, high = -INFINITY, farthest = 0;
    for (const double at : x) farthest = std::max(farthest, std::abs(at));
    const double middle = quantity.presentation == Presentation::off_centre ? 0.2 * farthest : -1;
    const compare::Entry* entry = compare::find_entry(quantity.name);
    const bool has_poles = entry != nullptr && entry->properties.swing_arm;
    for (const auto j : thinned(values.size(), 41)) {
        const double y = scale(values[j]);
        const bool shown = std::isfinite(y) && std::isfinite(x[j]) && std::abs(x[j]) > middle;
        const bool turned =
            shown && has_poles && !rows.empty() && !rows.back().empty() && rows.back()[1] * y < 0;
        if ((!shown || turned) && !rows.empty() && !rows.back().empty()) rows.emplace_back();
        if (!shown) continue;
        rows.push_back({without_rounding(x[j]), without_rounding(y)});
        low = std::min(low, y);
        high = std::max(high, y);
    }
    extent.low = std::min(extent.low, low);
    extent.high = std::max(extent.high, high);
    if (high > low) extent.moved = std::max(extent.moved, high - low);
    return rows;
}

// The curves of a quantity, one for each load case and wheel, or element where it is of springs or dampers.
// Measured and candidate points are added to `given`.
std::vector<DrawnCurve> curves_of(const SceneAnalyses& scene, const Family& family,
                                  const Quantity& quantity, CurveRange& extent,
                                  std::vector<DrawnCurve>& given) {
    std::vector<DrawnCurve> curves;
    for (const Case& c : family.cases) {
        const std::string legend = c.legend() + direction_of(scene, family, c);
        for (const auto& output : outputs_of(scene, quantity.name)) {
            const auto values = c.curve.channel(output.channel),
                       x = abscissa_of(scene, family, c, output.wheel);
            if (values.empty() || values.size() != x.size()) continue;
            const Scale scale = scale_of(quantity, output.wheel.side, values, c.curve.start);
            const std::string wheel = output.of_all ? "" : output.wheel.name;
            add_curve(curves, {output.element.empty() ? legend : output.element, wheel,
                               rows_of(x, values, scale, quantity, extent)});
            std::ranges::move(given_of(scene, family, c, output, scale), std::back_inserter(given));
        }
    }
    return curves;
}

// Whether the points are the same, in the same order or, as of two wheels in roll, in the opposite one.
bool coincide(const Rows& a, const Rows& b) {
    double size = 0;
    for (const auto& row : a)
        for (const double v : row) size = std::max(size, std::abs(v));
    const auto same = [&](const auto& one, const auto& other) {
        return std::ranges::equal(
            one, other, [&](double v, double w) { return std::abs(v - w) <= 1e-6 * size; });
    };
    return std::ranges::equal(a, b, same) || std::ranges::equal(a, b | std::views::reverse, same);
}

// At most `most` points of every curve, without gaps if some are left out. A gap is a row without numbers.
Table table_of_points(const compare::Chart& chart, const std::vector<DrawnCurve>& curves,
                      std::size_t most) {
    struct At {
        const DrawnCurve* curve;
        double x, y;
    };
    std::vector<At> points;
    for (const auto& curve : curves) {
        Rows rows = curve.rows;
        if (rows.size() > most) std::erase_if(rows, [](const auto& row) { return row.empty(); });
        for (const auto k : thinned(rows.size(), most))
            points.push_back(rows[k].empty() ? At{&curve, compare::nan, compare::nan}
                                             : At{&curve, rows[k][0], rows[k][1]});
    }
    return compare::table<At>(
        {.caption = fmt::format("{} over {}", chart.y.front(), chart.x), .detail = true},
        {{chart.by[0], Digits::words, [](const At& at) { return at.curve->legend; }},
         {chart.by[1], Digits::words, [](const At& at) { return at.curve->wheel; }},
         {chart.x, Digits::place, &At::x},
         {chart.y.front(), Digits::four, &At::y}},
        points);
}

}  // namespace

bool add_curve(std::vector<DrawnCurve>& curves, DrawnCurve curve) {
    if (curve.rows.empty() || std::ranges::any_of(curves, [&](const DrawnCurve& other) {
            return other.legend == curve.legend && coincide(other.rows, curve.rows);
        }))
        return false;
    curves.push_back(std::move(curve));
    return true;
}

FigureGroup figure_of_curves(compare::Chart chart, const std::vector<DrawnCurve>& curves,
                             const std::string& description, std::string caption) {
    chart.kind = compare::Chart::Kind::lines;
    chart.by = {"curve", "wheel"};
    Figure figure = figure_of(chart, table_of_points(chart, curves, SIZE_MAX));
    figure.description = description;
    if (!caption.empty()) caption[0] = static_cast<char>(std::toupper(caption[0]));
    return {std::move(caption), {std::move(figure)}, table_of_points(chart, curves, 7)};
}

void add_figures(Section& section, const SceneAnalyses& scene, const Family& family) {
    if (family.cases.empty()) return;
    auto quantities = family.quantities;
    if (family.with_given_only)
        std::ranges::copy(compare::figures_over(compare::DrawnAbscissa::if_given),
                          std::back_inserter(quantities));
    std::vector<std::string> names, given_names{"measured"};
    for (const auto& c : family.cases) names.push_back(c.sweep.name);
    for (const auto& candidate : scene.candidates) given_names.push_back(candidate.judgement.name);
    for (const auto& quantity : quantities) {
        const bool with_given_only = &quantity - quantities.data() >= std::ssize(family.quantities);
        CurveRange extent;
        std::vector<DrawnCurve> given;
        auto curves = curves_of(scene, family, quantity, extent, given);
        // A quantity that does not move is left out, unless there are measured or candidate values.
        const double size = std::max(1e-3, std::max(std::abs(extent.low), extent.high));
        if (curves.empty() || (given.empty() && (with_given_only || !(extent.moved > 1e-6 * size))))
            continue;
        std::ranges::move(given, std::back_inserter(curves));
        const std::string unit = outputs_of(scene, quantity.name).front().unit;
        const bool change = quantity.presentation == Presentation::change ||
                            quantity.presentation == Presentation::outward_change;
        section.figures.push_back(figure_of_curves(
            {.id = fmt::format("{}-{}", slug(quantity.name), family.id),
             .title = quantity.title,
             .x = family.x +
                  (family.cases.size() == 1 ? direction_of(scene, family, family.cases[0]) : ""),
             .y = {fmt::format("{} [{}]", change ? "change" : label_of(quantity), unit)},
             .rings = given_names},
            curves,
            fmt::format("{} over {} by the full solution, {}: from {} to {} {}.", quantity.title,
                        family.x, enumerated(names), number(extent.low), number(extent.high), unit),
            quantity.sign.empty() ? quantity.title : quantity.sign));
    }
}

}  // namespace elastocheck::reports
