#include "reports/document/candidate_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "compare/comparison/elements.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/tables/csv.hpp"
#include "reports/files/limits.hpp"
#include "reports/json/json.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using compare::nan;

using compare::Unit;
using json = nlohmann::ordered_json;

constexpr double unit_length = 1e-6;  // allowed deviation of a quaternion's length from one

// ---- Accepted units of a table.

struct Written {
    const char* symbol;
    Unit unit;      // base unit
    double factor;  // to the base unit
};
constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr std::array written{Written{"mm", Unit::mm, 1},
                             Written{"cm", Unit::mm, 10},
                             Written{"m", Unit::mm, 1e3},
                             Written{"in", Unit::mm, 25.4},
                             Written{"deg", Unit::deg, 1},
                             Written{"rad", Unit::deg, degrees_per_radian},
                             Written{"mrad", Unit::deg, 1e-3 * degrees_per_radian},
                             Written{"arcmin", Unit::deg, 1.0 / 60},
                             Written{"'", Unit::deg, 1.0 / 60},
                             Written{"′", Unit::deg, 1.0 / 60},
                             Written{"N", Unit::newton, 1},
                             Written{"kN", Unit::newton, 1e3},
                             Written{"N·m", Unit::newton_metre, 1},
                             Written{"Nm", Unit::newton_metre, 1},
                             Written{"Nmm", Unit::newton_metre, 1e-3},
                             Written{"kNm", Unit::newton_metre, 1e3},
                             Written{"percent", Unit::percent, 1}};

std::optional<double> factor_of(std::string_view symbol, Unit unit) {
    if (symbol.empty() || symbol == compare::symbol(unit)) return 1;
    for (const auto& w : written)
        if (w.unit == unit && symbol == w.symbol) return w.factor;
    return std::nullopt;
}

std::string allowed_units(Unit unit) {
    std::vector<std::string> list;
    for (const auto& w : written)
        if (w.unit == unit) list.emplace_back(w.symbol);
    if (list.empty()) list.emplace_back(compare::symbol(unit));
    return reader::listed(list);
}

// A number; infinite for a cell such as NaN; NaN for an empty cell.
double number_or_none(std::string_view cell, const std::string& file, int line,
                      const std::string& column) {
    if (cell.empty()) return nan;
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc{} && end == cell.data() + cell.size() && !std::isfinite(value))
        return INFINITY;
    return number_in(cell, file, line, column);
}

// ---- Meaning of a column.

struct Meaning {
    enum class Kind {
        output,
        parameter,
        parameter_unit,
        branch,
        leg,
        nothing
    } kind = Kind::nothing;
    std::string name{};  // in the file
    std::size_t channel = 0;
    bool change = false;
    double factor = 1, offset = 0;
    std::string
        unit{};  // of a parameter, as written; empty: the branch's own, or given by a column
    std::string moves{};  // of a rig's parameter: RigHeading::moves
};
using MeaningKind = Meaning::Kind;

// "toe [deg]", "toe_deg", "toe_change_deg", "toe"
std::optional<Meaning> output_of(std::string_view name, const compare::Comparison& all) {
    for (std::size_t c = 0; c < all.channels.size(); ++c) {
        const auto& channel = all.channels[c];
        if (!name.starts_with(channel.name)) continue;
        std::string_view rest = name.substr(channel.name.size());
        Meaning meaning{.kind = MeaningKind::output, .name = std::string(name), .channel = c};
        if (rest.starts_with("_change_")) {
            meaning.change = true;
            rest.remove_prefix(8);
        } else if (rest.starts_with(" [") && rest.ends_with("]")) {
            rest = rest.substr(2, rest.size() - 3);
        } else if (rest.starts_with("_") && rest.size() > 1) {
            rest.remove_prefix(1);
        } else if (!rest.empty()) {
            continue;
        }
        const auto factor = factor_of(rest, channel.unit);
        if (!factor) continue;
        meaning.factor = *factor;
        return meaning;
    }
    return std::nullopt;
}

std::optional<Meaning> parameter_of(std::string_view name) {
    for (const std::string_view word : {"parameter", "load"}) {
        if (!name.starts_with(word)) continue;
        std::string_view rest = name.substr(word.size());
        if (rest.empty()) return Meaning{.kind = MeaningKind::parameter, .name = std::string(name)};
        if (rest.starts_with(" [") && rest.ends_with("]"))
            rest = rest.substr(2, rest.size() - 3);
        else if (rest.starts_with("_"))
            rest.remove_prefix(1);
        for (const auto& w : written)
            if (rest == w.symbol)
                return Meaning{.kind = MeaningKind::parameter,
                               .name = std::string(name),
                               .unit = std::string(rest)};
    }
    return std::nullopt;
}

// Names of a file in those of a scene.
struct Names {
    const compare::Comparison& all;
    const ColumnMap& map;
    std::vector<TestBranch> tests;
};

// A heading as rigs write it, its unit in brackets or after the last _. The wheel of a scene with one
// is the left one.
std::optional<Meaning> of_rig(const std::string& name, const Names& names) {
    const compare::Comparison& all = names.all;
    if (name.starts_with("left."))
        if (auto of_wheel = output_of(std::string_view(name).substr(5), all)) {
            of_wheel->name = name;
            return of_wheel;
        }
    std::string heading = name;
    const auto last = name.rfind('_');
    if (last != name.npos &&
        std::ranges::find(written, name.substr(last + 1), &Written::symbol) != written.end())
        heading = fmt::format("{} [{}]", name.substr(0, last), name.substr(last + 1));
    const auto ours = heading_of_rig(heading, all, names.tests);
    if (!ours) return std::nullopt;
    auto meaning = ours->name == "branch" ? std::optional(Meaning{.kind = MeaningKind::branch})
                                          : parameter_of(ours->name);
    if (!meaning) meaning = output_of(ours->name, all);
    if (meaning) meaning->name = name, meaning->moves = ours->moves;
    return meaning;
}

std::vector<std::string> known_columns(const compare::Comparison& all) {
    std::vector<std::string> names{"branch", "parameter", "load_N"};
    for (const auto& channel : all.channels)
        names.push_back(fmt::format("{} [{}]", channel.name, compare::symbol(channel.unit)));
    return names;
}

// " (did you mean 'toe_deg'?)", or nothing.
std::string nearest(const std::string& name, const compare::Comparison& all) {
    std::vector<std::string> names;
    for (const auto& channel : all.channels) {
        const std::string unit = compare::symbol(channel.unit);
        names.push_back(channel.name + (name.ends_with("]") ? " [" + unit + "]" : "_" + unit));
    }
    const std::string help = reader::did_you_mean(name, names, "allowed");
    return help.starts_with(", ") ? " (" + help.substr(2, help.find('?') - 1) + ")" : "";
}

Meaning mapped(const ColumnMap::Entry& entry, const ColumnMap& map,
               const compare::Comparison& all) {
    const auto wrong = [&](const char* field, const std::string& what) {
        reader::fail(map.file, entry.line, fmt::format("columns.{}.{}", entry.theirs, field), what);
    };
    Meaning meaning{.name = entry.theirs};
    if (entry.output == "branch") {
        meaning.kind = MeaningKind::branch;
    } else if (entry.output == "parameter" || entry.output == "load") {
        meaning.kind = MeaningKind::parameter;
        meaning.unit = entry.unit;
        meaning.factor = entry.sign, meaning.offset = entry.offset;
        if (!entry.unit.empty() &&
            std::ranges::find(written, entry.unit, &Written::symbol) == written.end())
            wrong("unit", fmt::format("{} is no unit; allowed: mm, m, deg, rad, N, kN, Nm, ...",
                                      reader::quote(entry.unit)));
    } else {
        const int channel = compare::find_channel(all.channels, entry.output);
        if (channel < 0) {
            std::vector<std::string> names{"parameter", "branch"};
            for (const auto& c : all.channels) names.push_back(c.name);
            wrong("output", fmt::format("there is no output {}{}", reader::quote(entry.output),
                                        reader::did_you_mean(entry.output, names, "outputs")));
        }
        meaning.kind = MeaningKind::output;
        meaning.channel = static_cast<std::size_t>(channel);
        const Unit unit = all.channels[meaning.channel].unit;
        const auto factor = factor_of(entry.unit, unit);
        if (!factor)
            wrong("unit", fmt::format("{} is no unit of {}; allowed: {}", reader::quote(entry.unit),
                                      entry.output, allowed_units(unit)));
        meaning.factor = entry.sign * *factor;
        meaning.offset = entry.offset;
        meaning.change = entry.change;
    }
    return meaning;
}

std::string branch_named(std::string_view cell, const Names& names, const std::string& file,
                         int line, const std::string& column) {
    const auto& [all, map, tests] = names;
    const auto own =
        std::ranges::find(map.branches, cell, &std::pair<std::string, std::string>::first);
    const std::string name = own == map.branches.end() ? std::string(cell) : own->second;
    std::vector<std::string> branches;
    for (const auto& branch : all.branches) branches.push_back(branch.branch);
    if (std::ranges::find(branches, name) == branches.end()) {
        const auto meant = branches_of_test(name, tests);
        if (meant.size() == 1) return meant.front();
        if (meant.size() > 1)
            fail_at(file, line,
                    fmt::format("{}: {} may be any of the branches {}; give one of them in a map",
                                column, reader::quote(name), reader::listed(meant)));
    }
    if (std::ranges::find(branches, name) == branches.end())
        fail_at(file, line,
                fmt::format("{}: the scene has no branch {}{}", column, reader::quote(name),
                            reader::did_you_mean(name, branches, "allowed")));
    return name;
}

Unit unit_of_branch(const std::string& branch, const compare::Comparison& all) {
    return std::ranges::find(all.branches, branch, &compare::BranchComparison::branch)->unit;
}

// ---- Table of outputs.

struct Table {
    std::vector<Meaning> columns;
    std::vector<std::vector<double>> values;  // per column
    std::vector<std::string> branch, unit;    // per point, where given by a column
    std::vector<int> lines;
    std::set<std::string, std::less<>> legs;
};

Table read_table(std::string_view csv, const std::string& file, const Names& names,
                 const std::vector<compare::Channel>* also_known,
                 std::vector<std::string>& left_out) {
    const auto& [all, map, tests] = names;
    Table table;
    const auto head = [&](const Cells& cells, int line) {
        const auto known = known_columns(all);
        for (const auto cell : cells) {
            const std::string name(cell);
            if (std::ranges::find(table.columns, name, &Meaning::name) != table.columns.end())
                fail_at(file, line, fmt::format("column {} is named twice", reader::quote(name)));
            const auto entry = std::ranges::find(map.columns, name, &ColumnMap::Entry::theirs);
            std::optional<Meaning> meaning;
            if (entry != map.columns.end())
                meaning = mapped(*entry, map, all);
            else if (name == "branch")
                meaning = Meaning{.kind = MeaningKind::branch, .name = name};
            else if (name == "leg")
                meaning = Meaning{.kind = MeaningKind::leg, .name = name};
            else if (name == "unit")
                meaning = Meaning{.kind = MeaningKind::parameter_unit, .name = name};
            else
                meaning = parameter_of(name);
            if (!meaning) meaning = output_of(name, all);
            if (!meaning) meaning = of_rig(name, names);
            if (!meaning) {
                const auto own = name.substr(0, name.find(" ["));
                if (also_known != nullptr && map.file.empty() &&
                    compare::find_channel(*also_known, own) < 0)
                    fail_at(file, line,
                            fmt::format("unknown column {}{}", reader::quote(name),
                                        reader::did_you_mean(name, known, "allowed")));
                left_out.push_back(for_terminal(name) + nearest(name, all));
                meaning = Meaning{.kind = MeaningKind::nothing, .name = name};
            }
            table.columns.push_back(*meaning);
        }
        for (const auto& entry : map.columns)
            if (std::ranges::find(table.columns, entry.theirs, &Meaning::name) ==
                table.columns.end())
                fail_at(file, line,
                        fmt::format("there is no column {} ({})", reader::quote(entry.theirs),
                                    map.file));
        table.values.resize(table.columns.size());
    };
    read_sheet(csv, file, most_measured, head, [&](const Cells& cells, int line) {
        table.lines.push_back(line);
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const Meaning& meaning = table.columns[c];
            switch (meaning.kind) {
                case MeaningKind::branch:
                    table.branch.push_back(branch_named(cells[c], names, file, line, meaning.name));
                    break;
                case MeaningKind::parameter_unit: table.unit.emplace_back(cells[c]); break;
                case MeaningKind::leg: table.legs.emplace(cells[c]); break;
                case MeaningKind::nothing: break;
                case MeaningKind::parameter:
                case MeaningKind::output:
                    table.values[c].push_back((also_known == nullptr ? number_in : number_or_none)(
                                                  cells[c], file, line, meaning.name) *
                                                  meaning.factor +
                                              meaning.offset);
                    if (std::isinf(table.values[c].back())) table.values[c].back() = INFINITY;
                    break;
            }
        }
    });
    if (table.legs.size() > 1)
        fail_at(file, 1, fmt::format("leg: {} of them; a candidate is one", table.legs.size()));
    return table;
}

}  // namespace

bool is_travel(const compare::Channel& channel) {
    return compare::is_figure(channel, compare::figure::travel);
}

void keep_rows(PointTable& table, const std::function<std::string(std::size_t point)>& why_not) {
    std::map<std::string, std::vector<int>> left_out;  // lines by reason
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < table.lines.size(); ++k)
        if (const std::string why = why_not(k); why.empty())
            kept.push_back(k);
        else
            left_out[why].push_back(table.lines[k]);
    const auto keep = [&](auto& of_points) {
        if (of_points.empty()) return;
        auto all = std::exchange(of_points, {});
        for (const std::size_t k : kept) of_points.push_back(std::move(all[k]));
    };
    compare::Points& points = table.points;
    keep(table.lines), keep(points.branch), keep(points.a), keep(points.at);
    for (auto& column : points.columns) keep(column.values);
    constexpr std::size_t most_lines = 10;
    for (const auto& [why, lines] : left_out)
        table.left_out.push_back(fmt::format(
            "{} {} {} (line{} {}{})", lines.size(), lines.size() == 1 ? "row" : "rows", why,
            lines.size() == 1 ? "" : "s",
            fmt::join(lines.begin(), lines.begin() + std::min(lines.size(), most_lines), ", "),
            lines.size() > most_lines ? ", ..." : ""));
}

PointTable read_points(std::string_view csv, const std::string& file, const Model& model,
                       const compare::Comparison& all, const ColumnMap& map,
                       const std::vector<compare::Channel>* also_known) {
    PointTable result;
    const Names names{all, map, tests_of(model)};
    const Table table = read_table(csv, file, names, also_known, result.left_out);
    auto& points = result.points;
    points.branch = table.branch;
    result.lines = table.lines;
    const std::size_t n = result.lines.size();
    std::vector<std::size_t> parameters;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (table.columns[c].kind == MeaningKind::parameter) {
            parameters.push_back(c);
            result.parameters.push_back(table.columns[c].name);
        }
    // Each point by the column in the unit of its branch, converted to that unit.
    for (const std::size_t c : parameters) {
        const Meaning& meaning = table.columns[c];
        if (points.a.empty()) points.a.assign(n, nan);
        for (std::size_t k = 0; k < n; ++k) {
            if (std::isnan(table.values[c][k])) continue;
            if (table.branch.empty() && all.branches.empty()) break;
            const Unit unit = table.branch.empty() ? all.branches.front().unit
                                                   : unit_of_branch(table.branch[k], all);
            const std::string& written_in =
                meaning.unit.empty() && !table.unit.empty() ? table.unit[k] : meaning.unit;
            const auto factor = factor_of(written_in, unit);
            if (!meaning.moves.empty()) {
                const std::string& branch =
                    table.branch.empty() ? all.branches.front().branch : table.branch[k];
                const auto test = std::ranges::find(names.tests, branch, &TestBranch::branch);
                if (!factor || test == names.tests.end() || test->moves != meaning.moves) continue;
            }
            if (!factor)
                fail_at(file, table.lines[k],
                        fmt::format(
                            "{}: {} is not a unit of the parameter of branch '{}'; allowed: {}",
                            meaning.name, reader::quote(written_in),
                            table.branch.empty() ? all.branches.front().branch : table.branch[k],
                            allowed_units(unit)));
            if (!std::isnan(points.a[k]))
                fail_at(file, table.lines[k],
                        fmt::format("{}: another column gives the parameter of this point as well",
                                    meaning.name));
            points.a[k] = table.values[c][k] * *factor;
        }
    }
    if (!parameters.empty() && table.branch.empty())
        for (const auto& branch : all.branches)
            if (branch.unit != all.branches.front().unit)
                fail_at(file, 1, "a column 'branch' is needed: branches have different units");
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (table.columns[c].kind == MeaningKind::output) {
            const auto& channel = all.channels[table.columns[c].channel];
            if (std::ranges::find(points.columns, table.columns[c].channel,
                                  &compare::PointColumn::channel) != points.columns.end())
                fail_at(file, 1, fmt::format("two columns for {}", channel.name));
            points.columns.push_back(
                {table.columns[c].channel, table.columns[c].change, table.values[c]});
            if (!points.abscissa && !points.columns.back().change && is_travel(channel))
                points.abscissa = table.columns[c].channel, points.at = table.values[c];
        }
    if (points.a.empty() && !points.abscissa) {
        std::vector<std::string> places{"parameter", "load_N", "travel_mm"};
        fail_at(file, 1,
                "no column gives the parameter or travel of a point" +
                    reader::did_you_mean("", places, "allowed"));
    }
    if (points.columns.empty())
        fail_at(file, 1,
                "no output among the columns; " +
                    reader::did_you_mean("", known_columns(all), "allowed").substr(2));
    return result;
}

namespace {

// ---- States.

// Nodes within a beam: bodies connected only to beam segments. Their poses may be omitted.
std::vector<bool> nodes_of(const Model& model) {
    std::vector<bool> beam(model.bodies.size(), false), other(model.bodies.size(), false);
    const auto mark = [](std::vector<bool>& list, BodyId body) {
        if (body != ground) list[static_cast<std::size_t>(body)] = true;
    };
    for (const auto& elastic : model.elastics)
        std::visit(
            [&](const auto& e) {
                for (const BodyId b : {e.i.body, e.j.body})
                    mark(elastic.written_as == WrittenAs::beam ? beam : other, b);
            },
            elastic.kind);
    for (const auto& joint : model.joints) mark(other, joint.i), mark(other, joint.j);
    for (const auto& wheel : model.wheels) mark(other, wheel.body);
    for (std::size_t b = 0; b < beam.size(); ++b) beam[b] = beam[b] && !other[b];
    return beam;
}

double finite_or_infinite(double value) { return std::isfinite(value) ? value : INFINITY; }

struct Bodies {
    const Scene& scene;
    const Model& model;
    std::vector<bool> node;
    std::set<std::string> passed_over;

    // Position in Model::bodies, or -1 for a body of the scene that is not modelled.
    int find(const std::string& name, const std::string& file, int line) {
        const auto found = std::ranges::find(model.bodies, name, &Body::name);
        if (found != model.bodies.end()) return static_cast<int>(found - model.bodies.begin());
        std::vector<std::string> names;
        for (const auto& body : scene.bodies) names.push_back(body.name);
        if (std::ranges::find(names, name) == names.end() && name != "ground")
            fail_at(file, line,
                    fmt::format("bodies: the scene has no body {}{}", reader::quote(name),
                                reader::did_you_mean(name, names, "bodies")));
        passed_over.insert(name);
        return -1;
    }
    std::vector<Pose> nowhere() const {
        Pose pose;
        pose.r.setConstant(nan);
        pose.p.coeffs().setConstant(nan);
        return {model.bodies.size(), pose};
    }
    void check_complete(const compare::CandidateState& state, const std::string& file,
                        int line) const {
        for (std::size_t b = 0; b < node.size(); ++b)
            if (!node[b] && std::isnan(state.poses[b].r.x()))
                fail_at(file, line,
                        fmt::format("bodies: body '{}' is missing", model.bodies[b].name));
    }
};

void put(Pose& pose, const Eigen::Vector3d& r, const Eigen::Vector4d& wxyz, const std::string& what,
         const std::string& file, int line) {
    pose.r = r;
    pose.p = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    if (!r.allFinite() || !wxyz.allFinite()) {
        pose.r.setConstant(INFINITY);
        pose.p = Eigen::Quaterniond::Identity();
        return;
    }
    if (const double length = pose.p.norm(); !(std::abs(length - 1) <= unit_length))
        fail_at(
            file, line,
            fmt::format("{}: its length is {:.9g}; allowed: a unit quaternion w, x, y, z, to 1e-6",
                        what, length));
    pose.p.normalize();
}

// null is JSON's representation of a value that is not finite.
std::vector<double> numbers_of(const JsonCursor& list, std::size_t count, const char* what) {
    auto numbers = list.numbers();
    if (numbers.size() != count) list.fail(std::string("expected a list of ") + what);
    return numbers;
}

compare::CandidateState state_of(const JsonCursor& object, const std::string& file, int line,
                                 Bodies& bodies, const Names& names) {
    object.only_keys({"branch", "load", "bodies"});
    compare::CandidateState state{
        branch_named(object["branch"].text(), names, file, line, "branch"),
        finite_or_infinite(object["load"].number()), bodies.nowhere()};
    for (const auto& [name, pose] : object["bodies"].entries()) {
        const auto r = numbers_of(pose["position"], 3, "3 numbers [m]"),
                   p = numbers_of(pose["orientation"], 4, "4 numbers, w, x, y, z");
        Pose read;
        put(read, {r[0], r[1], r[2]}, {p[0], p[1], p[2], p[3]}, pose["orientation"].path, file,
            line);
        if (const int b = bodies.find(name, file, line); b >= 0)
            state.poses[static_cast<std::size_t>(b)] = read;
    }
    bodies.check_complete(state, file, line);
    return state;
}

std::vector<compare::CandidateState> states_of_json(std::string_view text, const std::string& file,
                                                    Bodies& bodies, const Names& names) {
    std::vector<compare::CandidateState> states;
    int line = 0;
    for (std::string_view rest = text; !rest.empty();) {
        ++line;
        const auto end = rest.find('\n');
        const std::string_view one = rest.substr(0, end);
        rest = end == rest.npos ? std::string_view{} : rest.substr(end + 1);
        if (one.find_first_not_of(" \t\r") == one.npos) continue;
        if (states.size() == most_measured)
            fail_at(file, line,
                    fmt::format("more states than {}, the most that are read", most_measured));
        try {
            const json object = parse_json(one);
            const std::string place = fmt::format("{}:{}", file, line);
            states.push_back(state_of({&object, "", &place}, file, line, bodies, names));
        } catch (const JsonError& error) {
            fail_at(file, line, error.what());
        } catch (const ResultError& error) {
            throw SheetError(error.what());
        }
    }
    if (states.empty()) fail_at(file, 0, "no state in it");
    return states;
}

std::vector<compare::CandidateState> states_of_table(std::string_view csv, const std::string& file,
                                                     Bodies& bodies, const Names& names) {
    static const std::vector<std::string> headings{"branch", "load", "body", "x",  "y",
                                                   "z",      "qw",   "qx",   "qy", "qz"};
    std::vector<std::size_t> place;
    std::vector<compare::CandidateState> states;
    std::vector<int> lines;
    std::map<std::pair<std::string, double>, std::size_t> known;
    const auto head = [&](const Cells& cells, int line) {
        for (const auto& name : headings) {
            const auto found = std::ranges::find(cells, name);
            if (found == cells.end())
                fail_at(
                    file, line,
                    fmt::format("no column '{}'; states have {}", name, reader::listed(headings)));
            place.push_back(static_cast<std::size_t>(found - cells.begin()));
        }
        if (cells.size() != headings.size())
            fail_at(file, line, "a column too many; states have " + reader::listed(headings));
    };
    read_sheet(csv, file, most_measured * 10, head, [&](const Cells& cells, int line) {
        const std::string branch = branch_named(cells[place[0]], names, file, line, "branch");
        const auto number = [&](std::size_t k) {
            const double value = number_or_none(cells[place[k]], file, line, headings[k]);
            if (std::isnan(value)) fail_at(file, line, headings[k] + ": an empty cell");
            return value;
        };
        const double load = number(1);
        const auto [at, is_new] = known.try_emplace({branch, load}, states.size());
        if (is_new) {
            if (states.size() == most_measured)
                fail_at(file, line,
                        fmt::format("more states than {}, the most that are read", most_measured));
            states.push_back({branch, load, bodies.nowhere()}), lines.push_back(line);
        }
        Pose pose;
        put(pose, {number(3), number(4), number(5)}, {number(6), number(7), number(8), number(9)},
            "orientation", file, line);
        const std::string name(cells[place[2]]);
        if (const int b = bodies.find(name, file, line); b >= 0) {
            Pose& of = states[at->second].poses[static_cast<std::size_t>(b)];
            if (!std::isnan(of.r.x()))
                fail_at(file, line, fmt::format("body '{}' is there already at this load", name));
            of = pose;
        }
    });
    for (std::size_t k = 0; k < states.size(); ++k)
        bodies.check_complete(states[k], file, lines[k]);
    return states;
}

bool begins_as_json(std::string_view content) {
    const auto first = content.find_first_not_of(" \t\r\n");
    return first != content.npos && content[first] == '{';
}

// JSON lines, or a table with a column `body`.
bool holds_states(std::string_view content) {
    if (begins_as_json(content)) return true;
    reader::CsvLines lines(content);
    if (!lines.next()) return false;
    const auto cells = lines.cells();
    return std::ranges::find(cells, "body") != cells.end() &&
           std::ranges::find(cells, "qw") != cells.end();
}

}  // namespace

ColumnMap read_column_map(std::string_view yaml, const std::string& file) {
    ColumnMap map;
    map.file = file;
    const reader::Value tree = reader::parse_yaml(yaml, file);
    std::vector<Number> numbers;
    const reader::Cursor top{&tree, "", &file, &numbers};
    top.only_keys({"columns", "branches"});
    // Names of another tool may contain brackets.
    const auto entries = [](const reader::Cursor& of) {
        if (of.value->kind != reader::Value::Kind::map)
            of.fail("expected a map of their names, found " + of.found());
        std::vector<std::pair<std::string, reader::Cursor>> list;
        for (std::size_t k = 0; k < of.value->items.size(); ++k)
            list.emplace_back(
                of.value->keys[k],
                of.at(of.value->items[k], of.path + "." + reader::shown(of.value->keys[k])));
        return list;
    };
    const auto columns = top.optional("columns");
    if (!columns && !top.optional("branches")) top.fail("no names; required: columns or branches");
    for (const auto& [name, at] : columns ? entries(*columns) : decltype(entries(*columns)){}) {
        at.only_keys({"output", "unit", "sign", "offset", "change"});
        ColumnMap::Entry entry{.theirs = name, .line = at.value->line};
        entry.output = at.require("output").text("an output of the scene, 'parameter' or 'branch'");
        if (const auto unit = at.optional("unit")) entry.unit = unit->text("a unit");
        if (const auto sign = at.optional("sign")) {
            entry.sign = sign->number();
            if (entry.sign != 1 && entry.sign != -1) sign->fail("expected 1 or -1");
        }
        if (const auto offset = at.optional("offset")) entry.offset = offset->number();
        if (const auto change = at.optional("change")) entry.change = change->yes_or_no();
        map.columns.push_back(std::move(entry));
    }
    if (const auto branches = top.optional("branches"))
        for (const auto& [name, at] : entries(*branches))
            map.branches.emplace_back(name, at.text("a branch of the scene"));
    return map;
}

compare::Candidate read_candidate(std::string_view content, const std::string& file,
                                  std::string name, const Scene& scene, const Model& model,
                                  const compare::Comparison& comparison, const ColumnMap& map) {
    compare::Candidate candidate;
    if (holds_states(content)) {
        Bodies bodies{scene, model, nodes_of(model), {}};
        const Names names{comparison, map, tests_of(model)};
        const auto states = begins_as_json(content) ? states_of_json(content, file, bodies, names)
                                                    : states_of_table(content, file, bodies, names);
        candidate = compare::candidate_of(model, comparison, name, states);
        if (!bodies.passed_over.empty())
            candidate.notes.push_back(
                "bodies that are not solved for, and are passed over: " +
                reader::listed({bodies.passed_over.begin(), bodies.passed_over.end()}));
    } else {
        const auto elements = compare::element_channels(model);
        auto table = read_points(content, file, model, comparison, map, &elements);
        candidate.points = std::move(table.points);
        if (!table.left_out.empty())
            candidate.notes.push_back("columns that are not compared: " +
                                      reader::listed(table.left_out));
    }
    candidate.name = std::move(name);
    return candidate;
}

std::string state_line(const Model& model, const std::string& branch, const Equilibrium& state) {
    json bodies = json::object();
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const auto& [r, p] = state.poses[b];
        bodies[model.bodies[b].name] = {{"position", {r.x(), r.y(), r.z()}},
                                        {"orientation", {p.w(), p.x(), p.y(), p.z()}}};
    }
    return json{{"branch", branch}, {"load", state.load}, {"bodies", bodies}}.dump() + "\n";
}

}  // namespace elastocheck::reports
