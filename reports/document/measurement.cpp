#include "reports/document/measurement.hpp"

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

// "deg/kN": large numbers of newtons stand for one.
std::pair<std::string, double> gradient_unit(compare::Unit of, compare::Unit per) {
    const bool force = per == compare::Unit::newton || per == compare::Unit::newton_metre;
    return {fmt::format("{}/{}{}", symbol(of), force ? "k" : "", symbol(per)), force ? 1e3 : 1};
}

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

json rows_json(const compare::MeasuredReading& reading, const compare::Comparison& all,
               const compare::Points& measured) {
    json rows = json::array();
    for (const auto& of : reading.rows) {
        const auto& channel = all.channels[of.channel];
        const auto [unit, factor] = gradient_unit(
            channel.unit, reading.by_parameter ? all.branch(of.branch).unit
                                               : all.channels[*measured.abscissa].unit);
        json row = {{"branch", of.branch},
                    {"channel", channel.name},
                    {"unit", symbol(channel.unit)},
                    {"compared", of.compared},
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

std::string word_of(const std::vector<std::string>& parameters) {
    const auto is_load = [](const std::string& name) { return name.starts_with("load"); };
    return std::ranges::all_of(parameters, is_load)    ? "load"
           : std::ranges::none_of(parameters, is_load) ? "parameter"
                                                       : "load or parameter";
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
    compare::Comparison all = compare::outline(model);
    std::vector<std::string> branches;
    for (const auto& branch : all.branches) branches.push_back(branch.branch);
    for (const auto& [theirs, ours] : map.branches)
        if (std::ranges::find(branches, ours) == branches.end())
            fail_at(file, 0,
                    fmt::format("'{}={}': the scene has no branch '{}'{}", theirs, ours, ours,
                                reader::did_you_mean(ours, branches, "allowed")));
    Measurement measurement{.file = file,
                            .hash = input_hash(csv),
                            .table = read_points(csv, file, model, all, map, nullptr),
                            .channels = std::move(all.channels)};
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

void add_measurement(json& scene_document, const Model& model, const compare::Comparison& all,
                     const compare::DefinedCurves& defined, Measurement measurement) {
    renumber(measurement, all.channels);
    PointTable& table = measurement.table;
    const compare::Points& measured = table.points;
    compare::MeasuredComparison found;
    try {
        found = compare::compare_measured(model, all, measured, defined);
    } catch (const std::invalid_argument& error) {
        fail_at(measurement.file, 1, error.what());
    }
    json columns = json::object(), branches = json::array(), readings = json::array(),
         loops = json::array();
    if (measured.abscissa) columns[all.channels[*measured.abscissa].name] = measured.at;
    for (const auto& column : found.columns)
        columns[all.channels[column.channel].name] = column.values;
    for (const auto& place : found.places)
        branches.push_back(
            place.branch < 0 ? "" : all.branches[static_cast<std::size_t>(place.branch)].branch);
    for (const auto& reading : found.readings)
        readings.push_back(
            {{"reading",
              "at equal " + (reading.by_parameter ? word_of(table.parameters)
                                                  : all.channels[*measured.abscissa].name)},
             {"channels", rows_json(reading, all, measured)}});
    for (const auto& loop : found.loops) {
        const auto& channel = all.channels[loop.channel];
        loops.push_back(
            {{"branch", loop.branch},
             {"channel", channel.name},
             {"unit", symbol(channel.unit)},
             {"width", loop.width},
             {"at", loop.at},
             {"at_unit", symbol(loop.by_parameter ? all.branch(loop.branch).unit
                                                  : all.channels[*measured.abscissa].unit)},
             {"points", loop.points}});
    }
    json document = {{"file", measurement.file},
                     {"hash", measurement.hash},
                     {"points", table.lines.size()},
                     {"left_out", json::array()},
                     {"columns", columns},
                     {"branch", branches},
                     {"branch_given", !measured.branch.empty()},
                     {"readings", readings},
                     {"loops", loops},
                     {"findings", found.explanations}};
    if (!measured.a.empty()) document["parameter"] = measured.a;
    if (measured.abscissa) document["abscissa"] = all.channels[*measured.abscissa].name;
    keep_rows(table, [&](std::size_t k) {
        return found.used[k] ? "" : why_not(found.places[k], measured, k, all);
    });
    document["left_out"] = table.left_out;
    scene_document["measured"] = std::move(document);
}

int compared_with_measurement(const json& scene_document) {
    int compared = 0;
    for (const auto& reading : scene_document.at("measured").at("readings"))
        for (const auto& channel : reading.at("channels"))
            compared += channel.at("compared").get<int>();
    return compared;
}

}  // namespace elastocheck::reports
