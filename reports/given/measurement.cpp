#include "reports/given/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compare/candidate/candidate.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Leg;

// Whether a point has a value of an output; a travel that places it is none.
void drop_travel(PointTable& table, const std::vector<compare::Channel>& channels) {
    std::erase_if(table.points.columns, [&](const compare::PointColumn& column) {
        return is_travel(channels[column.channel]) &&
               (column.change || column.channel == table.points.abscissa);
    });
}

// Changes of outputs that are no function of the position alone have no start.
void drop_changes(PointTable& table, const std::vector<compare::Channel>& channels) {
    std::erase_if(table.points.columns, [&](const compare::PointColumn& column) {
        if (!column.change || channels[column.channel].kinematic()) return false;
        table.left_out.push_back(channels[column.channel].name +
                                 ": a change of an output that is no position or angle");
        return true;
    });
}

// The points with the channels of another list; columns that it lacks are left out.
void renumber(Measurement& measurement, const std::vector<compare::Channel>& channels) {
    auto& [points, parameters, left_out, lines] = measurement.table;
    const auto& own = measurement.channels;
    std::erase_if(points.columns, [&](compare::PointColumn& column) {
        const int c = compare::find_channel(channels, own[column.channel].name);
        if (c < 0) left_out.push_back(own[column.channel].name + ": no output of these branches");
        column.channel = static_cast<std::size_t>(c);
        return c < 0;
    });
    if (points.abscissa)
        points.abscissa =
            static_cast<std::size_t>(compare::find_channel(channels, own[*points.abscissa].name));
    measurement.channels = channels;
}

json rows_json(const Measured& measured, const compare::MeasuredReading& reading,
               const compare::Comparison& all) {
    json rows = json::array();
    for (const auto& of : reading.rows) {
        const auto& channel = all.channels[of.channel];
        const auto [unit, factor] = gradient_unit(measured, reading, of, all);
        json row = {{"branch", of.branch},
                    {"channel", channel.name},
                    {"unit", symbol(channel.unit)},
                    {"compared", of.compared()},
                    {"gradient",
                     {{"unit", unit},
                      {"measured", factor * of.measured_gradient},
                      {"model", factor * of.gradient}}}};
        for (const Leg leg : compare::legs) {
            const auto& off = of.off[static_cast<std::size_t>(leg)];
            row[name(leg)] = {{"signed_max", off.signed_max}, {"rms", off.rms}};
        }
        rows.push_back(row);
    }
    return rows;
}

// Reason why a point is not compared; empty if it is.
std::string why_not(const compare::Place& place, const compare::Points& measured, std::size_t k,
                    const compare::Comparison& all) {
    if (!std::isfinite(place.x)) return "without a parameter or travel";
    if (std::ranges::none_of(measured.columns,
                             [&](const auto& column) { return std::isfinite(column.values[k]); }))
        return "without a measured value";
    if (place.branch < 0) return "that no branch reaches";
    return fmt::format("beyond the range of branch '{}'",
                       all.branches[static_cast<std::size_t>(place.branch)].branch);
}

}  // namespace

Measurement read_measurement(std::string_view csv, const std::string& file, const Model& model,
                             const ColumnMap& map, const std::vector<std::string>& only) {
    std::vector<compare::Channel> channels = compare::outline(model).channels;
    const Names names = names_of(model, channels, map);
    const auto branches = names.branches();
    for (const auto& [theirs, ours] : map.branches)
        if (std::ranges::find(branches, ours) == branches.end())
            fail_at(file, 0, fmt::format("'{}={}': {}", theirs, ours, no_branch(ours, branches)));
    Measurement measurement{.file = file,
                            .hash = input_hash(csv),
                            .table = read_points(csv, file, names, nullptr),
                            .channels = channels};
    PointTable& table = measurement.table;
    if (!only.empty() && !table.points.branch.empty())
        keep_rows(table, [&](std::size_t k) {
            const std::string& branch = table.points.branch[k];
            return std::ranges::find(only, branch) != only.end()
                       ? ""
                       : fmt::format("of branch '{}', which was not requested", branch);
        });
    if (table.lines.empty())
        fail_at(file, 0, "no point of the requested branches: " + reader::listed(table.left_out));
    drop_travel(table, measurement.channels);
    drop_changes(table, measurement.channels);
    if (table.points.columns.empty())
        fail_at(
            file, 1,
            "no output among the columns" +
                (table.left_out.empty() ? "" : "; left out: " + reader::listed(table.left_out)));
    return measurement;
}

Measured compare_measurement(const Model& model, const compare::Comparison& all,
                             const compare::DefinedCurves& defined, Measurement measurement) {
    renumber(measurement, all.channels);
    Measured made{std::move(measurement), {}, {}};
    PointTable points = made.measurement.table;
    try {
        made.found = compare::compare_measured(model, all, points.points, defined);
    } catch (const std::invalid_argument& error) {
        fail_at(made.measurement.file, 1, error.what());
    }
    const compare::Points measured = points.points;
    keep_rows(points, [&](std::size_t k) {
        return made.found.used[k] ? "" : why_not(made.found.places[k], measured, k, all);
    });
    made.left_out = std::move(points.left_out);
    return made;
}

std::string word_of(const Measured& measured, const compare::MeasuredReading& reading,
                    const compare::Comparison& all) {
    const PointTable& table = measured.measurement.table;
    if (!reading.by_parameter) return "at equal " + all.channels[*table.points.abscissa].name;
    const auto is_load = [](const std::string& name) { return name.starts_with("load"); };
    return std::ranges::all_of(table.parameters, is_load)    ? "at equal load"
           : std::ranges::none_of(table.parameters, is_load) ? "at equal parameter"
                                                             : "at equal load or parameter";
}

compare::Unit unit_of_place(const Measured& measured, bool by_parameter, const std::string& branch,
                            const compare::Comparison& all) {
    return by_parameter ? all.branch(branch).unit
                        : all.channels[*measured.measurement.table.points.abscissa].unit;
}

std::pair<std::string, double> gradient_unit(const Measured& measured,
                                             const compare::MeasuredReading& reading,
                                             const compare::MeasuredRow& row,
                                             const compare::Comparison& all) {
    const auto per = unit_of_place(measured, reading.by_parameter, row.branch, all);
    const bool force = per == compare::Unit::newton || per == compare::Unit::newton_metre;
    return {fmt::format("{}/{}{}", symbol(all.channels[row.channel].unit), force ? "k" : "",
                        symbol(per)),
            force ? 1e3 : 1};
}

json measured_json(const Measured& measured, const compare::Comparison& all) {
    const auto& [measurement, found, left_out] = measured;
    const compare::Points& points = measurement.table.points;
    json columns = json::object(), branches = json::array(), readings = json::array(),
         loops = json::array();
    if (points.abscissa) columns[all.channels[*points.abscissa].name] = points.at;
    for (const auto& column : found.columns)
        columns[all.channels[column.channel].name] = column.values;
    for (const auto& place : found.places)
        branches.push_back(
            place.branch < 0 ? "" : all.branches[static_cast<std::size_t>(place.branch)].branch);
    for (const auto& reading : found.readings)
        readings.push_back({{"reading", word_of(measured, reading, all)},
                            {"channels", rows_json(measured, reading, all)}});
    for (const auto& loop : found.loops) {
        const auto& channel = all.channels[loop.channel];
        loops.push_back(
            {{"branch", loop.branch},
             {"channel", channel.name},
             {"unit", symbol(channel.unit)},
             {"width", loop.width},
             {"at", loop.at},
             {"at_unit", symbol(unit_of_place(measured, loop.by_parameter, loop.branch, all))},
             {"points", loop.points}});
    }
    json document = {{"file", measurement.file},
                     {"hash", measurement.hash},
                     {"points", measurement.table.lines.size()},
                     {"left_out", left_out},
                     {"columns", columns},
                     {"branch", branches},
                     {"branch_given", !points.branch.empty()},
                     {"readings", readings},
                     {"loops", loops},
                     {"findings", found.explanations}};
    if (!points.a.empty()) document["parameter"] = points.a;
    if (points.abscissa) document["abscissa"] = all.channels[*points.abscissa].name;
    return document;
}

}  // namespace elastocheck::reports
