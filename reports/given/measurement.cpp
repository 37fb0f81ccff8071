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

using compare::Leg;

// Removes the travel that gives the places of the points, and changes of travel: nothing to compare.
void drop_travel(PointTable& table, const std::vector<compare::Channel>& channels) {
    std::erase_if(table.points.columns, [&](const compare::PointColumn& column) {
        return is_travel(channels[column.channel]) &&
               (column.change || column.channel == table.points.abscissa);
    });
}

// Leaves out changes of outputs other than positions and angles, whose value at the design position
// is not defined.
void drop_changes(PointTable& table, const std::vector<compare::Channel>& channels) {
    std::erase_if(table.points.columns, [&](const compare::PointColumn& column) {
        if (!column.change || channels[column.channel].kinematic()) return false;
        table.left_out.push_back(channels[column.channel].name +
                                 ": a change of an output that is neither a position nor an angle");
        return true;
    });
}

// Refers the columns to another list of channels; columns without a channel there are left out.
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

std::string reading_name(const Measured& measured, const compare::MeasuredReading& reading,
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

// Reason why a point is not compared; empty if it is.
std::string reason_left_out(const compare::Place& place, const compare::Points& measured,
                            std::size_t k, const compare::Comparison& all) {
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
        drop_points(table, [&](std::size_t k) {
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

Measured compare_measurement(const Model& model, const compare::Comparison& comparison,
                             const compare::DefinedCurves& defined, Measurement measurement) {
    renumber(measurement, comparison.channels);
    Measured result{std::move(measurement), {}, {}};
    PointTable points = result.measurement.table;
    try {
        result.found = compare::compare_measured(model, comparison, points.points, defined);
    } catch (const std::invalid_argument& error) {
        fail_at(result.measurement.file, 1, error.what());
    }
    const compare::Points measured = points.points;  // drop_points changes them
    drop_points(points, [&](std::size_t k) {
        return result.found.used[k]
                   ? ""
                   : reason_left_out(result.found.places[k], measured, k, comparison);
    });
    result.left_out = std::move(points.left_out);
    return result;
}

compare::Table deviation_table(const Measured& measured, const compare::MeasuredReading& reading,
                               const compare::Comparison& comparison) {
    using enum compare::Digits;
    using Row = compare::MeasuredRow;
    const auto per = [&](const Row& r) { return gradient_unit(measured, reading, r, comparison); };
    std::vector<compare::ColumnOf<Row>> columns{
        {"reading", hidden,
         [&](const Row&) { return reading_name(measured, reading, comparison); }},
        {"test", words, &Row::branch},
        {"output", words, [&](const Row& r) { return comparison.channels[r.channel].name; }},
        {"unit", words, [&](const Row& r) { return symbol(comparison.channels[r.channel].unit); }},
        {"points", whole, [](const Row& r) { return r.compared(); }},
        {"gradient measured", deviation,
         [=](const Row& r) { return per(r).second * r.measured_gradient; },
         "slope of the straight line through the points"},
        {"gradient", deviation, [=](const Row& r) { return per(r).second * r.gradient; },
         "likewise, of the equilibrium leg", "", "of the model"},
        {"gradient unit", words, [=](const Row& r) { return per(r).first; }, "", "", "its unit"}};
    for (const Leg leg : compare::legs) {
        const auto deviation_of = [=](const Row& r) {
            return r.off[static_cast<std::size_t>(leg)];
        };
        const bool shown = leg != Leg::energy;
        const std::string solution =
            leg == Leg::equilibrium ? "full solution" : "published recursion";
        columns.push_back({fmt::format("{} max", name(leg)), shown ? deviation : hidden,
                           [=](const Row& r) { return deviation_of(r).signed_max; },
                           "deviation where it is largest", "", solution + ", max"});
        columns.push_back({fmt::format("{} rms", name(leg)), shown ? rounded : hidden,
                           [=](const Row& r) { return deviation_of(r).rms; }, "", "", "rms"});
    }
    compare::Table table = compare::table({.id = "measured",
                                           .caption = "Deviation from the measurement, " +
                                                      reading_name(measured, reading, comparison)},
                                          columns, reading.rows);
    return table;
}

compare::Table loop_table(const Measured& measured, const compare::Comparison& comparison) {
    using enum compare::Digits;
    using Loop = compare::Hysteresis;
    compare::Table table = compare::table<Loop>(
        {.id = "loops",
         .caption = "Hysteresis of the measurement: its two ways, whose mean is compared"},
        {{"branch", words, &Loop::branch},
         {"output", words, [&](const Loop& l) { return comparison.channels[l.channel].name; }},
         {"unit", words,
          [&](const Loop& l) { return symbol(comparison.channels[l.channel].unit); }},
         {"width", size, &Loop::width, "largest difference of both ways", "", "largest width"},
         {"at", place, &Loop::at},
         {"place unit", words,
          [&](const Loop& l) {
              return symbol(unit_of_place(measured, l.by_parameter, l.branch, comparison));
          },
          "", "", "its unit"},
         {"points", whole, &Loop::points}},
        measured.found.loops);
    return table;
}

namespace {

// The value of a column at a point.
struct PointValue {
    std::size_t point;
    const compare::PointColumn* column;
};

compare::Table point_table(const Measured& measured, const compare::Comparison& comparison) {
    using enum compare::Digits;
    const compare::Points& points = measured.measurement.table.points;
    std::vector<PointValue> rows;
    for (std::size_t k = 0; k < measured.found.places.size(); ++k)
        for (const auto& column : measured.found.columns)
            if (std::isfinite(column.values[k])) rows.push_back({k, &column});
    const auto value = [](const std::vector<double>& values, std::size_t k) {
        return k < values.size() ? values[k] : compare::nan;
    };
    using V = PointValue;
    compare::Table table = compare::table<V>(
        {.id = "points", .detail = true},
        {{"point", whole, [](const V& v) { return v.point + 1; }},
         {"branch", words,
          [&](const V& v) {
              const int b = measured.found.places[v.point].branch;
              return b < 0 ? "" : comparison.branches[static_cast<std::size_t>(b)].branch;
          }},
         {"parameter", place, [&](const V& v) { return value(points.a, v.point); }},
         {points.abscissa ? comparison.channels[*points.abscissa].name : "abscissa", place,
          [&](const V& v) { return value(points.at, v.point); }, "where the point was measured"},
         {"output", words, [&](const V& v) { return comparison.channels[v.column->channel].name; }},
         {"unit", words,
          [&](const V& v) { return symbol(comparison.channels[v.column->channel].unit); }},
         {"value", four, [](const V& v) { return v.column->values[v.point]; }, "absolute"}},
        rows);
    return table;
}

}  // namespace

compare::Result result_of(const Measured& measured, const compare::Comparison& comparison) {
    const auto& [measurement, found, left_out] = measured;
    compare::Result result{.analysis = "measured"};
    result.about = {fmt::format("{} points of {}, hash {}", measurement.table.lines.size(),
                                measurement.file, measurement.hash)};
    for (const auto& reading : found.readings)
        result.tables.push_back(deviation_table(measured, reading, comparison));
    result.tables.push_back(loop_table(measured, comparison));
    result.tables.push_back(point_table(measured, comparison));
    result.notes = found.explanations;
    for (const auto& what : left_out) result.notes.push_back("left out: " + what);
    result.verdict = {
        .grade = compare::Grade::pass, .compared = found.compared, .requested = false};
    return result;
}

}  // namespace elastocheck::reports
