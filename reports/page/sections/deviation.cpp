// Section: deviation of the recursion along the branches, against the tolerance and the reference
// uncertainty.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

// The worst deviations of a unit over a sweep, as curves and as a table.
struct Worst {
    Series load{"", Series::Style::line, vermilion};
    Series travel{"", Series::Style::dashed, blue};  // dashed, since it may cover the other curve
    Series recommended{"", Series::Style::line, green};
    Series references{"difference of the references", Series::Style::thin, slate};
    double load_peak = 0, travel_peak = 0, apart = 0;
    bool complete = true;  // both references reached the end
    Table table{};

    std::vector<Series*> compared() { return {&load, &travel, &recommended}; }
};

// Maximum over the compared points; points out of reach of the other leg are NaN.
void raise_peak(double& most, const Profile& profile) {
    for (const double value : profile)
        if (value > most) most = value;
}

// At the same parameter; empty without one.
std::string recommended_at(const compare::Profile* profile, const Profile& errors, double a,
                           double extent) {
    std::size_t nearest = 0;
    for (std::size_t l = 0; l < errors.size(); ++l)
        if (std::abs(profile->a[l] - a) < std::abs(profile->a[nearest] - a)) nearest = l;
    const bool same =
        !errors.empty() && std::abs(profile->a[nearest] - a) <= 1e-9 * std::abs(extent);
    return same ? number(errors[nearest]) : "–";
}

Worst worst_of(const SceneAnalyses& scene, const Sweep& sweep, Unit unit) {
    Worst worst;
    worst.load.title = "published, " + sweep.at_equal_parameter();
    worst.travel.title = "published, " + sweep.at_equal_abscissa();
    const auto column = [&](const std::string& name) {
        worst.table.columns.push_back({fmt::format("{} [{}]", name, symbol(unit))});
    };
    worst.table.columns = {{sweep.parameter}};
    column(worst.load.title), column(worst.travel.title);
    if (scene.recommended) {
        const std::string which = configuration(scene.recommended->configuration);
        worst.recommended.title = which + ", " + sweep.at_equal_parameter();
        column(which);
    }
    column("difference of the references");
    const auto& channels = scene.comparison.channels;
    std::vector<std::pair<double, std::vector<std::string>>> rows_by_load;
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
        const compare::Profile* recommended = nullptr;
        if (scene.recommended)
            for (const auto& [name, profile] : scene.recommended->branches)
                if (name == branch.name()) recommended = &profile;
        const Profile errors = recommended ? profile_of(*recommended, unit) : Profile{};
        if (recommended) append(worst.recommended, recommended->a, errors);
        for (const auto k : thinned(by_load.size(), 7)) {
            if (k == 0 && !rows_by_load.empty()) continue;
            std::vector<std::string> row{number(a[k], 4), number(by_load[k]),
                                         k < by_travel.size() ? number(by_travel[k]) : "–"};
            if (scene.recommended)
                row.push_back(recommended_at(recommended, errors, a[k], a.back()));
            row.push_back(k < uncertainty.size() ? number(uncertainty[k]) : "–");
            rows_by_load.emplace_back(a[k], row);
        }
    }
    std::ranges::sort(rows_by_load, {}, [](const auto& row) { return row.first; });
    for (auto& [load, row] : rows_by_load) worst.table.rows.push_back(std::move(row));
    worst.table.folded = true;
    return worst;
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
    worst.table.caption = fmt::format("Worst of {}, {}", which, sweep.name);
    return FigureGroup{
        fmt::format("Worst of {}. {}", which, agreement), {figure}, std::move(worst.table)};
}

// 0 below 1e-9, which is rounding.
std::string small(double value) { return value < 1e-9 ? "0" : number(value, 2); }

// A dash for what does not move.
std::string share_of(double deviation, double range) {
    return range < 1e-9 ? "–" : percent(deviation / range);
}

// Positions of the channels in a table: the main ones, and of each joint its worst force and moment
// component.
std::vector<std::size_t> shown_channels(const std::vector<compare::Channel>& channels,
                                        const compare::BranchComparison& branch) {
    const auto& load = branch.deviation.equal_parameter.channels;
    std::vector<std::size_t> rows;
    for (std::size_t c = 0; c < load.size(); ++c) {
        const auto& channel = channels[c];
        // travel duplicates wheel_centre_z
        if (!branch.determined[c] || (channel.kinematic() && !channel.main)) continue;
        const auto joint = channel.name.substr(0, channel.name.find('.')) + ".";
        if (!channel.main && !rows.empty() && channels[rows.back()].name.starts_with(joint) &&
            channels[rows.back()].unit == channel.unit) {
            if (load[c].max > load[rows.back()].max) rows.back() = c;
        } else {
            rows.push_back(c);
        }
    }
    std::erase_if(rows, [&](std::size_t c) { return !channels[c].main && load[c].max < 1e-6; });
    return rows;
}

Table deviations(const SceneAnalyses& scene, const ComparedBranch& branch) {
    const Sweep alone = sweep_of(scene, branch);
    Table table{.caption = fmt::format(
                    "Deviation of the published recursion from the full solution, branch {}",
                    branch.name()),
                .columns = {{"output", true},
                            {"range"},
                            {"max " + alone.at_equal_parameter()},
                            {fmt::format("at [{}]", alone.unit)},
                            {"rms"},
                            {"share"},
                            {"max " + alone.at_equal_abscissa()},
                            {alone.abscissa.empty()
                                 ? "at"
                                 : "at" + alone.abscissa.substr(alone.abscissa.find(" ["))},
                            {"rms"},
                            {"share"},
                            {"difference of the references"}},
                .folded = true};
    const auto& result = *branch.result;
    const auto &load = result.deviation.equal_parameter.channels,
               &travel = result.deviation.equal_abscissa.channels,
               &uncertainty = result.uncertainty.equal_parameter.channels;
    for (const std::size_t c : shown_channels(scene.comparison.channels, result)) {
        std::vector<std::string> row{heading(scene.comparison.channels[c]),
                                     number(load[c].range, 4)};
        const auto add = [&](const compare::Deviation& d) {
            row.insert(row.end(), {deviation_number(d.signed_max), number(d.at, 4), small(d.rms),
                                   share_of(d.max, d.range)});
        };
        add(load[c]);
        if (c < travel.size())
            add(travel[c]);
        else
            row.insert(row.end(), {"–", "–", "–", "–"});
        row.push_back(c < uncertainty.size() ? number(uncertainty[c].max, 2) : "–");
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace

std::optional<Section> deviation_section(const SceneAnalyses& scene) {
    Section section{
        .id = "deviation", .title = "Deviation over the branch", .part = Part::evidence};
    for (const auto& sweep : sweeps_of(scene))
        for (const Unit unit : {Unit::mm, Unit::deg})
            if (auto made = group(scene, sweep, unit)) section.figures.push_back(std::move(*made));
    for (const auto& branch : branches_of(scene)) {
        section.tables.push_back(deviations(scene, branch));
        const std::string& why = branch.result->deviation.equal_abscissa.not_compared;
        if (!why.empty())
            section.words["notes"].push_back(
                {{"branch", branch.name()},
                 {"reading", sweep_of(scene, branch).at_equal_abscissa()},
                 {"why", why}});
    }
    if (section.figures.empty() && section.tables.empty()) return std::nullopt;
    return section;
}

}  // namespace elastocheck::reports
