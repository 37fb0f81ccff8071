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

// Worst main channel of a unit at each point of the equilibrium leg; NaN without a comparison.
using Profile = std::vector<double>;

// Gaps at zero and NaN, for a logarithmic axis. Ends are kept, the rest thinned.
void append(Series& series, const std::vector<double>& load, const Profile& profile) {
    if (!series.rows.empty()) series.rows.emplace_back();
    for (const auto k : thinned(profile.size(), 60))
        if (profile[k] >= 0) series.rows.push_back({load[k], profile[k]});
}

struct Curves {
    Series load{"", Series::Style::line, vermilion};
    Series travel{"", Series::Style::dashed, blue};  // dashed, since it may cover the other curve
    Series recommended{"", Series::Style::line, green};
    Series references{"difference of the references", Series::Style::thin, slate};
};

// Maximum over the compared points; points out of reach of the other leg are NaN.
void raise_peak(double& most, const Profile& profile) {
    for (const double value : profile)
        if (value > most) most = value;
}

// Worst deviation per unit: a figure with its table.
std::optional<FigureGroup> group(const JsonCursor& scene, const Sweep& sweep,
                                 std::string_view unit) {
    auto channels = main_channels_of(scene);
    std::erase_if(channels, [&](const ChannelInfo& c) { return c.unit != unit; });
    if (channels.empty()) return std::nullopt;
    const bool angle = unit == "deg";
    const std::string at_parameter = sweep.at_equal_parameter(),
                      at_abscissa = sweep.at_equal_abscissa();
    Curves curves;
    curves.load.title = "published, " + at_parameter;
    curves.travel.title = "published, " + at_abscissa;
    Table table;
    table.columns = {{sweep.parameter()},
                     {fmt::format("{} [{}]", curves.load.title, unit)},
                     {fmt::format("{} [{}]", curves.travel.title, unit)}};
    const auto recommended = scene.find("recommended");
    if (recommended) {
        curves.recommended.title = configuration(*recommended) + ", " + at_parameter;
        table.columns.push_back({fmt::format("{} [{}]", configuration(*recommended), unit)});
    }
    table.columns.push_back({fmt::format("difference of the references [{}]", unit)});

    double high = 1e-9, load_peak = 0, travel_peak = 0, apart = 0;
    bool complete = true;  // both references reached the end
    std::vector<std::pair<double, std::vector<std::string>>> rows_by_load;
    for (const auto& branch : sweep.branches) {
        const LegCurve a = curve_of(branch, "equilibrium");
        const auto profile = [&](const char* reading) {
            return branch["profiles"][reading][unit].numbers();
        };
        const Profile by_load = profile("at_equal_parameter"),
                      by_travel = profile("at_equal_abscissa"), uncertainty = profile("references");
        for (const auto* one : {&by_load, &by_travel, &uncertainty})
            if (one->size() > a.a.size()) branch["profiles"].fail("more numbers than points");
        raise_peak(load_peak, by_load);
        raise_peak(travel_peak, by_travel);
        raise_peak(apart, uncertainty);
        complete = complete && uncertainty.size() == by_load.size() && uncertainty.size() > 1;
        append(curves.load, a.a, by_load);
        append(curves.travel, a.a, by_travel);
        append(curves.references, a.a, uncertainty);
        Profile recommended_errors;
        std::vector<double> recommended_loads;
        if (recommended)
            for (const auto& own : (*recommended)["branches"].items()) {
                if (own["name"].text() != branch["name"].text()) continue;
                recommended_loads = own["a"].numbers();
                recommended_errors = own[angle ? "error_deg" : "error_mm"].numbers();
                append(curves.recommended, recommended_loads, recommended_errors);
            }
        const auto rows = thinned(by_load.size(), 7);
        for (const auto k : rows) {
            if (k == 0 && !rows_by_load.empty()) continue;
            std::vector<std::string> row{number(a.a[k], 4), number(by_load[k]),
                                         k < by_travel.size() ? number(by_travel[k]) : "–"};
            if (recommended) {
                std::size_t nearest = 0;
                for (std::size_t l = 0; l < recommended_errors.size(); ++l)
                    if (std::abs(recommended_loads[l] - a.a[k]) <
                        std::abs(recommended_loads[nearest] - a.a[k]))
                        nearest = l;
                const bool same =
                    !recommended_errors.empty() &&
                    std::abs(recommended_loads[nearest] - a.a[k]) <= 1e-9 * std::abs(a.a.back());
                row.push_back(same ? number(recommended_errors[nearest]) : "–");
            }
            row.push_back(k < uncertainty.size() ? number(uncertainty[k]) : "–");
            rows_by_load.emplace_back(a.a[k], row);
        }
    }
    std::ranges::sort(rows_by_load, {}, [](const auto& row) { return row.first; });
    for (auto& [load, row] : rows_by_load) table.rows.push_back(std::move(row));
    Figure figure{
        .id = fmt::format("deviation-{}-{}", slug(sweep.name), unit),
        .title = fmt::format("{}: worst deviation, {}", angle ? "Angles" : "Positions", sweep.name),
        .x = sweep.parameter(),
        .y = fmt::format("deviation from the full solution [{}]", unit),
        .log_y = true,
        .height = 1.12};
    std::vector<std::string> names;
    names.reserve(channels.size());
    for (const auto& c : channels) names.push_back(c.label());
    for (const auto* series : {&curves.load, &curves.travel, &curves.recommended})
        for (const auto& row : series->rows)
            if (row.size() == 2) high = std::max(high, row[1]);
    double tolerance = NAN;
    if (const auto trade = scene.find("trade"))
        if (const auto required = (*trade)["tolerance"].find(std::string(unit)))
            tolerance = required->number();
    if (std::isfinite(tolerance)) high = std::max(high, tolerance);
    // Six decades are shown; smaller values lie on the lower edge.
    figure.y_low = std::pow(10, std::floor(std::log10(high)) - 6);
    double best = 0;  // the recommended configuration may be more accurate and stays visible
    for (const auto& row : curves.recommended.rows)
        if (row.size() == 2 && std::isfinite(row[1])) best = std::max(best, row[1]);
    if (best > 0)
        figure.y_low = std::min(figure.y_low, std::pow(10, std::floor(std::log10(best)) - 1));
    for (auto* series : {&curves.load, &curves.travel, &curves.recommended, &curves.references}) {
        for (auto& row : series->rows)
            if (row.size() == 2) row[1] = std::max(row[1], figure.y_low);
        const bool seen = std::ranges::any_of(series->rows, [&](const auto& row) {
            return row.size() == 2 && row[1] > figure.y_low;
        });
        if (seen) figure.series.push_back(*series);
    }
    if (figure.series.empty()) return std::nullopt;
    figure.y_high = std::pow(10, std::ceil(std::log10(high * 1.5)));
    if (std::isfinite(tolerance))
        figure.bands.push_back({figure.y_low, tolerance, "within " + setting(tolerance, unit)});
    const std::string agreement =
        complete ? fmt::format("The references differ by at most {}.", quantity(apart, unit))
                 : "Not both references reached the end.";
    figure.description = fmt::format(
        "Logarithmic plot over the {} from {} to {} {}. Largest deviation of {} from the full "
        "solution: "
        "published {} up to {}{}{}. {}",
        compare::parameter_word(sweep.unit),
        number(sweep.branches.size() > 1 ? sweep.branches.back()["to"].number()
                                         : sweep.branches.front()["from"].number(),
               4),
        number(sweep.branches.front()["to"].number(), 4), sweep.unit, enumerated(names),
        at_parameter, quantity(load_peak, unit),
        curves.travel.rows.empty()
            ? ""
            : fmt::format(", {} up to {}", at_abscissa, quantity(travel_peak, unit)),
        std::isfinite(tolerance) ? ", tolerance " + setting(tolerance, unit) : "", agreement);
    table.caption = fmt::format("Worst of {}, {}", enumerated(names), sweep.name);
    table.folded = true;
    return FigureGroup{
        fmt::format("Worst of {}. {}", enumerated(names), agreement), {figure}, table};
}

// 0 below 1e-9, which is rounding.
std::string small(double value) { return value < 1e-9 ? "0" : number(value, 2); }

// A dash for what does not move.
std::string share_of(double deviation, double range) {
    return range < 1e-9 ? "–" : percent(deviation / range);
}

// One row per main channel, and per joint for its worst force and moment component.
Table deviations(const JsonCursor& scene, const JsonCursor& branch) {
    Table table{.caption = fmt::format(
                    "Deviation of the published recursion from the full solution, branch {}",
                    branch["name"].text())};
    const Sweep alone = sweep_of(scene, branch);
    table.columns = {
        {"output", true},
        {"range"},
        {"max " + alone.at_equal_parameter()},
        {fmt::format("at [{}]", alone.unit)},
        {"rms"},
        {"share"},
        {"max " + alone.at_equal_abscissa()},
        {alone.abscissa.empty() ? "at" : "at" + alone.abscissa.substr(alone.abscissa.find(" ["))},
        {"rms"},
        {"share"},
        {"difference of the references"}};
    const JsonCursor load = branch["deviation"]["at_equal_parameter"]["channels"];
    const JsonCursor travel = branch["deviation"]["at_equal_abscissa"]["channels"];
    const JsonCursor uncertainty =
        branch["reference_uncertainty"]["at_equal_parameter"]["channels"];
    struct Row {
        ChannelInfo channel;
        double max;
    };
    std::vector<Row> rows;
    for (const auto& channel : channels_of(scene)) {
        const auto d = load.find(channel.name);
        // travel duplicates wheel_centre_z
        if (!d || (channel.kinematic && !channel.main)) continue;
        const double max = (*d)["max"].number();
        const auto joint = channel.name.substr(0, channel.name.find('.'));
        if (!channel.main && !rows.empty() && rows.back().channel.name.starts_with(joint + ".") &&
            rows.back().channel.unit == channel.unit) {
            if (max > rows.back().max) rows.back() = {channel, max};
        } else {
            rows.push_back({channel, max});
        }
    }
    std::erase_if(rows, [](const Row& r) { return !r.channel.main && r.max < 1e-6; });
    for (const auto& [channel, max] : rows) {
        const JsonCursor d = load[channel.name];
        std::vector<std::string> row{channel.heading(),
                                     number(d["range"].number(), 4),
                                     deviation_number(d["signed_max"].number()),
                                     number(d["at"].number(), 4),
                                     small(d["rms"].number()),
                                     share_of(max, d["range"].number())};
        if (const auto t = travel.find(channel.name)) {
            row.insert(row.end(), {deviation_number((*t)["signed_max"].number()),
                                   number((*t)["at"].number(), 4), small((*t)["rms"].number()),
                                   share_of((*t)["max"].number(), (*t)["range"].number())});
        } else {
            row.insert(row.end(), {"–", "–", "–", "–"});
        }
        const auto u = uncertainty.find(channel.name);
        row.push_back(u ? number((*u)["max"].number(), 2) : "–");
        table.rows.push_back(row);
    }
    return table;
}

}  // namespace

std::optional<Section> deviation_section(const JsonCursor& scene) {
    if (!scene.find("branches")) return std::nullopt;
    Section section{
        .id = "deviation", .title = "Deviation over the branch", .part = Part::evidence};
    for (const auto& sweep : sweeps_of(scene))
        for (const char* unit : {"mm", "deg"})
            if (sweep.branches.front().find("profiles"))
                if (auto made = group(scene, sweep, unit))
                    section.figures.push_back(std::move(*made));
    for (const auto& branch : scene["branches"].items()) {
        if (!branch.find("deviation")) continue;
        section.tables.push_back(deviations(scene, branch));
        section.tables.back().folded = true;
        const std::string why = branch["deviation"]["at_equal_abscissa"]["not_compared"].text();
        if (!why.empty())
            section.words["notes"].push_back(
                {{"branch", branch["name"].text()},
                 {"reading", sweep_of(scene, branch).at_equal_abscissa()},
                 {"why", why}});
    }
    if (section.figures.empty() && section.tables.empty()) return std::nullopt;
    return section;
}

}  // namespace elastocheck::reports
