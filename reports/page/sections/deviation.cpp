// Section: deviation of the recursion along the branches, against the tolerance and
// the reference uncertainty.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "compare/outputs/curve.hpp"
#include "compare/tables/compare_result.hpp"
#include "reports/page/chart.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::Leg;
using compare::Unit;

// The worst deviations of the main outputs of a unit at one point of a sweep; NaN without a comparison.
struct DeviationAt {
    double a, load, travel, recommended, references;
};

std::vector<double> errors_of(const compare::Profile& profile, Unit unit) {
    std::vector<double> values;
    for (const auto& apart : profile.deviation)
        values.push_back(unit == Unit::mm ? apart.mm : apart.deg);
    return values;
}

// Deviations at up to 60 points a branch, in ascending order of the parameter.
std::vector<DeviationAt> deviations_over(const SceneAnalyses& scene, const Sweep& sweep,
                                         Unit unit) {
    const auto& channels = scene.comparison.channels;
    std::vector<DeviationAt> stations;
    for (const auto& branch : sweep.branches) {
        const compare::Curve &truth = branch.truth(),
                             &other = branch.result->run(Leg::recursive).curve,
                             &second = branch.result->run(branch.result->second).curve;
        const auto by = compare::abscissa(channels, branch.result->abscissa, truth, other);
        const auto load = errors_of(profile_at_equal_parameter(channels, truth, other), unit),
                   travel = errors_of(profile_at_equal_abscissa(channels, truth, other, by), unit),
                   uncertainty =
                       errors_of(profile_at_equal_parameter(channels, truth, second), unit);
        compare::Profile chosen;
        if (scene.recommended)
            for (const auto& [name, profile] : scene.recommended->branches)
                if (name == branch.name()) chosen = profile;
        const auto errors = errors_of(chosen, unit);
        const auto recommended = [&](double a) {
            for (std::size_t l = 0; l < errors.size(); ++l)
                if (std::abs(chosen.a[l] - a) <= 1e-9 * std::abs(truth.a.back())) return errors[l];
            return compare::nan;
        };
        const auto value = [](const std::vector<double>& list, std::size_t k) {
            return k < list.size() ? list[k] : compare::nan;
        };
        for (const auto k : thinned(load.size(), 60))
            if (truth.a[k] != 0 || stations.empty())
                stations.push_back({truth.a[k], load[k], value(travel, k), recommended(truth.a[k]),
                                    value(uncertainty, k)});
    }
    std::ranges::stable_sort(stations, {}, &DeviationAt::a);
    return stations;
}

// A column for the parameter and one for each comparison.
Table table_of(const std::vector<DeviationAt>& stations, const SceneAnalyses& scene,
               const Sweep& sweep, Unit of_unit) {
    using enum Digits;
    using S = DeviationAt;
    const char* unit = symbol(of_unit);
    return compare::table<S>(
        {},
        {{sweep.parameter, place, &S::a},
         {"published, " + sweep.at_equal_parameter(), three, &S::load, "", unit},
         {"published, " + sweep.at_equal_abscissa(), three, &S::travel, "", unit},
         {scene.recommended
              ? configuration(scene.recommended->configuration) + ", " + sweep.at_equal_parameter()
              : "recommended",
          three, &S::recommended, "", unit},
         {"difference of the references", three, &S::references, "", unit}},
        stations);
}

// Largest value; a point that the other leg does not reach is NaN, and ignored.
double peak_of(const std::vector<DeviationAt>& stations, double DeviationAt::*value) {
    double peak = 0;
    for (const auto& station : stations)
        if (station.*value > peak) peak = station.*value;
    return peak;
}

// Worst deviation per unit: a figure over six decades with its table.
std::optional<FigureGroup> deviations(const SceneAnalyses& scene, const Sweep& sweep,
                                      Unit of_unit) {
    std::vector<std::string> names;
    for (const auto& c : scene.comparison.channels)
        if (c.main && c.unit == of_unit) names.push_back(as_words(c.name));
    const std::string unit = symbol(of_unit), which = enumerated(names);
    const auto stations = deviations_over(scene, sweep, of_unit);
    Table table = table_of(stations, scene, sweep, of_unit);
    std::vector<std::string> curves;
    for (std::size_t c = 1; c < table.columns.size(); ++c) curves.push_back(table.columns[c].name);
    Figure figure =
        figure_of({.id = fmt::format("deviation-{}-{}", slug(sweep.name), unit),
                   .title = fmt::format("{}: worst deviation, {}",
                                        of_unit == Unit::deg ? "Angles" : "Positions", sweep.name),
                   .x = sweep.parameter,
                   .y = curves,
                   .log_y = true},
                  table, fmt::format("deviation [{}]", unit));
    if (names.empty() || figure.series.empty()) return std::nullopt;
    const double tolerance = !scene.trade          ? INFINITY
                             : of_unit == Unit::mm ? scene.trade->tolerance.mm
                                                   : scene.trade->tolerance.deg;
    for (auto& series : figure.series) series.style = Series::Style::line;
    add_tolerance(figure, tolerance, unit, 6);
    const double load = peak_of(stations, &DeviationAt::load),
                 travel = peak_of(stations, &DeviationAt::travel);
    const bool complete =
        stations.size() > 1 && std::ranges::none_of(stations, [](const DeviationAt& s) {
            return std::isnan(s.references);
        });
    const std::string agreement =
        complete ? fmt::format("The references differ by at most {}.",
                               quantity(peak_of(stations, &DeviationAt::references), unit))
                 : "Not both references reached the end.";
    figure.description = fmt::format(
        "Logarithmic plot over the {} from {} to {} {}. Largest deviation of {} from the full "
        "solution: published {} up to {}{}. {}",
        compare::parameter_word(sweep.unit), number(stations.front().a, 4),
        number(stations.back().a, 4), sweep.unit, which, sweep.at_equal_parameter(),
        quantity(load, unit),
        travel > 0 ? fmt::format(", {} up to {}", sweep.at_equal_abscissa(), quantity(travel, unit))
                   : "",
        agreement);
    table.caption = fmt::format("Worst of {}, {}", which, sweep.name);
    table.detail = true;
    const auto whole = std::move(table.rows);
    table.rows.clear();
    for (const auto k : thinned(whole.size(), 13)) table.rows.push_back(whole[k]);
    return FigureGroup{
        fmt::format("Worst of {}. {}", which, agreement), {figure}, std::move(table)};
}

// Errors of the recursion in the rates. A value that its error exceeds is zero: no share of it is given.
Table errors_in_rates(const compare::Comparison& comparison) {
    auto design = characteristic_rows(comparison);
    for (auto& r : design) {
        r.output = as_words(r.output);
        if (!(std::abs(r.off_percent) <= 100)) r.off_percent = compare::nan;
    }
    Table table = with_columns(table_of(design), {"output", "value", "unit", "off", "off %"});
    table.caption = "Error of the published recursion in the rates at the design position";
    table.detail = true;
    return table;
}

}  // namespace

std::optional<Section> deviation_section(const SceneAnalyses& scene) {
    Section section{
        .id = "deviation", .title = "Deviation over the branch", .part = Part::evidence};
    for (const auto& sweep : sweeps_of(scene))
        for (const Unit unit : {Unit::mm, Unit::deg})
            if (auto made = deviations(scene, sweep, unit))
                section.figures.push_back(std::move(*made));
    for (const auto& branch : scene.comparison.branches) {
        Table& table = section.tables.emplace_back(deviation_table(scene.comparison, branch, true));
        table.caption =
            fmt::format("Deviation of the published recursion from the full solution, branch {}",
                        branch.branch);
        table.detail = true;
    }
    if (Table rates = errors_in_rates(scene.comparison); !rates.rows.empty())
        section.tables.push_back(std::move(rates));
    if (section.figures.empty() && section.tables.empty()) return std::nullopt;
    return section;
}

}  // namespace elastocheck::reports
