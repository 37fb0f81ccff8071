#include "reports/document/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/candidate/measured.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/files/limits.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Leg;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Column {
    std::string name;
    int channel = -1;     // position in Comparison::channels; -1: parameter or branch
    bool change = false;  // relative to the design position
    bool travel = false;  // places the point
    std::vector<double> values;
};

struct Points {
    std::vector<Column> columns;
    std::vector<std::string> branch;      // per point, empty without such a column
    std::vector<int> lines;               // of the file, per point
    std::vector<std::string> parameters;  // the columns that give a branch's parameter

    const std::vector<double>* find(std::string_view name) const {
        for (const auto& column : columns)
            if (column.name == name) return &column.values;
        return nullptr;
    }
};

std::string unit_suffix(compare::Unit unit) {
    return unit == compare::Unit::mm ? "mm" : unit == compare::Unit::percent ? "percent" : "deg";
}

// The column that gives a branch's parameter.
std::string parameter_column(compare::Unit unit) {
    switch (unit) {
        case compare::Unit::newton: return "load_N";
        case compare::Unit::newton_metre: return "load_Nm";
        case compare::Unit::mm: return "parameter_mm";
        case compare::Unit::deg: return "parameter_deg";
        default: return "parameter";
    }
}

// Of all branches, without duplicates.
std::vector<std::string> parameter_columns(const compare::Comparison& all) {
    std::vector<std::string> names;
    for (const auto& branch : all.branches)
        if (const auto name = parameter_column(branch.unit);
            std::ranges::find(names, name) == names.end())
            names.push_back(name);
    return names;
}

std::string column_of(const std::string& branch, const compare::Comparison& all) {
    return parameter_column(
        std::ranges::find(all.branches, branch, &compare::BranchComparison::branch)->unit);
}

// Rejects points with a parameter in another unit than their branch.
void check_parameters(const Points& points, const std::string& file,
                      const compare::Comparison& all) {
    if (points.branch.empty()) {
        if (points.parameters.size() > 1)
            fail_at(file, 1,
                    fmt::format("{} and {}: a column 'branch' is needed to choose between them",
                                points.parameters[0], points.parameters[1]));
        if (points.parameters.size() == 1 && parameter_columns(all).size() > 1)
            fail_at(
                file, 1,
                fmt::format("{}: not the parameter of every branch; a column 'branch' is needed",
                            points.parameters[0]));
        return;
    }
    for (std::size_t k = 0; k < points.branch.size(); ++k)
        for (const auto& parameter : points.parameters) {
            const std::string own = column_of(points.branch[k], all);
            if (own != parameter && std::isfinite((*points.find(parameter))[k]))
                fail_at(file, points.lines[k],
                        fmt::format("{}: the parameter of branch '{}' is {}", parameter,
                                    points.branch[k], own));
        }
}

// The channels that may place a point: the travel of each wheel.
bool is_travel(const compare::Channel& channel) {
    return channel.name == "travel" || channel.name.ends_with(".travel");
}

// Branch of a cell: a name from the file's mapping, or a name of the scene.
std::string branch_named(std::string_view cell, const compare::Comparison& all,
                         const LoadCases& cases, const std::string& file, int line) {
    const auto own =
        std::ranges::find(cases.names, cell, &std::pair<std::string, std::string>::first);
    const std::string name = own == cases.names.end() ? std::string(cell) : own->second;
    std::vector<std::string> branches;
    for (const auto& branch : all.branches) branches.push_back(branch.branch);
    if (std::ranges::find(branches, name) == branches.end())
        fail_at(file, line,
                fmt::format("{}: the scene has no {}{}", cases.column, reader::quote(name),
                            reader::did_you_mean(name, branches, "allowed")));
    return name;
}

Points read(std::string_view csv, const std::string& file, const compare::Comparison& all,
            const LoadCases& cases) {
    Points points;
    std::vector<std::string> known{cases.column};
    std::ranges::copy(parameter_columns(all), std::back_inserter(known));
    std::vector<Column> outputs;
    for (std::size_t c = 0; c < all.channels.size(); ++c) {
        const std::string unit = unit_suffix(all.channels[c].unit);
        if (is_travel(all.channels[c]))
            outputs.push_back({fmt::format("{}_{}", all.channels[c].name, unit),
                               static_cast<int>(c),
                               false,
                               true,
                               {}});
        if (is_travel(all.channels[c]) || !all.channels[c].kinematic()) continue;
        for (const bool change : {false, true})
            outputs.push_back(
                {fmt::format("{}{}_{}", all.channels[c].name, change ? "_change" : "", unit),
                 static_cast<int>(c),
                 change,
                 false,
                 {}});
    }
    for (const auto& output : outputs) known.push_back(output.name);

    int branch_column = -1;
    const auto head = [&](const Cells& cells, int line) {
        for (const auto cell : cells) {
            const std::string name(cell);
            if (points.find(name) != nullptr)
                fail_at(file, line,
                        fmt::format("column {} stands there twice", reader::quote(name)));
            if (std::ranges::find(known, name) == known.end())
                fail_at(file, line,
                        fmt::format("unknown column {}{}", reader::quote(name),
                                    reader::did_you_mean(name, known, "allowed")));
            Column column{name, -1, false, false, {}};
            for (const auto& output : outputs)
                if (output.name == name) column = output;
            if (name == cases.column) branch_column = static_cast<int>(points.columns.size());
            points.columns.push_back(column);
        }
    };
    read_sheet(csv, file, most_measured, head, [&](const Cells& cells, int line) {
        points.lines.push_back(line);
        for (std::size_t k = 0; k < cells.size(); ++k) {
            if (static_cast<int>(k) == branch_column) {
                points.branch.push_back(branch_named(cells[k], all, cases, file, line));
                points.columns[k].values.push_back(0);
            } else {
                points.columns[k].values.push_back(
                    number_in(cells[k], file, line, points.columns[k].name));
            }
        }
    });
    const auto is_parameter = [&](const Column& c) {
        return c.channel < 0 && c.name != cases.column;
    };
    const auto is_place = [&](const Column& c) { return c.travel || is_parameter(c); };
    if (branch_column < 0 && cases.column != LoadCases{}.column)
        fail_at(
            file, 1,
            fmt::format("there is no column {} (--branch-column)", reader::quote(cases.column)));
    if (std::ranges::none_of(points.columns, is_place)) {
        std::vector<std::string> allowed = parameter_columns(all);
        for (const auto& output : outputs)
            if (output.travel) allowed.push_back(output.name);
        fail_at(file, 1,
                "no column gives the parameter or travel of a point" +
                    reader::did_you_mean("", allowed, "allowed"));
    }
    if (std::ranges::count_if(points.columns, [](const Column& c) { return c.travel; }) > 1)
        fail_at(file, 1, "two columns of travel; allowed: one");
    for (const auto& column : points.columns)
        if (is_parameter(column)) points.parameters.push_back(column.name);
    check_parameters(points, file, all);
    if (std::ranges::none_of(points.columns,
                             [](const Column& c) { return c.channel >= 0 && !c.travel; }))
        fail_at(
            file, 1,
            "no output among the columns; " + reader::did_you_mean("", known, "allowed").substr(2));
    return points;
}

}  // namespace

void add_measurement(json& scene_document, std::string_view csv, const std::string& file,
                     const Model& model, const compare::Comparison& all, const LoadCases& cases) {
    for (const auto& [theirs, ours] : cases.names)
        if (std::ranges::find(all.branches, ours, &compare::BranchComparison::branch) ==
            all.branches.end())
            fail_at(file, 0,
                    fmt::format("--case {}={}: the scene has no branch '{}'", theirs, ours, ours));
    const Points points = read(csv, file, all, cases);
    compare::Points measured;
    measured.branch = points.branch;
    for (const auto& column : points.columns) {
        if (column.name == cases.column) continue;
        if (column.channel < 0) {
            // each point from the column of its branch's unit
            if (measured.a.empty()) measured.a.assign(column.values.size(), nan);
            for (std::size_t k = 0; k < column.values.size(); ++k)
                if (points.branch.empty() || column_of(points.branch[k], all) == column.name)
                    measured.a[k] = column.values[k];
        } else if (column.travel) {
            measured.abscissa = static_cast<std::size_t>(column.channel);
            measured.at = column.values;
        } else {
            measured.columns.push_back(
                {static_cast<std::size_t>(column.channel), column.change, column.values});
        }
    }
    compare::MeasuredComparison found;
    try {
        found = compare::compare_measured(model, all, measured);
    } catch (const std::invalid_argument& error) {
        fail_at(file, 1, error.what());
    }
    json columns = json::object();
    if (measured.abscissa) columns[all.channels[*measured.abscissa].name] = measured.at;
    for (const auto& column : found.columns)
        columns[all.channels[column.channel].name] = column.values;
    const bool loads = std::ranges::all_of(
                   points.parameters,
                   [](const std::string&name) { return name.starts_with("load"); }),
               drives = std::ranges::none_of(points.parameters, [](const std::string&name) {
                   return name.starts_with("load");
               });
    const std::string word = loads ? "load" : drives ? "parameter" : "load or parameter";
    json readings = json::array();
    for (const auto& reading : found.readings) {
        json rows = json::array();
        for (const auto& of : reading.rows) {
            const auto& channel = all.channels[of.channel];
            json row = {{"channel", channel.name},
                        {"unit", symbol(channel.unit)},
                        {"compared", of.compared}};
            for (const Leg leg : compare::legs) {
                const auto& off = of.off[static_cast<std::size_t>(leg)];
                row[name(leg)] = {{"signed_max", off.signed_max}, {"rms", off.rms}};
            }
            rows.push_back(row);
        }
        const std::string by = reading.by_parameter ? word : all.channels[*measured.abscissa].name;
        readings.push_back({{"reading", "at equal " + by}, {"channels", rows}});
    }
    scene_document["measured"] = {{"file", file},
                                  {"hash", input_hash(csv)},
                                  {"points", points.columns.front().values.size()},
                                  {"columns", columns},
                                  {"branch", found.branch},
                                  {"branch_given", !points.branch.empty()},
                                  {"readings", readings}};
    if (!measured.a.empty()) scene_document["measured"]["parameter"] = measured.a;
    if (measured.abscissa)
        scene_document["measured"]["abscissa"] = all.channels[*measured.abscissa].name;
}

std::pair<std::string, std::string> parse_load_case(std::string_view text) {
    const auto at = text.rfind('=');
    if (at == text.npos || at == 0 || at + 1 == text.size())
        throw std::invalid_argument(fmt::format(
            "--case '{}': allowed: a name of the file's own, '=' and a branch of the scene, such "
            "as 'Lat Force=lateral'",
            text));
    return {std::string(text.substr(0, at)), std::string(text.substr(at + 1))};
}

int compared_with_measurement(const json& scene_document) {
    int compared = 0;
    for (const auto& reading : scene_document.at("measured").at("readings"))
        for (const auto& channel : reading.at("channels"))
            compared += channel.at("compared").get<int>();
    return compared;
}

}  // namespace elastocheck::reports
