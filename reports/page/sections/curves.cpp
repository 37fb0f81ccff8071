// Section: outputs over the parameter, by all legs, and load or force over the travel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/candidate.hpp"
#include "reports/page/sections/inputs/measured.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

// A drawn output, absolute or as its change since the design position.
struct Output {
    std::string id, title, axis, channel;
    bool change = false;
    bool load = false;  // the load, over the abscissa
};

std::vector<Output> outputs_of(const JsonCursor& scene, const Sweep& sweep) {
    std::vector<Output> outputs;
    const auto channels = main_channels_of(scene);
    const bool wheel =
        std::ranges::any_of(channels, [](const ChannelInfo& c) { return c.angle(); });
    for (const auto& c : channels) {
        const auto names = [&](std::string_view what) {
            return c.name == what || c.name.ends_with("." + std::string(what));
        };
        const std::string whose =
            c.name.find('.') == std::string::npos ? "" : ", " + c.name.substr(0, c.name.find('.'));
        if (names("toe")) {
            outputs.push_back({slug(c.name), "Toe angle" + whose, "toe angle [deg]", c.name});
        } else if (names("camber")) {
            outputs.push_back({slug(c.name), "Camber angle" + whose, "camber angle [deg]", c.name});
        } else if (names("wheel_centre_y")) {
            outputs.push_back({whose.empty() ? "lateral" : slug(c.name), "Lateral movement" + whose,
                               "wheel centre, change of y [mm]", c.name, true});
        }
    }
    for (const auto& c : channels) {
        if (wheel && (c.name.find("wheel_centre") != std::string::npos || c.angle())) continue;
        outputs.push_back({slug(c.name), c.label(),
                           fmt::format("{}, change [{}]", c.label(), c.unit), c.name, true});
    }
    if (!sweep.abscissa.empty() && !measured_over_parameter(scene, sweep)) {
        if (compare::parameter_word(sweep.unit) == "load") {
            outputs.push_back({"load", "Load", sweep.parameter(), "", false, true});
        } else {  // the driving force instead of the load
            for (const auto& c : channels_of(scene))
                for (const auto& moved : sweep.branches.front()["drivers"]["moved"].texts())
                    if (c.name.starts_with(moved + ".drive_"))
                        outputs.push_back({slug(c.name), c.label(), c.heading(), c.name});
        }
    }
    return outputs;
}

// 0 below 1e-9 of a mm, deg or N, which is rounding and would scale an axis.
double at_rest(double x) { return std::abs(x) < 1e-9 ? 0 : x; }
std::string value(double x, int digits = 5) { return std::abs(x) < 1e-9 ? "0" : number(x, digits); }

std::vector<double> values_of(const LegCurve& curve, const Output& output) {
    if (output.load) return curve.a;
    auto values = curve.channel(output.channel);
    if (output.change && !values.empty())
        for (const double first = values[curve.start()]; double& v : values) v -= first;
    return values;
}

std::optional<FigureGroup> group(const JsonCursor& scene, const Sweep& sweep,
                                 const Output& output) {
    Series reference{"full solution (equilibrium)", Series::Style::wide, sky},
        energy{"its check (energy)", Series::Style::points, ink, 6},
        published{"published recursion", Series::Style::line, vermilion};
    Table table;
    table.folded = true;
    std::vector<std::pair<double, std::vector<std::string>>> rows;
    const auto measured =
        measured_series(scene, sweep, output.load ? "" : output.channel, output.change);
    const bool fourth = measured && !output.load;  // has its own column
    const bool travel = !sweep.abscissa.empty() && !measured_over_parameter(scene, sweep);
    double most = 0;
    for (const auto& branch : sweep.branches) {
        for (auto* series : {&reference, &energy, &published}) {
            const char* leg = series == &reference ? "equilibrium"
                              : series == &energy  ? "energy"
                                                   : "recursive";
            const LegCurve curve = curve_of(branch, leg);
            const auto values = values_of(curve, output);
            const auto& x = travel && !curve.x.empty() ? curve.x : curve.a;
            if (!series->rows.empty() && series != &energy) series->rows.emplace_back();
            for (const auto k : thinned(values.size(), series == &energy ? 6 : 41))
                series->rows.push_back({at_rest(x[k]), at_rest(values[k])});
            if (series == &reference && !values.empty()) most = std::max(most, largest(values));
        }
        const LegCurve a = curve_of(branch, "equilibrium"), b = curve_of(branch, "recursive"),
                       e = curve_of(branch, "energy");
        const auto points = fourth
                                ? measured_for(scene, sweep, branch, output.channel, output.change)
                                : std::nullopt;
        const auto va = values_of(a, output), vb = values_of(b, output), ve = values_of(e, output);
        for (const auto k : thinned(a.a.size(), 6)) {
            if (k == 0 && !rows.empty()) continue;
            std::vector<std::string> row{number(a.a[k], 4)};
            if (output.load) {
                for (const auto* c : {&a, &e, &b})
                    row.push_back(k < c->x.size() ? number(c->x[k], 5) : "–");
            } else {
                if (travel) row.push_back(k < a.x.size() ? number(a.x[k], 4) : "–");
                for (const auto* v : {&va, &ve, &vb})
                    row.push_back(k < v->size() ? value((*v)[k]) : "–");
                if (fourth)
                    row.push_back(points ? value(value_between(
                                               *points, travel && k < a.x.size() ? a.x[k] : a.a[k]))
                                         : "–");
            }
            rows.emplace_back(a.a[k], row);
        }
    }
    if (rows.empty() || most < 1e-9) return std::nullopt;  // constant
    std::ranges::sort(rows, {}, [](const auto& row) { return row.first; });
    for (auto& [load, row] : rows) table.rows.push_back(std::move(row));
    table.columns = {{sweep.parameter()}};
    if (travel && !output.load) table.columns.push_back({sweep.abscissa});
    const std::string unit = output.load ? ", " + sweep.abscissa : "";
    for (const char* leg : {"equilibrium", "energy", "published recursion"})
        table.columns.push_back({leg + unit});
    if (fourth) table.columns.push_back({"measured"});
    table.caption = output.load ? fmt::format("{} at equal {}, {}", sweep.abscissa,
                                              compare::parameter_word(sweep.unit), sweep.name)
                                : fmt::format("{}, at equal {}, {}", output.axis,
                                              compare::parameter_word(sweep.unit), sweep.name);

    Figure figure{.id = fmt::format("{}-{}", output.id, slug(sweep.name)),
                  .title = fmt::format("{}, {}", output.title, sweep.name),
                  .description = {},
                  .x = travel ? sweep.abscissa : sweep.parameter(),
                  .y = output.axis};
    figure.series = {reference, energy, published};
    if (measured) figure.series.push_back(*measured);
    if (!output.load)
        for (auto& series : candidate_series(scene, sweep, output.channel, output.change, travel))
            figure.series.push_back(std::move(series));
    double low = INFINITY, high = -INFINITY;
    for (const auto& row : reference.rows)
        if (row.size() == 2) low = std::min(low, row[1]), high = std::max(high, row[1]);
    const std::string from = number(low), to = number(high);
    figure.description = fmt::format(
        "{} over {}: by the full solution {}. The points of its check by energy lie on its line; "
        "the "
        "published "
        "recursion's line is drawn over it.",
        output.axis, figure.x,
        from == to ? from + " throughout" : fmt::format("from {} to {}", from, to));
    return FigureGroup{
        fmt::format("{} over {}, {}.", output.title, figure.x, sweep.name), {figure}, table};
}

// Every main output at the end of a branch, by leg.
Table outputs(const JsonCursor& scene, const JsonCursor& branch) {
    Table table{
        .caption =
            fmt::format("Outputs at the end ({} {}) of branch {}", number(branch["to"].number(), 4),
                        branch["unit"].text(), branch["name"].text()),
        .columns = {{"output", true}, {"published recursion"}, {"equilibrium"}, {"energy"}}};
    for (const auto& channel : channels_of(scene)) {
        if (!channel.main) continue;
        std::vector<std::string> row{channel.heading()};
        for (const char* leg : {"recursive", "equilibrium", "energy"}) {
            const auto values = curve_of(branch, leg).channel(channel.name);
            row.push_back(values.empty() ? "–" : value(values.back(), 7));
        }
        table.rows.push_back(row);
    }
    return table;
}

}  // namespace

std::optional<Section> curves_section(const JsonCursor& scene) {
    if (!scene.find("branches")) return std::nullopt;
    Section section{.id = "curves", .title = "Outputs over travel, load or drive"};
    for (const auto& sweep : sweeps_of(scene))
        for (const auto& output : outputs_of(scene, sweep))
            if (auto made = group(scene, sweep, output))
                section.figures.push_back(std::move(*made));
    for (const auto& branch : scene["branches"].items())
        section.tables.push_back(outputs(scene, branch));
    section.words["wheel"] =
        std::ranges::any_of(main_channels_of(scene), [](const auto& c) { return c.angle(); });
    return section;
}

}  // namespace elastocheck::reports
