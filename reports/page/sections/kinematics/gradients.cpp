// Section: straight lines fitted to the curves about the design position, as rigs give them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "compare/outputs/slope.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/kinematics/cases.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

// Abscissa of a fit: half its range and its unit, and what gradients are per.
struct Fitted {
    By by;
    compare::DrawnAbscissa abscissa;
    double range, per;
    const char *unit, *per_unit, *words;
};
Fitted fitted_over(const Sweep& sweep) {
    using enum compare::DrawnAbscissa;
    if (sweep.kind == "roll") return {By::roll, roll, 1, 1, "deg", "deg", "roll towards the wheel"};
    if (sweep.lifts()) return {By::travel, travel, 20, 100, "mm", "100 mm", "wheel travel"};
    if (sweep.kind == "moment") return {By::push, load, 100, 100, "N·m", "100 N·m", "moment"};
    if (is_force_test(sweep)) return {By::push, load, 1000, 1000, "N", "kN", "force"};
    if (sweep.unit == "mm") return {By::parameter, steering, 10, 1, "mm", "mm", "the rack"};
    return {By::parameter, steering, 20, 1, "deg", "deg", "the steering"};
}

struct FittedLine {
    double slope = compare::nan, from = 0, to = 0;
};
// The line through the points within the range about 0, or through the three nearest ones.
FittedLine line_of(const std::vector<double>& x, const std::vector<double>& y, double range) {
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < x.size(); ++k) points.emplace_back(x[k], y[k]);
    std::ranges::stable_sort(points, {}, [](const auto& point) { return std::abs(point.first); });
    FittedLine line;
    std::vector<double> at, values;
    for (const auto& [a, value] : points) {
        if (at.size() >= 3 && !(std::abs(a) <= range * (1 + 1e-9))) break;
        at.push_back(a);
        values.push_back(value);
        line.from = std::min(line.from, a);
        line.to = std::max(line.to, a);
    }
    line.slope = compare::finite_or_nan(compare::slope(at, values));
    return line;
}

struct GradientRow {
    std::string figure, unit;
    std::vector<double> values;  // of the wheels
    double mean = compare::nan;
};

Table gradients_over(const SceneAnalyses& scene, const Case& c) {
    const Fitted fit = fitted_over(c.sweep);
    const auto& wheels = scene.model.wheels;
    const Family family{.id = "", .x = "", .by = fit.by};
    std::vector<GradientRow> rows;
    FittedLine range;
    for (const auto& quantity : compare::figures_over(fit.abscissa)) {
        if (!quantity.has_gradient || quantity.presentation == compare::Presentation::off_centre)
            continue;
        GradientRow row{label_of(quantity), "", std::vector(wheels.size(), compare::nan)};
        double sum = 0, count = 0;
        for (const auto& output : outputs_of(scene, quantity.name)) {
            auto x = abscissa_of(scene, family, c, output.wheel),
                 y = c.curve.channel(output.channel);
            if (x.size() != y.size()) continue;
            // rolls towards this wheel
            if (fit.by == By::roll && !output.of_all)
                for (double& value : x) value *= -output.wheel.side;
            const Scale scale = scale_of(quantity, output.wheel.side, y, c.curve.start);
            const FittedLine line = line_of(x, y, fit.range);
            if (std::isnan(line.slope)) continue;
            // forces per mm, not per 100 mm
            const bool of_force = output.unit == "N" && fit.by == By::travel;
            const double value =
                without_rounding(scale.factor * line.slope * (of_force ? 1 : fit.per));
            range.from = std::min(range.from, line.from);
            range.to = std::max(range.to, line.to);
            row.unit = fmt::format("{}/{}", output.unit, of_force ? "mm" : fit.per_unit);
            for (std::size_t w = 0; w < wheels.size() && !output.of_all; ++w)
                if (wheels[w].name == output.wheel.name) row.values[w] = value;
            sum += value;
            ++count;
        }
        if (count > 0) {
            row.mean = sum / count;
            rows.push_back(std::move(row));
        }
    }
    using R = GradientRow;
    std::vector<compare::ColumnOf<R>> columns{{"gradient of", Digits::words, &R::figure}};
    for (std::size_t w = 0; w < wheels.size() && wheels.size() > 1; ++w)
        columns.push_back({wheels[w].name, Digits::four, [w](const R& r) { return r.values[w]; }});
    columns.push_back({wheels.size() > 1 ? "mean" : "value", Digits::four, &R::mean});
    columns.push_back({"unit", Digits::words, &R::unit});
    Table table = compare::table({}, columns, rows);
    const std::string positive = push_of(scene, c, wheels[0]).positive;
    table.caption = fmt::format("{}{}{}, over {} from {} to {}\u00a0{}", c.legend(),
                                positive.empty() ? "" : " ", positive, fit.words,
                                short_number(range.from), short_number(range.to), fit.unit);
    return table;
}

}  // namespace

std::optional<Section> gradients_section(const SceneAnalyses& scene) {
    if (scene.model.wheels.empty()) return std::nullopt;
    Section section{.id = "gradients", .title = "Gradients", .part = Part::behaviour};
    std::set<std::string> lifted;  // one test of each kind of lift
    for (const auto& c : cases_of(scene, [](const Sweep& s) {
             return s.lifts() || s.kind == "steering" || is_force_test(s);
         })) {
        if (c.sweep.lifts() && !lifted.insert(c.sweep.kind).second) continue;
        if (Table table = gradients_over(scene, c); !table.rows.empty())
            section.tables.push_back(std::move(table));
    }
    return section.tables.empty() ? std::nullopt : std::optional(section);
}

}  // namespace elastocheck::reports
