#include "reports/page/sections/inputs/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

// The points of an output, or of the travel that places them; null if it was not measured.
const std::vector<double>* column(const SceneAnalyses& scene, const std::string& output) {
    const compare::Points& points = scene.measured->measurement.table.points;
    const auto& channels = scene.comparison.channels;
    for (const auto& column : scene.measured->found.columns)
        if (channels[column.channel].name == output) return &column.values;
    return points.abscissa && channels[*points.abscissa].name == output ? &points.at : nullptr;
}

// Whether the k-th point was measured on one of these branches.
bool is_on(const SceneAnalyses& scene, const Sweep& sweep, std::size_t k) {
    const int branch = scene.measured->found.places[k].branch;
    return branch >= 0 &&
           sweep.has(scene.comparison.branches[static_cast<std::size_t>(branch)].branch);
}

std::string named(const compare::Channel& channel) {
    return fmt::format("{} [{}]", channel.name, symbol(channel.unit));
}

Table deviations(const SceneAnalyses& scene, const compare::MeasuredReading& reading) {
    Table table{.caption = "Deviation from the measurement, " +
                           word_of(*scene.measured, reading, scene.comparison),
                .columns = {{"test", true},
                            {"output", true},
                            {"points"},
                            {"gradient measured"},
                            {"of the model"},
                            {"unit", true},
                            {"full solution, max"},
                            {"rms"},
                            {"published recursion, max"},
                            {"rms"}}};
    for (const auto& row : reading.rows) {
        const auto [unit, factor] = gradient_unit(*scene.measured, reading, row, scene.comparison);
        std::vector<std::string> cells{row.branch,
                                       named(scene.comparison.channels[row.channel]),
                                       whole_number(row.compared()),
                                       signed_number(factor * row.measured_gradient),
                                       signed_number(factor * row.gradient),
                                       unit};
        for (const auto leg : {compare::Leg::equilibrium, compare::Leg::recursive}) {
            const auto& off = row.off[static_cast<std::size_t>(leg)];
            cells.push_back(signed_number(off.signed_max));
            cells.push_back(number(off.rms, 2));
        }
        table.rows.push_back(std::move(cells));
    }
    return table;
}

Table hysteresis(const SceneAnalyses& scene) {
    Table table{
        .caption = "Hysteresis of the measurement: its two ways, whose mean is compared",
        .columns = {
            {"branch", true}, {"output", true}, {"largest width"}, {"at", true}, {"points"}}};
    for (const auto& loop : scene.measured->found.loops)
        table.rows.push_back({loop.branch, named(scene.comparison.channels[loop.channel]),
                              number(loop.width, 2),
                              fmt::format("{:.4g} {}", loop.at,
                                          symbol(unit_of_place(*scene.measured, loop.by_parameter,
                                                               loop.branch, scene.comparison))),
                              whole_number(loop.points)});
    return table;
}

}  // namespace

bool measured_over_parameter(const SceneAnalyses& scene, const Sweep& sweep) {
    if (!scene.measured) return false;
    const compare::Points& measured = scene.measured->measurement.table.points;
    if (!measured.abscissa) return true;
    bool points = false, travel = false;
    for (std::size_t k = 0; k < measured.at.size(); ++k)
        if (is_on(scene, sweep, k)) points = true, travel = travel || std::isfinite(measured.at[k]);
    return points && !travel;
}

std::optional<Series> measured_series(const SceneAnalyses& scene, const Sweep& sweep,
                                      const std::string& by, const std::string& channel) {
    if (!scene.measured) return std::nullopt;
    const auto& a = scene.measured->measurement.table.points.a;
    const auto* x = !by.empty() ? column(scene, by) : a.empty() ? nullptr : &a;
    const auto* y = column(scene, channel);
    if (x == nullptr || y == nullptr) return std::nullopt;
    Series series{.title = "measured", .style = Series::Style::rings, .colour = purple, .mark = 5};
    bool any = false;
    for (std::size_t k = 0; k < x->size(); ++k)
        if (is_on(scene, sweep, k) && std::isfinite((*x)[k]))
            series.rows.push_back({(*x)[k], (*y)[k]}), any = any || std::isfinite((*y)[k]);
    if (!any) return std::nullopt;
    return series;
}

std::optional<Section> measured_section(const SceneAnalyses& scene) {
    if (!scene.measured) return std::nullopt;
    const auto& [measurement, found, left_out] = *scene.measured;
    Section section{
        .id = "measured", .title = "Comparison with the measurement", .part = Part::behaviour};
    bool over_load = false;
    for (const auto& sweep : sweeps_of(scene))
        over_load = over_load || (measured_over_parameter(scene, sweep) && !sweep.abscissa.empty());
    section.words = {{"over_load", over_load},
                     {"file", measurement.file},
                     {"hash", measurement.hash},
                     {"points", measurement.table.lines.size()}};
    if (!left_out.empty()) section.words["left_out"] = enumerated(left_out);
    if (!found.explanations.empty()) section.words["findings"] = enumerated(found.explanations);
    for (const auto& reading : found.readings)
        if (!reading.rows.empty()) section.tables.push_back(deviations(scene, reading));
    if (!found.loops.empty()) section.tables.push_back(hysteresis(scene));
    return section;
}

}  // namespace elastocheck::reports
