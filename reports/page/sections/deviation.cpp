// Section: deviation of the recursion along the branches, against the tolerance and the reference
// uncertainty.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/tables/compare_result.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::Leg;
using compare::Unit;

// Worst main channel of a unit at each point of the equilibrium leg; NaN without a comparison.
using Profile = std::vector<double>;
Profile profile_of(const compare::Profile& profile, Unit unit) {
    Profile values;
    for (const auto& apart : profile.apart)
        values.push_back(unit == Unit::mm ? apart.mm : apart.deg);
    return values;
}

// Gaps at zero and NaN, for a logarithmic axis. Ends are kept, the rest thinned.
void append(Series& series, const std::vector<double>& load, const Profile& profile) {
    if (!series.rows.empty()) series.rows.emplace_back();
    for (const auto k : thinned(profile.size(), 60))
        if (profile[k] >= 0) series.rows.push_back({load[k], profile[k]});
}

double tolerance_of(const SceneAnalyses& scene, Unit unit) {
    if (!scene.trade) return INFINITY;
    return unit == Unit::mm ? scene.trade->tolerance.mm : scene.trade->tolerance.deg;
}

// Deviations at one parameter, for the table.
struct Station {
    double a, load, travel, recommended, references;
};

// The worst deviations of a unit over a sweep, as curves and as a table.
struct Worst {
    Series load{"", Series::Style::line, vermilion};
    Series travel{"", Series::Style::dashed, blue};  // dashed, since it may cover the other curve
    Series recommended{"", Series::Style::line, green};
    Series references{"difference of the references", Series::Style::thin, slate};
    double load_peak = 0, travel_peak = 0, apart = 0;
    bool complete = true;  // both references reached the end
    std::vector<Station> stations{};

    std::vector<Series*> compared() { return {&load, &travel, &recommended}; }
};

// Maximum over the compared points; points out of reach of the other leg are NaN.
void raise_peak(double& most, const Profile& profile) {
    for (const double value : profile)
        if (value > most) most = value;
}

// Of the recommended configuration at the same parameter; NaN without one.
double recommended_at(const compare::Profile& profile, const Profile& errors, double a,
                      double extent) {
    for (std::size_t l = 0; l < errors.size(); ++l)
        if (std::abs(profile.a[l] - a) <= 1e-9 * std::abs(extent)) return errors[l];
    return compare::nan;
}

Worst worst_of(const SceneAnalyses& scene, const Sweep& sweep, Unit unit) {
    Worst worst;
    worst.load.title = "published, " + sweep.at_equal_parameter();
    worst.travel.title = "published, " + sweep.at_equal_abscissa();
    if (scene.recommended)
        worst.recommended.title =
            configuration(scene.recommended->configuration) + ", " + sweep.at_equal_parameter();
    const auto& channels = scene.comparison.channels;
    for (const auto& branch : sweep.branches) {
        const compare::Curve &truth = branch.truth(),
                             &other = branch.result->run(Leg::recursive).curve,
                             &second = branch.result->run(branch.result->second).curve;
        const auto by = compare::abscissa(channels, branch.result->abscissa, truth, other);
        const auto& a = truth.a;
        const Profile by_load =
                          profile_of(profile_at_equal_parameter(channels, truth, other), unit),
                      by_travel =
                          profile_of(profile_at_equal_abscissa(channels, truth, other, by), unit),
                      uncertainty =
                          profile_of(profile_at_equal_parameter(channels, truth, second), unit);
        raise_peak(worst.load_peak, by_load);
        raise_peak(worst.travel_peak, by_travel);
        raise_peak(worst.apart, uncertainty);
        worst.complete =
            worst.complete && uncertainty.size() == by_load.size() && uncertainty.size() > 1;
        append(worst.load, a, by_load);
        append(worst.travel, a, by_travel);
        append(worst.references, a, uncertainty);
        compare::Profile recommended;
        if (scene.recommended)
            for (const auto& [name, profile] : scene.recommended->branches)
                if (name == branch.name()) recommended = profile;
        const Profile errors = profile_of(recommended, unit);
        if (!errors.empty()) append(worst.recommended, recommended.a, errors);
        const auto value = [](const Profile& profile, std::size_t k) {
            return k < profile.size() ? profile[k] : compare::nan;
        };
        for (const auto k : thinned(by_load.size(), 7))
            if (k > 0 || worst.stations.empty())
                worst.stations.push_back({a[k], by_load[k], value(by_travel, k),
                                          recommended_at(recommended, errors, a[k], a.back()),
                                          value(uncertainty, k)});
    }
    std::ranges::stable_sort(worst.stations, {}, &Station::a);
    return worst;
}

Table stations_of(const Worst& worst, const std::string& parameter, const char* unit) {
    using enum Digits;
    using S = Station;
    Table table = compare::table<S>(
        "",
        {{parameter, place, [](const S& s) { return s.a; }},
         {worst.load.title, three, [](const S& s) { return s.load; }, "", unit},
         {worst.travel.title, three, [](const S& s) { return s.travel; }, "", unit},
         {worst.recommended.title, three, [](const S& s) { return s.recommended; }, "", unit},
         {worst.references.title, three, [](const S& s) { return s.references; }, "", unit}},
        worst.stations);
    table.detail = true;
    return table;
}

// The curves over six decades; smaller values lie on the lower edge.
void fill(Figure& figure, Worst& worst, double tolerance) {
    double high = 1e-9;
    for (const auto* series : worst.compared())
        for (const auto& row : series->rows)
            if (row.size() == 2) high = std::max(high, row[1]);
    if (std::isfinite(tolerance)) high = std::max(high, tolerance);
    figure.y_low = std::pow(10, std::floor(std::log10(high)) - 6);
    double best = 0;  // the recommended configuration may be more accurate and stays visible
    for (const auto& row : worst.recommended.rows)
        if (row.size() == 2 && std::isfinite(row[1])) best = std::max(best, row[1]);
    if (best > 0)
        figure.y_low = std::min(figure.y_low, std::pow(10, std::floor(std::log10(best)) - 1));
    auto drawn = worst.compared();
    drawn.push_back(&worst.references);
    for (auto* series : drawn) {
        for (auto& row : series->rows)
            if (row.size() == 2) row[1] = std::max(row[1], figure.y_low);
        const bool seen = std::ranges::any_of(series->rows, [&](const auto& row) {
            return row.size() == 2 && row[1] > figure.y_low;
        });
        if (seen) figure.series.push_back(*series);
    }
    figure.y_high = std::pow(10, std::ceil(std::log10(high * 1.5)));
}

// Worst deviation per unit: a figure with its table.
std::optional<FigureGroup> group(const SceneAnalyses& scene, const Sweep& sweep, Unit of_unit) {
    std::vector<std::string> names;
    for (const auto& c : scene.comparison.channels)
        if (c.main && c.unit == of_unit) names.push_back(as_words(c.name));
    if (names.empty()) return std::nullopt;
    const std::string unit = symbol(of_unit), which = enumerated(names);
    Worst worst = worst_of(scene, sweep, of_unit);
    const double tolerance = tolerance_of(scene, of_unit);
    Figure figure{.id = fmt::format("deviation-{}-{}", slug(sweep.name), unit),
                  .title = fmt::format("{}: worst deviation, {}",
                                       of_unit == Unit::deg ? "Angles" : "Positions", sweep.name),
                  .x = sweep.parameter,
                  .y = fmt::format("deviation from the full solution [{}]", unit),
                  .log_y = true,
                  .height = 1.12};
    fill(figure, worst, tolerance);
    if (figure.series.empty()) return std::nullopt;
    if (std::isfinite(tolerance))
        figure.bands.push_back({figure.y_low, tolerance, "within " + setting(tolerance, unit)});
    const std::string agreement =
        worst.complete
            ? fmt::format("The references differ by at most {}.", quantity(worst.apart, unit))
            : "Not both references reached the end.";
    const auto &first = sweep.branches.front(), &last = sweep.branches.back();
    figure.description = fmt::format(
        "Logarithmic plot over the {} from {} to {} {}. Largest deviation of {} from the full "
        "solution: published {} up to {}{}{}. {}",
        compare::parameter_word(sweep.unit),
        number(sweep.branches.size() > 1 ? last.to() : first.from(), 4), number(first.to(), 4),
        sweep.unit, which, sweep.at_equal_parameter(), quantity(worst.load_peak, unit),
        worst.travel.rows.empty() ? ""
                                  : fmt::format(", {} up to {}", sweep.at_equal_abscissa(),
                                                quantity(worst.travel_peak, unit)),
        std::isfinite(tolerance) ? ", tolerance " + setting(tolerance, unit) : "", agreement);
    Table stations = stations_of(worst, sweep.parameter, symbol(of_unit));
    stations.caption = fmt::format("Worst of {}, {}", which, sweep.name);
    return FigureGroup{
        fmt::format("Worst of {}. {}", which, agreement), {figure}, std::move(stations)};
}

}  // namespace

std::optional<Section> deviation_section(const SceneAnalyses& scene) {
    Section section{
        .id = "deviation", .title = "Deviation over the branch", .part = Part::evidence};
    for (const auto& sweep : sweeps_of(scene))
        for (const Unit unit : {Unit::mm, Unit::deg})
            if (auto made = group(scene, sweep, unit)) section.figures.push_back(std::move(*made));
    for (const auto& branch : scene.comparison.branches) {
        Table& table = section.tables.emplace_back(deviation_table(scene.comparison, branch, true));
        table.caption =
            fmt::format("Deviation of the published recursion from the full solution, branch {}",
                        branch.branch);
        table.detail = true;
    }
    if (section.figures.empty() && section.tables.empty()) return std::nullopt;
    return section;
}

}  // namespace elastocheck::reports
