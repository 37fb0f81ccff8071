#include "reports/given/candidate_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "compare/comparison/elements.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/files/limits.hpp"
#include "reports/given/state_file.hpp"

namespace elastocheck::reports {
namespace {

using compare::nan;
using MeaningKind = Meaning::Kind;

// ---- Table of outputs.

struct OutputTable {
    std::vector<Meaning> columns;
    std::vector<std::vector<double>> values;  // per column
    std::vector<std::string> branch, unit;    // per point, where given by a column
    std::vector<int> lines;
    std::vector<std::string> left_out;  // columns that are not compared
    std::set<std::string, std::less<>> legs;
};

// The columns named in the first line. An unknown one is an error for a candidate without a map.
void read_headings(const Cells& cells, int line, const std::string& file, const Names& names,
                   const std::vector<compare::Channel>* also_known, OutputTable& table) {
    for (const std::string& name : cells) {
        if (std::ranges::find(table.columns, name, &Meaning::name) != table.columns.end())
            fail_at(file, line, fmt::format("column {} is named twice", reader::quote(name)));
        table.columns.push_back(meaning_of(name, names));
        if (table.columns.back().kind != MeaningKind::nothing) continue;
        if (also_known != nullptr && names.map.file.empty() &&
            compare::find_channel(*also_known, name.substr(0, name.find(" ["))) < 0)
            fail_at(file, line,
                    fmt::format("unknown column {}{}", reader::quote(name),
                                reader::did_you_mean(name, known_headings(names), "allowed")));
        table.left_out.push_back(left_out_heading(name, names));
    }
    for (const auto& entry : names.map.columns)
        if (std::ranges::find(table.columns, entry.theirs, &Meaning::name) == table.columns.end())
            fail_at(file, line,
                    fmt::format("there is no column {} ({})", reader::quote(entry.theirs),
                                names.map.file));
    table.values.resize(table.columns.size());
}

OutputTable read_table(std::string_view csv, const std::string& file, const Names& names,
                       const std::vector<compare::Channel>* also_known) {
    OutputTable table;
    const auto head = [&](const Cells& cells, int line) {
        read_headings(cells, line, file, names, also_known, table);
    };
    read_csv_table(csv, file, max_measured_points, head, [&](const Cells& cells, int line) {
        table.lines.push_back(line);
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const Meaning& meaning = table.columns[c];
            switch (meaning.kind) {
                case MeaningKind::branch:
                    table.branch.push_back(
                        branch_of_cell(cells[c], names, file, line, meaning.name));
                    break;
                case MeaningKind::parameter_unit: table.unit.emplace_back(cells[c]); break;
                case MeaningKind::leg: table.legs.emplace(cells[c]); break;
                case MeaningKind::nothing: break;
                case MeaningKind::parameter:
                case MeaningKind::output: {
                    const double read = (also_known == nullptr ? number_in : number_or_infinity)(
                        cells[c], file, line, meaning.name);
                    table.values[c].push_back(
                        std::isinf(read) ? INFINITY : read * meaning.factor + meaning.offset);
                    break;
                }
            }
        }
    });
    if (table.legs.size() > 1)
        fail_at(file, 1,
                fmt::format("leg: {} names; allowed: one, since a candidate is one solver",
                            table.legs.size()));
    return table;
}

// Adds the parameters of a column to the points whose branch has its quantity, in the branch's unit.
void add_parameters(const OutputTable& table, std::size_t c, const std::string& file,
                    const Names& names, std::vector<double>& a) {
    const Meaning& meaning = table.columns[c];
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (std::isnan(table.values[c][k])) continue;
        if (names.tests.empty()) return;
        const TestBranch& branch =
            table.branch.empty()
                ? names.tests.front()
                : *std::ranges::find(names.tests, table.branch[k], &TestBranch::branch);
        const std::string& written_in =
            meaning.unit.empty() && !table.unit.empty() ? table.unit[k] : meaning.unit;
        const auto factor = factor_of(written_in, branch.unit);
        if (!meaning.moves.empty() && (!factor || branch.moves != meaning.moves)) continue;
        if (!factor)
            fail_at(file, table.lines[k],
                    fmt::format("{}: {} is not a unit of the parameter of branch '{}'; allowed: {}",
                                meaning.name, reader::quote(written_in), branch.branch,
                                allowed_units(branch.unit)));
        if (!std::isnan(a[k]))
            fail_at(file, table.lines[k],
                    fmt::format("{}: another column gives the parameter of this point as well",
                                meaning.name));
        a[k] = table.values[c][k] * *factor;
    }
}

}  // namespace

bool is_travel(const compare::Channel& channel) {
    return compare::is_figure(channel, compare::figure::travel);
}

void drop_points(PointTable& table,
                 const std::function<std::string(std::size_t point)>& why_left_out) {
    std::map<std::string, std::vector<int>> left_out;  // lines by reason
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < table.lines.size(); ++k)
        if (const std::string why = why_left_out(k); why.empty())
            kept.push_back(k);
        else
            left_out[why].push_back(table.lines[k]);
    const auto keep = [&](auto& of_points) {
        if (of_points.empty()) return;
        auto all = std::exchange(of_points, {});
        for (const std::size_t k : kept) of_points.push_back(std::move(all[k]));
    };
    compare::Points& points = table.points;
    keep(table.lines);
    keep(points.branch);
    keep(points.a);
    keep(points.at);
    for (auto& column : points.columns) keep(column.values);
    constexpr std::size_t max_lines = 10;
    for (const auto& [why, lines] : left_out)
        table.left_out.push_back(fmt::format(
            "{} {} {} (line{} {}{})", lines.size(), lines.size() == 1 ? "row" : "rows", why,
            lines.size() == 1 ? "" : "s",
            fmt::join(lines.begin(), lines.begin() + std::min(lines.size(), max_lines), ", "),
            lines.size() > max_lines ? ", ..." : ""));
}

PointTable read_points(std::string_view csv, const std::string& file, const Names& names,
                       const std::vector<compare::Channel>* also_known) {
    PointTable result;
    const OutputTable table = read_table(csv, file, names, also_known);
    auto& points = result.points;
    points.branch = table.branch;
    result.lines = table.lines;
    result.left_out = table.left_out;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const Meaning& meaning = table.columns[c];
        if (meaning.kind == MeaningKind::parameter) {
            result.parameters.push_back(meaning.name);
            points.a.resize(result.lines.size(), nan);
            add_parameters(table, c, file, names, points.a);
        } else if (meaning.kind == MeaningKind::output) {
            const auto& channel = names.channels[meaning.channel];
            if (std::ranges::find(points.columns, meaning.channel,
                                  &compare::PointColumn::channel) != points.columns.end())
                fail_at(file, 1, fmt::format("two columns for {}", channel.name));
            points.columns.push_back({meaning.channel, meaning.change, table.values[c]});
            if (!points.abscissa && !meaning.change && is_travel(channel)) {
                points.abscissa = meaning.channel;
                points.at = table.values[c];
            }
        }
    }
    if (!points.a.empty() && table.branch.empty())
        for (const auto& branch : names.tests)
            if (branch.unit != names.tests.front().unit)
                fail_at(file, 1, "a column 'branch' is needed: branches have different units");
    if (points.a.empty() && !points.abscissa)
        fail_at(
            file, 1,
            "no column gives the parameter or travel of a point" +
                reader::did_you_mean(
                    "", std::vector<std::string>{"parameter", "load_N", "travel_mm"}, "allowed"));
    if (points.columns.empty())
        fail_at(file, 1,
                "no output among the columns; " +
                    reader::did_you_mean("", known_headings(names), "allowed").substr(2));
    return result;
}

compare::Candidate read_candidate(const CandidateFile& given, const Scene& scene,
                                  const Model& model, const compare::Comparison& comparison,
                                  const ColumnMap& map) {
    const auto& [name, file, content] = given;
    const Names names = names_of(model, comparison.channels, map);
    compare::Candidate candidate;
    if (holds_states(content)) {
        std::string passed_over;
        candidate = compare::candidate_of(
            model, comparison, name, read_states(content, file, scene, model, names, passed_over));
        if (!passed_over.empty())
            candidate.notes.push_back("bodies that are not solved for, and are passed over: " +
                                      passed_over);
    } else {
        const auto elements = compare::element_channels(model);
        auto table = read_points(content, file, names, &elements);
        candidate.points = std::move(table.points);
        if (!table.left_out.empty())
            candidate.notes.push_back("columns that are not compared: " +
                                      reader::listed(table.left_out));
    }
    candidate.name = name;
    return candidate;
}

}  // namespace elastocheck::reports
