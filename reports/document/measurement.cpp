#include "reports/document/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/candidate/measured.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/files/provenance.hpp"
#include "reports/json/json_cursor.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Leg;

// The curves of a solved scene as they stand in its document. Of the model only its branches.
struct SolvedCurves {
    Model model;
    compare::Comparison comparison;
    std::vector<double> drawn;  // outputs in the design position; NaN where the document has none
    compare::DefinedCurves defined;
};

SolvedCurves curves_of(const JsonCursor& scene) {
    SolvedCurves solved;
    auto& channels = solved.comparison.channels;
    for (const auto& channel : scene["channels"].items()) {
        const auto unit = compare::find_unit(channel["unit"].text());
        if (!unit) channel["unit"].fail("is not known");
        channels.push_back({.name = channel["name"].text(), .unit = *unit, .reads = {}});
        if (!channel["kinematic"].truth()) channels.back().reads = compare::Effort{};
        const auto drawn = channel.find("drawn");
        solved.drawn.push_back(drawn ? drawn->number() : compare::nan);
    }
    for (const auto& branch : scene["branches"].items()) {
        Branch& of_model = solved.model.branches.emplace_back();
        compare::BranchComparison& one = solved.comparison.branches.emplace_back();
        of_model.name = one.branch = branch["name"].text();
        of_model.from = branch["from"].number(), of_model.to = branch["to"].number();
        const auto unit = compare::find_unit(branch["unit"].text());
        if (!unit) branch["unit"].fail("is not known");
        one.unit = *unit;
        for (const auto& leg : branch["legs"].items()) {
            compare::Curve curve{.unit = *unit, .a = leg["curve"]["a"].numbers(), .values = {}};
            curve.values.assign(curve.a.size(), std::vector<double>(channels.size()));
            for (std::size_t c = 0; c < channels.size(); ++c) {
                const JsonCursor field = leg["curve"]["values"][channels[c].name];
                const auto values = field.numbers();
                if (values.size() != curve.a.size()) field.fail("not as many numbers as points");
                for (std::size_t k = 0; k < values.size(); ++k) curve.values[k][c] = values[k];
            }
            one.runs.emplace_back().curve = std::move(curve);
        }
        if (one.runs.size() < compare::legs.size())
            branch["legs"].fail("a measurement is compared with three legs");
    }
    if (const auto defined = scene.find("defined")) {
        for (const auto& channel : (*defined)["channels"].items()) {
            const auto unit = compare::find_unit(channel["unit"].text());
            if (!unit) channel["unit"].fail("is not known");
            solved.defined.channels.push_back(
                {.name = channel["name"].text(), .unit = *unit, .reads = {}});
        }
        const auto of_branches = (*defined)["branches"].items();
        if (of_branches.size() != solved.comparison.branches.size())
            (*defined)["branches"].fail("not as many as the scene's branches");
        for (std::size_t b = 0; b < of_branches.size(); ++b) {
            const auto& of = solved.comparison.branches[b].run(Leg::equilibrium).curve;
            compare::Curve curve{.unit = of.unit, .a = of.a, .start = of.start, .values = {}};
            const std::size_t count = solved.defined.channels.size();
            curve.values.assign(curve.a.size(), std::vector<double>(count));
            for (std::size_t c = 0; c < count; ++c) {
                const JsonCursor field = of_branches[b][solved.defined.channels[c].name];
                const auto values = field.numbers();
                if (values.size() != curve.a.size()) field.fail("not as many numbers as points");
                for (std::size_t k = 0; k < values.size(); ++k) curve.values[k][c] = values[k];
            }
            solved.defined.branches.push_back(std::move(curve));
        }
    }
    return solved;
}

// The points of a measurement: outputs that are positions or angles, travel as abscissa only.
PointTable read(std::string_view csv, const std::string& file, const SolvedCurves& solved,
                const ColumnMap& map) {
    const auto& all = solved.comparison;
    PointTable table = read_points(csv, file, all, map, nullptr);
    auto& columns = table.points.columns;
    const auto channel = [&](const compare::PointColumn& column) -> const compare::Channel& {
        return all.channels[column.channel];
    };
    // The travel that places the points is no output; that of the other wheel of an axle is one.
    std::erase_if(columns, [&](const auto& c) {
        return is_travel(channel(c)) && (c.change || c.channel == table.points.abscissa);
    });
    std::erase_if(columns, [&](const auto& c) {
        if (channel(c).kinematic()) return false;
        table.left_out.push_back(channel(c).name + ": no position or angle");
        return true;
    });
    if (columns.empty())
        fail_at(
            file, 1,
            "no output among the columns" +
                (table.left_out.empty() ? "" : "; left out: " + reader::listed(table.left_out)));
    for (auto& column : columns) {
        if (!column.change) continue;
        const double drawn = solved.drawn[column.channel];
        if (!std::isfinite(drawn))
            fail_at(file, 1,
                    fmt::format("{}: the result lacks the design position; solve again",
                                channel(column).name));
        for (double& value : column.values) value += drawn;
        column.change = false;
    }
    return table;
}

}  // namespace

void add_measurement(json& scene_document, std::string_view csv, const std::string& file,
                     const ColumnMap& map) {
    const std::string result = "result.json";
    const SolvedCurves solved = curves_of({&scene_document, "", &result});
    const compare::Comparison& all = solved.comparison;
    std::vector<std::string> branches;
    for (const auto& branch : all.branches) branches.push_back(branch.branch);
    for (const auto& [theirs, ours] : map.branches)
        if (std::ranges::find(branches, ours) == branches.end())
            fail_at(file, 0,
                    fmt::format("'{}={}': the scene has no branch '{}'{}", theirs, ours, ours,
                                reader::did_you_mean(ours, branches, "allowed")));
    ColumnMap with_tests = map;
    for (const auto& branch : JsonCursor{&scene_document, "", &result}["branches"].items())
        if (const auto moves = branch.find("case"))
            with_tests.tests.push_back(
                {branch["name"].text(), moves->text(), branch["unit"].text() == "mm"});
    const PointTable table = read(csv, file, solved, with_tests);
    const compare::Points& measured = table.points;
    compare::MeasuredComparison found;
    try {
        found = compare::compare_measured(solved.model, all, measured, solved.defined);
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
    json loops = json::array();
    for (const auto& loop : found.loops) {
        const auto& channel = all.channels[loop.channel];
        const auto& branch = all.branch(loop.branch);
        const std::string at_unit = measured.a.empty()
                                        ? symbol(all.channels[*measured.abscissa].unit)
                                        : symbol(branch.unit);
        loops.push_back({{"branch", loop.branch},
                         {"channel", channel.name},
                         {"unit", symbol(channel.unit)},
                         {"width", loop.width},
                         {"at", loop.at},
                         {"at_unit", at_unit},
                         {"points", loop.points}});
    }
    scene_document["measured"] = {{"file", file},
                                  {"hash", input_hash(csv)},
                                  {"points", table.count},
                                  {"left_out", table.left_out},
                                  {"columns", columns},
                                  {"branch", found.branch},
                                  {"branch_given", !measured.branch.empty()},
                                  {"readings", readings},
                                  {"loops", loops},
                                  {"findings", found.explanations}};
    if (!measured.a.empty()) scene_document["measured"]["parameter"] = measured.a;
    if (measured.abscissa)
        scene_document["measured"]["abscissa"] = all.channels[*measured.abscissa].name;
}

void add_defined_curves(json& scene_document, const Model& model,
                        const compare::Comparison& comparison) {
    const compare::DefinedCurves defined = compare::defined_curves(model, comparison);
    json channels = json::array(), branches = json::array();
    for (const auto& channel : defined.channels)
        channels.push_back({{"name", channel.name},
                            {"unit", symbol(channel.unit)},
                            {"definition", channel.definition}});
    for (std::size_t b = 0; b < defined.branches.size(); ++b) {
        const auto& reference = comparison.branches[b].run(Leg::equilibrium).curve;
        // a leg that ended early leaves its points without values
        json values = json::object();
        for (std::size_t c = 0; c < defined.channels.size(); ++c) {
            auto column = defined.branches[b].channel(c);
            column.resize(reference.a.size(), compare::nan);
            values[defined.channels[c].name] = column;
        }
        branches.push_back(std::move(values));
    }
    scene_document["defined"] = {{"channels", channels}, {"branches", branches}};
}

int compared_with_measurement(const json& scene_document) {
    int compared = 0;
    for (const auto& reading : scene_document.at("measured").at("readings"))
        for (const auto& channel : reading.at("channels"))
            compared += channel.at("compared").get<int>();
    return compared;
}

}  // namespace elastocheck::reports
