#include "reports/document/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "compare/deviation.hpp"
#include "models/scene_words.hpp"
#include "reports/document/provenance.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Leg;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void fail(const std::string& file, int line, const std::string& what) {
    throw MeasurementError(line > 0 ? fmt::format("{}:{}: {}", file, line, what)
                                    : fmt::format("{}: {}", file, what));
}

struct Column {
    std::string name;
    int channel = -1;     // position in Comparison::channels; -1: travel, load or branch
    bool change = false;  // counted from the design position
    std::vector<double> values;
};

struct Points {
    std::vector<Column> columns;
    std::vector<std::string> branch;  // per point, empty without such a column

    const std::vector<double>* find(std::string_view name) const {
        for (const auto& column : columns)
            if (column.name == name) return &column.values;
        return nullptr;
    }
};

std::string_view trimmed(std::string_view word) {
    while (!word.empty() && (word.front() == ' ' || word.front() == '\t')) word.remove_prefix(1);
    while (!word.empty() && (word.back() == ' ' || word.back() == '\t' || word.back() == '\r'))
        word.remove_suffix(1);
    if (word.size() >= 2 && word.front() == '"' && word.back() == '"') word = word.substr(1, word.size() - 2);
    return word;
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (;;) {
        const auto comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == line.npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

double number(std::string_view cell, const std::string& file, int line, const std::string& column) {
    if (cell.empty()) return nan;
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
        fail(file, line,
             fmt::format("{}: {} is not a number; allowed: a number with a decimal point, or nothing", column,
                         reader::quote(cell)));
    return value;
}

std::string unit_suffix(compare::Unit unit) { return unit == compare::Unit::mm ? "mm" : "deg"; }

std::string load_column(const Model& model) {
    for (const auto& branch : model.branches)
        for (const auto& load : branch.loads)
            if (std::holds_alternative<DeadForce>(load.kind)) return "load_N";
    return "load_Nm";
}

Points read(std::string_view csv, const std::string& file, const Model& model,
            const compare::Comparison& all) {
    Points points;
    std::vector<std::string> known{"travel_mm", load_column(model), "branch"};
    std::vector<Column> outputs;
    for (std::size_t c = 0; c < all.channels.size(); ++c) {
        if (!all.channels[c].main) continue;
        const std::string unit = unit_suffix(all.channels[c].unit);
        for (const bool change : {false, true})
            outputs.push_back({fmt::format("{}{}_{}", all.channels[c].name, change ? "_change" : "", unit),
                               static_cast<int>(c),
                               change,
                               {}});
    }
    for (const auto& output : outputs) known.push_back(output.name);

    if (csv.starts_with("\xEF\xBB\xBF")) csv.remove_prefix(3);  // the byte-order mark that spreadsheets write
    if (csv.starts_with("\xFF\xFE") || csv.starts_with("\xFE\xFF"))
        fail(file, 0, "is UTF-16; save it as CSV in UTF-8");
    int number_of_line = 0, branch_column = -1;
    for (std::string_view rest = csv; !rest.empty();) {
        ++number_of_line;
        const auto end = rest.find('\n');
        const std::string_view line = rest.substr(0, end);
        rest = end == rest.npos ? std::string_view{} : rest.substr(end + 1);
        if (trimmed(line).empty()) continue;
        const auto cells = cells_of(line);
        if (points.columns.empty()) {
            for (const auto cell : cells) {
                const std::string name(cell);
                if (points.find(name) != nullptr)
                    fail(file, number_of_line,
                         fmt::format("column {} stands there twice", reader::quote(name)));
                if (std::ranges::find(known, name) == known.end())
                    fail(file, number_of_line,
                         fmt::format("unknown column {}{}", reader::quote(name),
                                     reader::did_you_mean(name, known, "allowed")));
                Column column{name, -1, false, {}};
                for (const auto& output : outputs)
                    if (output.name == name) column = output;
                if (name == "branch") branch_column = static_cast<int>(points.columns.size());
                points.columns.push_back(column);
            }
            continue;
        }
        if (cells.size() != points.columns.size())
            fail(file, number_of_line,
                 fmt::format("{} cells, but {} columns are named in the first line", cells.size(),
                             points.columns.size()));
        for (std::size_t k = 0; k < cells.size(); ++k) {
            if (static_cast<int>(k) == branch_column) {
                const std::string name(cells[k]);
                std::vector<std::string> branches;
                for (const auto& branch : all.branches) branches.push_back(branch.branch);
                if (std::ranges::find(branches, name) == branches.end())
                    fail(file, number_of_line,
                         fmt::format("branch: the scene has no {}{}", reader::quote(name),
                                     reader::did_you_mean(name, branches, "allowed")));
                points.branch.push_back(name);
                points.columns[k].values.push_back(0);
            } else {
                points.columns[k].values.push_back(
                    number(cells[k], file, number_of_line, points.columns[k].name));
            }
        }
    }
    if (points.columns.empty()) fail(file, 0, "empty; the first line names the columns");
    if (points.columns.front().values.empty()) fail(file, 0, "no point in it");
    if (points.find("travel_mm") == nullptr && points.find(known[1]) == nullptr)
        fail(file, 1,
             fmt::format("neither 'travel_mm' nor '{}'; one of them says where a point is", known[1]));
    if (std::ranges::none_of(points.columns, [](const Column& c) { return c.channel >= 0; }))
        fail(file, 1, "no output among the columns; " + reader::did_you_mean("", known, "allowed").substr(2));
    return points;
}

// How far a leg has settled along the branch before its load is applied [mm]: curves count travel from there,
// measurements from the design position.
double settled(const Branch& branch, const compare::Curve& curve, const std::vector<double>& design) {
    const auto direction = compare::travel_direction(branch);
    if (!direction || curve.values.empty() || design.size() < 3) return 0;
    double along = 0;  // the first three channels are the position that travels
    for (int k = 0; k < 3; ++k)
        along += (*direction)[k] *
                 (curve.values.front()[static_cast<std::size_t>(k)] - design[static_cast<std::size_t>(k)]);
    return along;
}

// The outputs at the design position, as drawn.
std::vector<double> at_design(const Model& model) {
    Equilibrium state;
    for (const auto& body : model.bodies) state.poses.push_back(body.design);
    state.reactions.resize(model.joints.size());
    return compare::evaluate(model, state);
}

// The branch of each point: as its column says, or the one that goes its way.
std::vector<std::string> branches_of(const Points& points, const Model& model,
                                     const compare::Comparison& all) {
    if (!points.branch.empty()) return points.branch;
    const auto* travel = points.find("travel_mm");
    const auto* load = points.find(load_column(model));
    std::vector<std::string> names;
    for (std::size_t k = 0; k < points.columns.front().values.size(); ++k) {
        std::string found;
        for (std::size_t b = 0; b < all.branches.size() && found.empty(); ++b) {
            const auto& curve = all.branches[b].runs[static_cast<std::size_t>(Leg::equilibrium)].curve;
            const double end = curve.travel.empty() ? nan : curve.travel.back();
            const bool by_travel = travel != nullptr && (*travel)[k] * end >= 0;
            const bool by_load = load != nullptr && (*load)[k] * model.branches[b].to >= 0;
            if (by_travel || by_load) found = all.branches[b].branch;
        }
        names.push_back(found.empty() ? all.branches.front().branch : found);
    }
    return names;
}

// The leg's value at x on the branch it was measured on; NaN where that does not reach it.
double value_at(const Model& model, const compare::Comparison& all, const std::vector<double>& design,
                Leg leg, std::size_t channel, bool by_travel, double x, const std::string& branch_name) {
    for (std::size_t b = 0; b < all.branches.size(); ++b) {
        if (all.branches[b].branch != branch_name) continue;
        const compare::Curve& curve = all.branches[b].runs[static_cast<std::size_t>(leg)].curve;
        auto at = by_travel ? curve.travel : curve.load;
        if (at.size() < 2 || at.size() != curve.values.size()) return nan;
        if (by_travel)
            for (const double rest = settled(model.branches[b], curve, design); double& travel : at)
                travel += rest;
        const auto [low, high] = std::minmax(at.front(), at.back());
        const bool monotone =
            std::ranges::is_sorted(at, std::less_equal{}) || std::ranges::is_sorted(at, std::greater_equal{});
        if (!monotone || !(x >= low && x <= high)) return nan;
        std::vector<double> y;
        for (const auto& point : curve.values) y.push_back(point[channel]);
        return compare::interpolate(at, y, x, 6);
    }
    return nan;
}

}  // namespace

void add_measurement(json& scene_document, std::string_view csv, const std::string& file, const Model& model,
                     const compare::Comparison& all) {
    Points points = read(csv, file, model, all);
    if (points.branch.empty() && all.branches.size() > 1) {
        // Without names, no two branches may lie on the same side.
        for (std::size_t a = 0; a < model.branches.size(); ++a)
            for (std::size_t b = 0; b < a; ++b)
                if (!(model.branches[a].to * model.branches[b].to < 0))
                    fail(file, 1,
                         fmt::format("branches '{}' and '{}' lie on the same side; a column 'branch' has to "
                                     "say which one a point belongs to",
                                     model.branches[b].name, model.branches[a].name));
    }
    if (all.branches.empty() || all.branches.front().runs[1].curve.values.empty())
        fail(file, 0, "nothing to compare with: the equilibrium leg has no point");
    const std::vector<double> start = at_design(model);
    const std::vector<std::string> branches = branches_of(points, model, all);
    json design = json::object(), rest = json::object();
    for (std::size_t b = 0; b < all.branches.size(); ++b)
        rest[all.branches[b].branch] = settled(
            model.branches[b], all.branches[b].runs[static_cast<std::size_t>(Leg::equilibrium)].curve, start);
    json columns = json::object();
    for (auto& column : points.columns) {
        if (column.name == "branch") continue;
        if (column.channel < 0) {
            columns[column.name] = column.values;
            continue;
        }
        const auto c = static_cast<std::size_t>(column.channel);
        if (column.change)
            for (double& value : column.values) value += start[c];
        columns[all.channels[c].name] = column.values;
        design[all.channels[c].name] = start[c];
    }
    json readings = json::array();
    for (const auto& abscissa : points.columns) {
        if (abscissa.channel >= 0 || abscissa.name == "branch") continue;
        const bool by_travel = abscissa.name == "travel_mm";
        json rows = json::array();
        for (const auto& column : points.columns) {
            if (column.channel < 0) continue;
            const auto c = static_cast<std::size_t>(column.channel);
            json row = {
                {"channel", all.channels[c].name}, {"unit", symbol(all.channels[c].unit)}, {"compared", 0}};
            int compared = std::numeric_limits<int>::max();
            for (const Leg leg : compare::legs) {
                double signed_max = nan, squares = 0;
                int count = 0;
                for (std::size_t k = 0; k < column.values.size(); ++k) {
                    const double off =
                        value_at(model, all, start, leg, c, by_travel, abscissa.values[k], branches[k]) -
                        column.values[k];
                    if (!std::isfinite(off)) continue;
                    ++count;
                    squares += off * off;
                    if (!(std::abs(off) <= std::abs(signed_max))) signed_max = off;
                }
                row[name(leg)] = {{"signed_max", signed_max},
                                  {"rms", count > 0 ? std::sqrt(squares / count) : nan}};
                compared = std::min(compared, count);
            }
            row["compared"] = compared;
            rows.push_back(row);
        }
        readings.push_back(
            {{"reading", by_travel ? "at equal travel" : "at equal load"}, {"channels", rows}});
    }
    scene_document["measured"] = {
        {"file", file},       {"hash", input_hash(csv)}, {"points", points.columns.front().values.size()},
        {"columns", columns}, {"branch", branches},      {"branch_given", !points.branch.empty()},
        {"design", design},   {"settled_mm", rest},      {"readings", readings}};
}

int compared_with_measurement(const json& scene_document) {
    int compared = 0;
    for (const auto& reading : scene_document.at("measured").at("readings"))
        for (const auto& channel : reading.at("channels")) compared += channel.at("compared").get<int>();
    return compared;
}

}  // namespace elastocheck::reports
