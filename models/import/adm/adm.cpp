// Imports an ADAMS dataset: combines the parts of adm/.
#include <algorithm>
#include <cmath>

#include "models/import/adm/conversion.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::importer::adm {

const Marker& Conversion::marker(const Statement& s, int id) const {
    const auto found = geometry.markers.find(id);
    if (found == geometry.markers.end()) s.fail("there is no MARKER/{}", id);
    return found->second;
}

const Marker& Conversion::marker(const Statement& s, std::string_view argument) const {
    const int id = s.id_of(argument);
    if (!id) s.fail("{} is missing", argument);
    return marker(s, id);
}

bool Conversion::is_between_two(const Statement& s, const Marker& I, const Marker& J) {
    for (const Marker* m : {&I, &J})
        if (m->floats) s.fail("MARKER/{} is floating and has no position", m->statement->id);
    const bool flexible = is_flexible(I) || is_flexible(J);
    if (flexible)
        miss(s, "it is on a flexible body, which a scene does not have");
    else if (I.part == J.part)
        leave_out(s, "since both ends are on one part");
    return !flexible && I.part != J.part;
}

std::string Conversion::name(Names& names, const Statement& s) const {
    if (!s.name.empty()) return names.take(s.name);
    return names.take(fmt::format("{}_{}", reader::small_letters(s.keyword), s.id));
}

std::string Conversion::point(const Marker& marker) {
    const Statement& s = *marker.statement;
    return draft.points.at(marker.pose.r, s.name.empty() ? fmt::format("marker_{}", s.id) : s.name,
                           s.place());
}

std::string Conversion::origin(int id) {
    const Part& part = geometry.parts.at(id);
    if (part.cm) return point(geometry.markers.at(part.cm));
    return draft.points.at(part.pose.r, body(id), part.statement->place());
}

Value Conversion::function(const std::string& text, double time, std::vector<double>* events) {
    std::vector<int> nested;  // VARIABLEs whose functions are being evaluated
    Context context{.time = time, .drop_friction = options.drop_dynamics, .events = events};
    context.variable = [&](int id) -> Value {
        const auto unknown = [&](const char* why) {
            return Value{.unknown = fmt::format("VARVAL({}): {}", id, why)};
        };
        const auto found = variables.find(id);
        if (found == variables.end()) return unknown("there is no such VARIABLE");
        if (std::ranges::find(nested, id) != nested.end() || nested.size() > 20 ||
            --variables_left < 0)
            return unknown("it depends on itself");
        const auto [function, is_new] = variable_functions.try_emplace(id);
        if (is_new) {
            const Statement& s = *found->second;
            const std::string* given = s.expression("FUNCTION");
            if (given && !s.has("ROUTINE")) function->second = *given;
        }
        if (!function->second) return unknown("a user-written function");
        nested.push_back(id);
        const Value value = static_value(*function->second, context);
        nested.pop_back();
        return value;
    };
    return static_value(text, context);
}

// The extrema are refined by golden-section search between the times next to that of the smallest and
// largest value.
TimeFunction Conversion::time_function(const std::string& text) {
    TimeFunction result{.first = function(text, 0)};
    Value& first = result.first;
    const double start = first.constant;
    result.path = {start};
    result.least = result.most = start;
    if (!first.is_known() || !first.of_time) return result;
    characters_left -= static_cast<double>(text.size()) * static_cast<double>(times.size());
    if (characters_left < 0) {
        first.unknown = "too many functions of TIME";
        return result;
    }
    const auto value_at = [&](double time) {
        const Value value = function(text, time);
        const bool is_same = value.linear == first.linear && value.curves == first.curves;
        if (!value.is_known() && first.is_known()) first = value;
        if (!is_same && first.is_known())
            first.unknown = "a force of displacements that changes with time";
        return value.constant;
    };
    for (std::size_t k = 1; k < times.size() && first.is_known(); ++k)
        result.path.push_back(value_at(times[k]));
    if (!first.is_known()) return result;
    constexpr double golden = 0.381966;  // (3 - √5) / 2
    // sign +1: maximum, -1: minimum
    const auto extremum = [&](double sign, auto found) {
        const auto k = static_cast<std::size_t>(found - result.path.begin());
        double low = times[k == 0 ? 0 : k - 1], high = times[std::min(k + 1, times.size() - 1)],
               best = *found;
        for (int n = 0; n < 50 && first.is_known(); ++n) {
            const double a = low + golden * (high - low), b = high - golden * (high - low);
            const double f_a = value_at(a), f_b = value_at(b);
            best = sign * std::max({sign * best, sign * f_a, sign * f_b});
            if (sign * f_a > sign * f_b)
                high = b;
            else
                low = a;
        }
        return best;
    };
    const auto [least, most] = std::ranges::minmax_element(result.path);
    result.least = extremum(-1, least);
    result.most = extremum(+1, most);
    if (result.most - result.least <=
        1e-12 * std::max(std::abs(result.most), std::abs(result.least))) {
        result.least = result.most = start;
        result.path = {start};
    }
    return result;
}

namespace {

using Eigen::Vector3d;

// "REQUEST (lines 8, 9, ...)": one note for each keyword.
void note_without_effect(Conversion& c, const Statement& s) {
    auto& list = c.draft.notes.omitted["without effect on the mechanism"];
    const auto same = std::ranges::find_if(list, [&](const SourceLocation& place) {
        return place.what.starts_with(fmt::format("{} ", s.keyword));
    });
    if (same == list.end())
        list.push_back({0, fmt::format("{} (lines {})", s.keyword, s.line)});
    else if (same->what.size() < 60)
        same->what.insert(same->what.size() - 1, fmt::format(", {}", s.line));
    else if (!same->what.ends_with("...)"))
        same->what.insert(same->what.size() - 1, ", ...");
}

void note_unconverted(Conversion& c) {
    for (const Statement& s : c.data.statements) {
        const Role role = role_of(s.keyword);
        const reader::Value* equivalent = entry(dataset_table("without_equivalent"), s.keyword);
        if (role == Role::without_effect)
            note_without_effect(c, s);
        else if (role == Role::if_used)
            c.leave_out(s, "used by no force or motion");
        else if (role == Role::friction && c.options.drop_dynamics)
            c.leave_out(s, "by --drop dynamics");
        else if (role == Role::friction)
            c.miss(s,
                   "friction also acts at rest, and a scene has no friction (--drop "
                   "dynamics leaves it out)");
        else if (role == Role::missing)
            c.miss(s, "{}a scene has no equivalent",
                   equivalent ? equivalent->text + ", for which " : "");
    }
}

constexpr std::size_t fine_steps = 1000, max_events = 1000;

// Sets Conversion::times, from 0 to the last event of all functions of TIME, or to one second if
// there is none: the events, the midpoints between them, and equal steps.
void read_times(Conversion& c) {
    std::vector<double> events;
    for (const Statement& s : c.data.statements) {
        if (!s.is("MOTION SFORCE VFORCE VTORQUE GFORCE")) continue;
        for (const char* name : {"FX", "FY", "FZ", "TX", "TY", "TZ", "FUNCTION"})
            if (const std::string* text = s.expression(name)) c.function(*text, 0, &events);
        for (const Argument& argument : *s.arguments) argument.is_read = false;
    }
    const auto sort = [](std::vector<double>& list) {
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    sort(events);
    c.has_events = !events.empty();
    const double end = events.empty() ? 1 / c.geometry.units.second : events.back();
    c.times = {0, end};
    for (std::size_t k = 0; k < events.size(); k += 1 + events.size() / max_events) {
        c.times.push_back(events[k]);
        c.times.push_back(0.5 * (events[k] + (k == 0 ? 0 : events[k - 1])));
    }
    for (std::size_t k = 1; k < fine_steps; ++k)
        c.times.push_back(end * static_cast<double>(k) / fine_steps);
    sort(c.times);
}

// Reports the arguments of converted statements that were not read: as left out if they have no
// influence at rest, else as missing.
void report_unread(Conversion& c) {
    Notes& notes = c.draft.notes;
    std::set<std::pair<int, std::string>> omitted;
    for (const auto& [why, places] : notes.omitted)
        for (const SourceLocation& place : places) omitted.emplace(place.line, place.what);
    std::set<int> missing;
    for (const auto& [place, why] : notes.missing) missing.insert(place.line);
    for (const Statement& s : c.data.statements) {
        if (!s.arguments || missing.contains(s.line) || omitted.contains({s.line, s.place().what}))
            continue;
        std::set<std::string_view> listed;
        for (const Argument& given : *s.arguments) {
            if (given.is_read) continue;
            const std::string& argument = given.name;
            if (s.is("PART") && c.is_ground(s.id)) {
                c.leave_out(s, argument, "since ground is fixed");
                continue;
            }
            // entries: [common name or empty, reason, arguments]
            const auto& list = dataset_table("without_influence").items;
            const auto found = std::ranges::find_if(list, [&](const reader::Value& known) {
                return has_word(known.items[2].text, argument);
            });
            if (found == list.end()) {
                c.miss(s, "{}: not used in combination with the other arguments", argument);
                continue;
            }
            const std::string& name = found->items[0].text;
            const std::string& shown = name.empty() ? argument : name;
            if (listed.insert(shown).second) c.leave_out(s, shown, found->items[1].text);
        }
    }
}

// Checks that every statement that others may refer to has a unique id.
void require_ids(const Dataset& data) {
    std::map<std::pair<std::string_view, int>, int> lines;
    for (const Statement& s : data.statements) {
        if (s.is("UNITS ACCGRAV") || role_of(s.keyword) != Role::converted) continue;
        if (s.id == 0) s.fail("has no id; expected: {}/ID", s.keyword);
        const auto [first, is_new] = lines.try_emplace({s.keyword, s.id}, s.line);
        if (!is_new) s.fail("duplicate id, first in line {}", first->second);
    }
}

void write_bodies(Conversion& c) {
    bool any_mass = false;
    for (const Statement& s : c.data.statements) {
        if (!s.is("PART POINT_MASS")) continue;
        const Part& part = c.geometry.parts.at(s.id);
        if (part.is_ground) continue;
        if (!c.held.contains(s.id)) {
            if (part.mass > 0 && c.draft.gravity)
                c.miss(s, "no joint or element is attached to it, and it has a weight");
            else
                c.leave_out(s, "since nothing is attached to them");
            continue;
        }
        c.count("PART");
        const std::string origin = c.origin(s.id);
        Fields fields;
        fields.add("origin", origin);
        const bool has_mass = part.mass > 0 && (c.draft.gravity || !c.options.drop_dynamics);
        if (has_mass) fields.add("mass", computed(part.mass));
        any_mass |= has_mass;
        c.draft.bodies.push_back({c.body(s.id), fields.braced(), s.place()});
        if (c.options.wheel.empty())
            c.draft.probes.push_back(
                {c.body(s.id), Fields{}.add("on", c.body(s.id)).add("at", origin).braced(), {}});
    }
    if (!any_mass) c.draft.gravity.reset();
    for (const auto& [i, j, entry] : c.dampers) {
        const auto is_held = [&](int part) { return c.is_ground(part) || c.held.contains(part); };
        if (is_held(i) && is_held(j))
            c.draft.dampers.push_back(entry);
        else
            c.draft.notes.leave_out("since nothing is attached to them", entry.from);
    }
}

void read_gravity(Conversion& c) {
    bool found = false;
    for (const Statement& s : c.data.statements) {
        if (!s.is("ACCGRAV")) continue;
        if (std::exchange(found, true)) s.fail("a second one; allowed: one");
        Vector3d g(s.number("IGRAV", 0), s.number("JGRAV", 0), s.number("KGRAV", 0));
        g *= c.geometry.units.metre / (c.geometry.units.second * c.geometry.units.second);
        c.count("ACCGRAV");
        if (!g.isZero(0)) c.draft.gravity = g;
    }
}

// ---- Outputs and branches for the scene.

bool is_named(const Statement& s, const std::string& wanted) {
    return s.name == wanted || std::to_string(s.id) == wanted ||
           capitals(s.name) == capitals(wanted);
}

// The part that --wheel names, or the part of the marker that it names; sets `marker` then.
int wheel_body(Conversion& c, const Marker*& marker) {
    const std::string& wanted = c.options.wheel;
    const auto fail = [&](const std::string& what) { reader::fail(c.file, 0, "--wheel", what); };
    int body = 0;
    std::vector<std::string> known;
    for (const auto& [id, part] : c.geometry.parts) {
        if (part.is_ground) continue;
        known.push_back(c.body(id));
        if (c.body(id) != wanted && !is_named(*part.statement, wanted)) continue;
        if (body) fail(fmt::format("{} names several parts", reader::quote(wanted)));
        body = id;
    }
    if (!body)
        for (const auto& [id, candidate] : c.geometry.markers) {
            if (candidate.floats || !is_named(*candidate.statement, wanted)) continue;
            if (std::exchange(marker, &candidate))
                fail(fmt::format("{} names several markers; give the id of one",
                                 reader::quote(wanted)));
        }
    if (marker) body = marker->part;
    if (!body && !marker)
        fail(fmt::format("there is no part or marker called {}{}", reader::quote(wanted),
                         reader::did_you_mean(wanted, known, "parts")));
    if (!c.geometry.parts.contains(body) || c.is_ground(body) || !c.held.contains(body))
        fail(fmt::format("{} is not on a moving part", reader::quote(wanted)));
    return body;
}

// The wheel: a body, or a marker on it, whose axis closest to y is the spin axis.
void write_wheel(Conversion& c) {
    const Marker* marker = nullptr;
    const int body = wheel_body(c, marker);
    const Part& part = c.geometry.parts.at(body);
    const std::string centre = marker ? c.point(*marker) : c.origin(body);
    const Vector3d position = marker    ? marker->pose.r
                              : part.cm ? c.geometry.markers.at(part.cm).pose.r
                                        : part.pose.r;
    Vector3d axis = Vector3d::UnitY();
    for (int k = 0; marker && k < 3; ++k)
        if (const Vector3d u = marker->axis(k); std::abs(u.y()) > 0.9)
            axis = u.y() > 0 ? u : Vector3d(-u);
    const bool left = position.y() >= 0;
    c.draft.wheels.push_back({"wheel",
                              Fields{}
                                  .add("body", c.body(body))
                                  .add("centre", centre)
                                  .add("spin_axis", direction(left ? axis : Vector3d(-axis)))
                                  .add("side", left ? "left" : "right")
                                  .braced(),
                              (marker ? *marker->statement : *part.statement).place()});
    c.draft.remarks.emplace_back("The file's axes are read as ISO 8855: x forward, y left, z up.");
    const double stroke = 0.06 / c.geometry.units.metre * c.geometry.units.length;
    c.draft.branches.push_back({"travel",
                                fmt::format("{{drive: travel, from: {}, to: {}, steps: 120",
                                            computed(-stroke), computed(stroke)),
                                {}});
}

// Ratio of two drives whose paths are proportional at all times; none if they are not.
std::optional<double> ratio(const Drive& drive, const Drive& first) {
    if (drive.kind != first.kind) return std::nullopt;
    const auto size = [](double x) { return std::abs(x); };
    const auto k = static_cast<std::size_t>(std::ranges::max_element(first.path, {}, size) -
                                            first.path.begin());
    const double r = drive.path[k] / first.path[k],
                 largest = std::max(std::abs(drive.least), std::abs(drive.most));
    for (std::size_t n = 0; n < drive.path.size(); ++n)
        if (!(std::abs(drive.path[n] - r * first.path[n]) <= 1e-9 * largest)) return std::nullopt;
    return r;
}

// Proportional drives, which share a branch.
struct Group {
    const Drive* first = nullptr;
    std::map<const Drive*, double> members = {};  // with their ratios to the first
};

std::vector<Group> groups_of(const std::vector<Drive>& drives) {
    std::vector<Group> groups;
    for (const Drive& drive : drives) {
        if (!drive.moves()) continue;
        const auto joins = [&](Group& group) {
            const auto r = ratio(drive, *group.first);
            if (r) group.members.emplace(&drive, *r);
            return r.has_value();
        };
        if (std::ranges::none_of(groups, joins)) groups.push_back({&drive, {{&drive, 1.0}}});
    }
    return groups;
}

// Whether a motion starts away from the position in the file.
bool starts_displaced(const Conversion& c, const Drive& drive) {
    return drive.kind == Drive::Kind::joint && std::abs(drive.path[0]) > 1e-12 * c.geometry.size;
}

// ", hold: {...}}", the end of a branch's text: motions outside the group keep their positions of time 0.
std::string hold_others(const Conversion& c, const Group& moving) {
    Fields holds;
    for (const Drive& drive : c.drives)
        if (!moving.members.contains(&drive) && starts_displaced(c, drive))
            holds.add(drive.quantity, computed(drive.path[0]));
    return holds.text().empty() ? "}" : fmt::format(", hold: {}}}", holds.braced());
}

// Writes, for a file without drives, a branch of more weight, or without gravity of a force on the first
// part.
void write_branch_of_loads(Conversion& c) {
    Draft& draft = c.draft;
    if (draft.gravity) {
        double mass = 0;
        for (const auto& [id, part] : c.geometry.parts)
            if (c.held.contains(id)) mass += part.mass;
        std::string names;
        for (const auto& [id, part] : c.geometry.parts) {
            if (part.is_ground || !c.held.contains(id) || part.mass == 0) continue;
            const std::string load = c.load_names.take("weight_of_" + c.body(id));
            draft.loads.push_back(
                {load,
                 fmt::format("{{on: {}, at: {}, force: {}}}", c.body(id), c.origin(id),
                             triple(part.mass / mass * draft.gravity->normalized())),
                 {}});
            names += (names.empty() ? "" : ", ") + load;
        }
        const double weight =
            mass * draft.gravity->norm() / (c.geometry.units.force_name == "kN" ? 1000 : 1);
        draft.branches.push_back(
            {"more_weight",
             fmt::format("{{load: [{}], to: {}, steps: 10", names, computed(0.1 * weight)),
             {}});
        draft.remarks.emplace_back(
            "The file has no drives: the branch begins at equilibrium under gravity and "
            "increases the weight by a tenth.");
    } else if (!draft.probes.empty()) {
        std::string place = draft.probes.front().fields;  // "{on: BODY, at: POINT}"
        place.pop_back();
        draft.loads.push_back({"push", place + ", force: [0, 0, 1]}", {}});
        draft.branches.push_back({"push", "{load: push, to: 1, steps: 10", {}});
        draft.remarks.emplace_back(
            "The file has no drives: the branch applies a load to the first part. Replace it by "
            "your own load.");
    }
}

// Writes one branch for each group of proportional motions, or of proportional loads, over their
// whole range on both sides of zero. The other motions are held at their positions at time 0.
void write_drives(Conversion& c) {
    Draft& draft = c.draft;
    const auto groups = groups_of(c.drives);
    Names branch_names;
    std::vector<Entry> branches;
    for (const Group& group : groups) {
        const Drive& first = *group.first;
        const bool is_motion = first.kind == Drive::Kind::joint;
        Fields rates;
        for (const auto& [drive, r] : group.members) rates.add(drive->quantity, computed(r));
        const double least = std::min(0.0, first.least), most = std::max(0.0, first.most);
        const double to = most > 0 ? most : least;
        Fields fields;
        fields.add(is_motion ? "drive" : "load", rates.braced());
        if (most > 0 && least < 0) fields.add("from", computed(least));
        fields.add("to", computed(to)).add("steps", "100");
        branches.push_back({branch_names.take(is_motion ? "motion" : "load"),
                            "{" + fields.text() + hold_others(c, group),
                            {}});
    }
    if (!groups.empty())
        draft.remarks.push_back(
            fmt::format("Functions of TIME are evaluated from 0 to {:g}, {}: a branch covers their "
                        "whole range.",
                        c.times.back(),
                        c.has_events ? "the end of the last STEP or IF"
                                     : "one second, since the dataset has no simulation time"));
    if (groups.size() > 1)
        draft.notes.warn(
            {0, "MOTION, loads"},
            fmt::format("{} of them are not proportional to each other: each has its own branch, "
                        "on which the others keep their value at time 0",
                        groups.size()));
    for (const Drive& drive : c.drives)
        if (starts_displaced(c, drive))
            draft.notes.warn(
                drive.from,
                fmt::format("{}: the file's motion starts {:.4g} from where the parts are drawn{}",
                            drive.quantity, drive.path[0],
                            drive.moves() ? "; its branch begins at the position in the file"
                                          : "; the branches hold it at that position"));
    if (draft.branches.empty() && branches.empty()) write_branch_of_loads(c);
    for (Entry& branch : draft.branches) branch.fields += hold_others(c, {});
    draft.branches.insert(draft.branches.end(), branches.begin(), branches.end());
}

}  // namespace
}  // namespace elastocheck::importer::adm

namespace elastocheck::importer {

Draft import_adm(std::string_view text, const std::string& file, const Options& options) {
    using namespace adm;
    const Dataset data = read_statements(text, file);
    require_ids(data);
    const Geometry geometry = read_geometry(data, file);
    Draft draft;
    // "Adams View model name: sla_front" is called sla_front.
    constexpr std::string_view before_name = "model name:";
    const auto name_at = data.title.find(before_name);
    draft.title =
        name_at == data.title.npos ? data.title : data.title.substr(name_at + before_name.size());
    while (draft.title.starts_with(' ')) draft.title.erase(0, 1);
    if (draft.title.empty()) draft.title = std::filesystem::path(file).stem().string();
    draft.source = file;
    draft.format = "ADAMS dataset";
    draft.points = Hardpoints(geometry.size);
    draft.units = fmt::format("{{length: {}, angle: rad, force: {}}}", geometry.units.length_name,
                              geometry.units.force_name);
    draft.remarks.push_back(geometry.units.remark);
    Conversion c{data, file, geometry, options, draft};
    c.body_names.take("ground");
    for (const Statement& s : data.statements) {
        if (s.is("VARIABLE")) c.variables[s.id] = &s;
        if (s.is("PART POINT_MASS"))
            c.bodies[s.id] = geometry.parts.at(s.id).is_ground ? "ground" : c.name(c.body_names, s);
    }
    draft.notes.understood["MARKER"] = static_cast<int>(geometry.markers.size());
    read_gravity(c);
    note_unconverted(c);
    read_times(c);
    read_splines(c);
    convert_joints(c);
    convert_forces(c);
    write_bodies(c);
    if (!options.wheel.empty()) write_wheel(c);
    write_drives(c);
    report_unread(c);
    if (!data.has_end)
        draft.notes.miss({data.last_line, "END"},
                         "the dataset does not end with END: it may be truncated");
    return draft;
}

}  // namespace elastocheck::importer
