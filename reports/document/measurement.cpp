#include "reports/document/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compare/candidate/measured.hpp"
#include "reports/document/candidate_file.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Leg;

// The points of a measurement: outputs that are positions or angles, travel as abscissa only.
PointTable read(std::string_view csv, const std::string& file, const Model& model,
                const compare::Comparison& all, const LoadCases& cases) {
    ColumnMap map;
    map.branches = cases.names;
    if (cases.column != LoadCases{}.column)
        map.columns.push_back({.theirs = cases.column, .output = "branch", .unit = {}});
    PointTable table = read_points(csv, file, model, all, map, true);
    auto& columns = table.points.columns;
    const auto channel = [&](const compare::PointColumn& column) -> const compare::Channel& {
        return all.channels[column.channel];
    };
    if (std::ranges::count_if(columns, [&](const auto& c) { return is_travel(channel(c)); }) > 1)
        fail_at(file, 1, "two columns of travel; allowed: one");
    std::erase_if(columns, [&](const auto& c) { return is_travel(channel(c)); });
    if (columns.empty()) fail_at(file, 1, "no output among the columns");
    for (const auto& column : columns)
        if (!channel(column).kinematic())
            fail_at(
                file, 1,
                fmt::format("{}: only positions and angles can be measured", channel(column).name));
    return table;
}

}  // namespace

void add_measurement(json& scene_document, std::string_view csv, const std::string& file,
                     const Model& model, const compare::Comparison& all, const LoadCases& cases) {
    for (const auto& [theirs, ours] : cases.names)
        if (std::ranges::find(all.branches, ours, &compare::BranchComparison::branch) ==
            all.branches.end())
            fail_at(file, 0,
                    fmt::format("--case {}={}: the scene has no branch '{}'", theirs, ours, ours));
    const PointTable table = read(csv, file, model, all, cases);
    const compare::Points& measured = table.points;
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
                   table.parameters,
                   [](const std::string&name) { return name.starts_with("load"); }),
               drives = std::ranges::none_of(table.parameters, [](const std::string&name) {
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
    scene_document["measured"] = {
        {"file", file},           {"hash", input_hash(csv)},
        {"points", table.count},  {"columns", columns},
        {"branch", found.branch}, {"branch_given", !measured.branch.empty()},
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
