// Imports an ADAMS dataset: combines the parts of adm/.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "models/import/adm/conversion.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::importer::adm {

const Marker& Conversion::marker(const Arguments& at, int id) const {
    const auto found = geometry.markers.find(id);
    if (found == geometry.markers.end()) at.fail(fmt::format("there is no MARKER/{}", id));
    return found->second;
}

const Marker& Conversion::marker(const Arguments& at, std::string_view name) const {
    const int id = at.id(name);
    if (!id) at.fail(fmt::format("{} is missing", name));
    return marker(at, id);
}

bool is_between_two(Conversion& c, const Statement& s, const Marker& I, const Marker& J,
                    const Arguments& at) {
    for (const Marker* m : {&I, &J})
        if (m->floats)
            at.fail(fmt::format("MARKER/{} is floating and has no position", m->statement->id));
    for (const Marker* m : {&I, &J})
        if (c.is_flexible(*m)) {
            c.miss(s, "it is on a flexible body, which a scene does not have");
            return false;
        }
    if (I.part != J.part) return true;
    c.leave_out(s, "since both ends are on one part");
    return false;
}

std::string Conversion::name(Names& names, const Statement& statement) const {
    if (!statement.name.empty()) return names.take(statement.name);
    return names.take(fmt::format("{}_{}", reader::small_letters(statement.keyword), statement.id));
}

std::string Conversion::point(const Marker& marker) {
    const Statement& s = *marker.statement;
    return draft.points.at(marker.pose.r, s.name.empty() ? fmt::format("marker_{}", s.id) : s.name,
                           s.place());
}

Value Conversion::function(const std::string& text, double time, std::vector<double>* events) {
    std::vector<int> open;  // VARIABLEs within VARIABLEs
    Context context;
    context.time = time;
    context.drop_friction = options.drop_dynamics;
    context.events = events;
    context.variable = [&](int id) {
        Value unknown;
        const auto found = variables.find(id);
        if (found == variables.end()) {
            unknown.unknown = fmt::format("VARVAL({}): there is no such VARIABLE", id);
            return unknown;
        }
        if (std::ranges::find(open, id) != open.end() || open.size() > 20 || --variables_left < 0) {
            unknown.unknown = fmt::format("VARVAL({}): it depends on itself", id);
            return unknown;
        }
        const auto [function, is_new] = variable_functions.try_emplace(id);
        if (is_new) {
            static const Shape shape{{}, {"IC", "ROUTINE", "AUTOSCALE"}, {"FUNCTION"}};
            const Arguments at(data.file, *found->second, shape);
            const std::string* given = at.expression("FUNCTION");
            if (given && !at.has("ROUTINE")) function->second = *given;
        }
        if (!function->second) {
            unknown.unknown = fmt::format("VARVAL({}): a user-written function", id);
            return unknown;
        }
        open.push_back(id);
        const Value value = static_value(*function->second, context);
        open.pop_back();
        return value;
    };
    return static_value(text, context);
}

// Evaluates the FUNCTION at every time. The smallest and largest values are refined by golden
// section search between the two neighbouring times.
Programme Conversion::programme(const std::string& text) {
    Programme result{.first = function(text, 0)};
    const double start = result.first.constant;
    result.path = {start};
    result.least = result.most = start;
    if (!result.first.is_known() || !result.first.of_time) return result;
    characters_left -= static_cast<double>(text.size()) * static_cast<double>(times.size());
    if (characters_left < 0) {
        result.first.unknown = "too many functions of TIME";
        return result;
    }
    const auto at = [&](double time) {
        const Value value = function(text, time);
        if (!value.is_known() && result.first.is_known()) result.first = value;
        if (value.is_known() &&
            (value.linear != result.first.linear || value.curves != result.first.curves) &&
            result.first.is_known())
            result.first.unknown = "a force of displacements that changes with time";
        return value.constant;
    };
    for (std::size_t k = 1; k < times.size() && result.first.is_known(); ++k)
        result.path.push_back(at(times[k]));
    if (!result.first.is_known()) return result;
    const auto extremum = [&](double sign, auto found) {
        const auto k = static_cast<std::size_t>(found - result.path.begin());
        double low = times[k == 0 ? 0 : k - 1], high = times[std::min(k + 1, times.size() - 1)],
               best = *found;
        for (int n = 0; n < 50 && result.first.is_known(); ++n) {
            const double a = low + 0.381966 * (high - low), b = high - 0.381966 * (high - low);
            const double f_a = at(a), f_b = at(b);
            best = sign * std::max({sign * best, sign * f_a, sign * f_b});
            (sign * f_a > sign * f_b ? high : low) = sign * f_a > sign * f_b ? b : a;
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

constexpr std::string_view converted[] = {
    "JOINT",      "JPRIM",        "GCON",   "COUPLER", "MOTION",  "BUSHING", "FIELD",
    "BEAM",       "SPRINGDAMPER", "SFORCE", "VFORCE",  "VTORQUE", "GFORCE",  "PART",
    "POINT_MASS", "MARKER",       "UNITS",  "ACCGRAV", "SPLINE"};
// Keywords without effect in statics (graphics, results, solver settings), then keywords with an
// effect only through a force or motion that uses them.
constexpr std::string_view told_nothing[] = {
    "GRAPHICS",   "REQUEST", "OUTPUT", "RESULTS",  "PREFERENCES", "INTEGRATOR", "EQUILIBRIUM",
    "KINEMATICS", "DEBUG",   "STRING", "MATERIAL", "ADAMS",       "IC",         "LSSOLVER",
    "LIST",       "INFO",    "SOLVER", "LINEAR",   "EXECUTION"};
constexpr std::string_view used_or_not[] = {
    "VARIABLE", "ARRAY",  "DIFF",   "LSE",     "GSE",     "TFSISO", "MATRIX",  "CURVE",
    "SURFACE",  "SENSOR", "PINPUT", "POUTPUT", "CONTROL", "COSIM",  "SECTION", "FE_NODE"};
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> no_place{{
    {"CONTACT", "a contact between parts"},
    {"PTCV", "a point on a curve"},
    {"CVCV", "a curve on a curve"},
    {"PTSF", "a point on a surface"},
    {"UCON", "a user-written constraint"},
    {"GEAR", "a gear"},
    {"FLEX_BODY", "a flexible body"},
    {"FE_PART", "a finite-element part"},
    {"FE_LOAD", "a load on a finite-element part"},
    {"NFORCE", "a force between many markers"},
    {"MFORCE", "a modal force"},
    {"TIRE", "a user-written tyre"},
    {"WHEEL", "a user-written wheel"},
    {"INCLUDE", "another file"},
    {"DEACTIVATE", "a deactivated statement: remove both the statement and its deactivation"},
    {"MODE", "a switch"},
}};

template <class List>
bool is_in(const List& list, std::string_view word) {
    return std::ranges::find(list, word) != std::end(list);
}

// Notes every statement that is not converted.
void sort_out(Conversion& c) {
    Notes& notes = c.draft.notes;
    for (const Statement& s : c.data.statements) {
        const std::string& word = s.keyword;
        if (is_in(converted, word)) continue;
        if (is_in(told_nothing, word)) {
            notes.omitted.try_emplace("without effect on the mechanism");
            auto& list = notes.omitted["without effect on the mechanism"];
            const auto same = std::ranges::find_if(
                list, [&](const SourceLocation& p) { return p.what.starts_with(word + " "); });
            if (same == list.end())
                list.push_back({0, word + " (lines " + std::to_string(s.line) + ")"});
            else if (same->what.size() < 60)
                same->what.insert(same->what.size() - 1, ", " + std::to_string(s.line));
            else if (!same->what.ends_with("...)"))
                same->what.insert(same->what.size() - 1, ", ...");
            continue;
        }
        if (is_in(used_or_not, word)) {
            c.leave_out(s, "used by no force or motion");
            continue;
        }
        if (word == "FRICTION") {
            if (c.options.drop_dynamics)
                c.leave_out(s, "by --drop dynamics");
            else
                c.miss(s,
                       "friction also acts at rest, and a scene has no friction (--drop "
                       "dynamics leaves it out)");
            continue;
        }
        const auto found = std::ranges::find(no_place, word,
                                             &std::pair<std::string_view, std::string_view>::first);
        c.miss(s, found == no_place.end()
                      ? "a scene has no equivalent"
                      : fmt::format("{}, for which a scene has no equivalent", found->second));
    }
}

constexpr std::size_t fine_steps = 1000, most_events = 1000;

// Sets Conversion::times, from 0 to the last event of all functions of TIME, or to one second if
// there is none: the events, the midpoints between them, and equal steps.
void read_times(Conversion& c) {
    std::vector<double> events;
    for (const Statement& s : c.data.statements) {
        const bool is_vector =
            s.keyword == "VFORCE" || s.keyword == "VTORQUE" || s.keyword == "GFORCE";
        const Shape* shape = s.keyword == "MOTION"   ? &motion_shape()
                             : s.keyword == "SFORCE" ? &sforce_shape()
                             : is_vector             ? &vector_shape()
                                                     : nullptr;
        if (!shape) continue;
        const Arguments at(c.data.file, s, *shape);
        for (const std::string_view name : shape->expressions)
            if (const std::string* text = at.expression(name)) c.function(*text, 0, &events);
        s.arguments.clear();  // this access does not count as use of the arguments
    }
    std::ranges::sort(events);
    events.erase(std::unique(events.begin(), events.end()), events.end());
    c.has_events = !events.empty();
    const double end = events.empty() ? 1 / c.geometry.units.second : events.back();
    c.times = {0, end};
    for (std::size_t k = 0; k < events.size(); k += 1 + events.size() / most_events) {
        c.times.push_back(events[k]);
        c.times.push_back(0.5 * (events[k] + (k == 0 ? 0 : events[k - 1])));
    }
    for (std::size_t k = 1; k < fine_steps; ++k)
        c.times.push_back(end * static_cast<double>(k) / fine_steps);
    std::ranges::sort(c.times);
    c.times.erase(std::unique(c.times.begin(), c.times.end()), c.times.end());
}

// Arguments that have no influence at rest, by their name in any statement.
struct WithoutInfluence {
    std::string_view called;  // empty: by its name
    std::string_view why;
    std::vector<std::string_view> arguments;
};
const WithoutInfluence without_influence[] = {
    {"damping", "without effect at rest", {"C", "CT", "CMATRIX", "CRATIO"}},
    {"inertia", "inertia, without effect at rest", {"IM", "IP"}},
    {"initial velocity",
     "without effect at rest",
     {"VX", "VY", "VZ", "WX", "WY", "WZ", "VM", "WM", "VELOCITY"}},
    {"", "without effect at rest", {"IC", "ICTRAN", "ICROT", "ICDISP", "ICVEL"}},
    {"", "used only for the assembly", {"EXACT"}},
    {"", "determined by the joints", {"TYPE"}},
    {"", "only for flexible bodies", {"NODE_ID", "NODE_LABEL"}}};

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
        if (missing.contains(s.line) || omitted.contains({s.line, s.place().what})) continue;
        std::set<std::string_view> listed;
        for (const auto& [argument, is_read] : s.arguments) {
            if (is_read) continue;
            if (s.keyword == "PART" && c.is_ground(s.id)) {
                notes.leave_out("since ground is fixed",
                                {s.line, std::string(argument) + " of " + s.place().what});
                continue;
            }
            const auto known =
                std::ranges::find_if(without_influence, [&argument = argument](const auto& some) {
                    return is_in(some.arguments, argument);
                });
            if (known == std::end(without_influence)) {
                c.miss(s, fmt::format("{}: not used in combination with the other arguments",
                                      argument));
                continue;
            }
            const std::string_view called = known->called.empty() ? argument : known->called;
            if (listed.insert(called).second)
                c.leave_out(s, std::string(called), std::string(known->why));
        }
    }
}

// Checks that every statement that others may refer to has a unique id, and that the file ends with
// END.
void require_ids(const Dataset& data) {
    std::map<std::pair<std::string_view, int>, int> lines;
    for (const Statement& s : data.statements) {
        if (s.keyword == "UNITS" || s.keyword == "ACCGRAV" || !is_in(converted, s.keyword))
            continue;
        if (s.id == 0) fail(data.file, s, "has no id");
        const auto [first, is_new] = lines.try_emplace({s.keyword, s.id}, s.line);
        if (!is_new)
            fail(data.file, s, fmt::format("duplicate id, first in line {}", first->second));
    }
}

void name_bodies(Conversion& c) {
    c.body_names.take("ground");
    for (const Statement& s : c.data.statements) {
        if (s.keyword != "PART" && s.keyword != "POINT_MASS") continue;
        c.bodies[s.id] = c.geometry.parts.at(s.id).is_ground ? "ground" : c.name(c.body_names, s);
    }
}

std::string origin(Conversion& c, int id, const Part& part) {
    if (part.cm) return c.point(c.geometry.markers.at(part.cm));
    return c.draft.points.at(part.pose.r, c.body(id), part.statement->place());
}

void write_bodies(Conversion& c) {
    bool any_mass = false;
    for (const Statement& s : c.data.statements) {
        if (s.keyword != "PART" && s.keyword != "POINT_MASS") continue;
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
        Fields fields;
        fields.add("origin", origin(c, s.id, part));
        const bool heavy = part.mass > 0 && (c.draft.gravity || !c.options.drop_dynamics);
        if (heavy) fields.add("mass", computed(part.mass));
        any_mass |= heavy;
        c.draft.bodies.push_back({c.body(s.id), fields.braced(), s.place()});
    }
    if (!any_mass) c.draft.gravity.reset();
    std::set<std::string> there{"ground"};
    for (const Entry& body : c.draft.bodies) there.insert(body.name);
    // A damper does not hold a part at rest; it is kept if both its parts exist.
    std::erase_if(c.draft.dampers, [&](const Entry& damper) {
        const auto begin = damper.fields.find('[') + 1, comma = damper.fields.find(", ", begin);
        const std::string names[] = {
            damper.fields.substr(begin, comma - begin),
            damper.fields.substr(comma + 2, damper.fields.find(']') - comma - 2)};
        if (there.contains(names[0]) && there.contains(names[1])) return false;
        c.draft.notes.leave_out("since nothing is attached to them", damper.from);
        return true;
    });
}

void read_gravity(Conversion& c) {
    static const Shape shape{{}, {"IGRAV", "JGRAV", "KGRAV"}, {}};
    bool found = false;
    for (const Statement& s : c.data.statements) {
        if (s.keyword != "ACCGRAV") continue;
        const Arguments at(c.data.file, s, shape);
        if (std::exchange(found, true)) at.fail("a second one; allowed: one");
        Vector3d g(at.number("IGRAV", 0), at.number("JGRAV", 0), at.number("KGRAV", 0));
        g *= c.geometry.units.metre / (c.geometry.units.second * c.geometry.units.second);
        c.count("ACCGRAV");
        if (!g.isZero(0)) c.draft.gravity = g;
    }
}

// ---- Outputs and a branch for the scene.

bool is_called(const Statement& s, const std::string& wanted) {
    return s.name == wanted || fmt::format("{}", s.id) == wanted ||
           capitals(s.name) == capitals(wanted);
}

// The wheel: a body, or a marker on it, whose axis closest to y is the spin axis.
void write_wheel(Conversion& c) {
    const std::string& wanted = c.options.wheel;
    const auto fail = [&](const std::string& what) {
        reader::fail(c.data.file, 0, "--wheel", what);
    };
    int body = 0;
    const Marker* marker = nullptr;
    std::vector<std::string> known;
    for (const auto& [id, part] : c.geometry.parts) {
        if (part.is_ground) continue;
        known.push_back(c.body(id));
        if (c.body(id) != wanted && !is_called(*part.statement, wanted)) continue;
        if (body) fail(fmt::format("{} names several parts", reader::quote(wanted)));
        body = id;
    }
    if (!body)
        for (const auto& [id, candidate] : c.geometry.markers)
            if (!candidate.floats && is_called(*candidate.statement, wanted)) {
                if (marker)
                    fail(fmt::format("{} names several markers; give the id of one",
                                     reader::quote(wanted)));
                marker = &candidate;
                body = candidate.part;
            }
    if (!body && !marker)
        fail(fmt::format("there is no part or marker called {}{}", reader::quote(wanted),
                         reader::did_you_mean(wanted, known, "parts")));
    if (!c.geometry.parts.contains(body) || c.is_ground(body) || !c.held.contains(body))
        fail(fmt::format("{} is not on a moving part", reader::quote(wanted)));
    const Part& part = c.geometry.parts.at(body);
    const Statement& s = marker ? *marker->statement : *part.statement;
    const std::string centre = marker ? c.point(*marker) : origin(c, body, part);
    const Vector3d position = marker    ? marker->pose.r
                              : part.cm ? c.geometry.markers.at(part.cm).pose.r
                                        : part.pose.r;
    Vector3d axis = Vector3d::UnitY();
    if (marker)
        for (int k = 0; k < 3; ++k)
            if (const Vector3d u = marker->pose.A.col(k); std::abs(u.y()) > 0.9)
                axis = u.y() > 0 ? u : Vector3d(-u);
    const bool left = position.y() >= 0;
    if (!left) axis = -axis;
    c.draft.wheels.push_back({"wheel",
                              "{" +
                                  Fields{}
                                      .add("body", c.body(body))
                                      .add("centre", centre)
                                      .add("spin_axis", direction(axis))
                                      .add("side", left ? "left" : "right")
                                      .text() +
                                  "}",
                              s.place()});
    c.draft.remarks.emplace_back("The file's axes are read as ISO 8855: x forward, y left, z up.");
    const double stroke = 0.06 / c.geometry.units.metre * c.geometry.units.length;
    const std::string range =
        fmt::format(", from: {}, to: {}, steps: 120", computed(-stroke), computed(stroke));
    c.draft.branches.push_back({"travel", "{drive: travel" + range, {}});
}

// Probes on every part. write_drives() below adds a branch with the motions of the file; without
// motions, one with added weight or a unit force.
void write_probes(Conversion& c) {
    for (const Entry& body : c.draft.bodies) {
        const std::string_view fields = body.fields;
        const auto begin = std::string_view("{origin: ").size();
        c.draft.probes.push_back(
            {body.name,
             fmt::format("{{on: {}, at: {}}}", body.name,
                         fields.substr(begin, fields.find_first_of(",}") - begin)),
             {}});
    }
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

// Writes one branch for each group of proportional motions, or of proportional loads, over their
// whole range on both sides of zero. The other motions are held at their positions at time 0.
void write_drives(Conversion& c) {
    struct Group {
        const Drive* first;
        std::vector<std::pair<const Drive*, double>> members;
    };
    std::vector<Group> groups;
    for (const Drive& drive : c.drives) {
        if (!drive.moves()) continue;
        const auto joins = [&](Group& group) {
            const auto r = ratio(drive, *group.first);
            if (r) group.members.emplace_back(&drive, *r);
            return r.has_value();
        };
        if (std::ranges::none_of(groups, joins)) groups.push_back({&drive, {{&drive, 1.0}}});
    }
    const double at_rest = 1e-12;
    const auto stands = [&](const Drive& drive) {
        return drive.kind == Drive::Kind::joint &&
               std::abs(drive.path[0]) > at_rest * c.geometry.size;
    };
    const auto held = [&](const Group* moving) {
        std::string holds;
        for (const Drive& drive : c.drives) {
            const bool is_moving =
                moving &&
                std::ranges::find(moving->members, &drive,
                                  &std::pair<const Drive*, double>::first) != moving->members.end();
            if (!is_moving && stands(drive))
                holds += fmt::format("{}{}: {}", holds.empty() ? "" : ", ", drive.quantity,
                                     computed(drive.path[0]));
        }
        return holds.empty() ? std::string("}") : fmt::format(", hold: {{{}}}}}", holds);
    };
    for (Entry& branch : c.draft.branches) branch.fields += held(nullptr);
    Names branch_names;
    for (const Group& group : groups) {
        const Drive& first = *group.first;
        const bool is_motion = first.kind == Drive::Kind::joint;
        std::string rates;
        for (const auto& [drive, r] : group.members)
            rates +=
                fmt::format("{}{}: {}", rates.empty() ? "" : ", ", drive->quantity, computed(r));
        const double least = std::min(0.0, first.least), most = std::max(0.0, first.most);
        const double to = most > 0 ? most : least;
        const std::string from =
            most > 0 && least < 0 ? fmt::format("from: {}, ", computed(least)) : "";
        c.draft.branches.push_back(
            {branch_names.take(is_motion ? "motion" : "load"),
             fmt::format("{{{}: {{{}}}, {}to: {}, steps: 100{}", is_motion ? "drive" : "load",
                         rates, from, computed(to), held(&group)),
             {}});
    }
    if (!groups.empty())
        c.draft.remarks.push_back(
            fmt::format("Functions of TIME are evaluated from 0 to {:g}, {}: a branch covers their "
                        "whole range.",
                        c.times.back(),
                        c.has_events ? "the end of the last STEP or IF"
                                     : "one second, since the dataset has no simulation time"));
    if (groups.size() > 1)
        c.draft.notes.warn(
            {0, "MOTION, loads"},
            fmt::format("{} of them are not proportional to each other: each has its own branch, "
                        "on which the others keep their value at time 0",
                        groups.size()));
    for (const Drive& drive : c.drives)
        if (stands(drive))
            c.draft.notes.warn(
                drive.from,
                fmt::format("{}: the file's motion starts {:.4g} from where the parts are drawn{}",
                            drive.quantity, drive.path[0],
                            drive.moves() ? "; its branch begins at the position in the file"
                                          : "; the branches hold it at that position"));
    if (c.draft.branches.empty()) {
        if (c.draft.gravity) {
            double mass = 0;
            for (const auto& [id, part] : c.geometry.parts)
                if (c.held.contains(id)) mass += part.mass;
            std::string names;
            for (const auto& [id, part] : c.geometry.parts) {
                if (part.is_ground || !c.held.contains(id) || part.mass == 0) continue;
                const std::string load = c.load_names.take("weight_of_" + c.body(id));
                c.draft.loads.push_back(
                    {load,
                     fmt::format("{{on: {}, at: {}, force: {}}}", c.body(id), origin(c, id, part),
                                 triple(part.mass / mass * c.draft.gravity->normalized())),
                     {}});
                names += (names.empty() ? "" : ", ") + load;
            }
            const double weight =
                mass * c.draft.gravity->norm() / (c.geometry.units.force_name == "kN" ? 1000 : 1);
            c.draft.branches.push_back(
                {"more_weight",
                 fmt::format("{{load: [{}], to: {}, steps: 10", names, computed(0.1 * weight)),
                 {}});
            c.draft.remarks.emplace_back(
                "The file has no drives: the branch begins at equilibrium under gravity and "
                "increases the weight by a tenth.");
        } else if (!c.draft.bodies.empty()) {
            const auto& [name, fields, from] =
                c.draft.probes.empty() ? c.draft.bodies.front() : c.draft.probes.front();
            const auto at = fields.rfind(": ") + 2;
            c.draft.loads.push_back({"push",
                                     fmt::format("{{on: {}, at: {}, force: [0, 0, 1]}}", name,
                                                 fields.substr(at, fields.size() - 1 - at)),
                                     {}});
            c.draft.branches.push_back({"push", "{load: push, to: 1, steps: 10", {}});
            c.draft.remarks.emplace_back(
                "The file has no drives: the branch applies a load to the first part. Replace it "
                "by your own load.");
        }
    }
    if (groups.empty() && c.options.wheel.empty())
        for (Entry& branch : c.draft.branches) branch.fields += held(nullptr);
}

}  // namespace
}  // namespace elastocheck::importer::adm

namespace elastocheck::importer {

Draft import_adm(std::string_view text, const std::string& file, const Options& options) {
    using namespace adm;
    const Dataset data = read_statements(text, file);
    require_ids(data);
    const Geometry geometry = read_geometry(data);
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
    Conversion c{data, geometry, options, draft};
    name_bodies(c);
    for (const Statement& s : data.statements)
        if (s.keyword == "VARIABLE") c.variables[s.id] = &s;
    draft.notes.understood["MARKER"] = static_cast<int>(geometry.markers.size());
    read_gravity(c);
    sort_out(c);
    read_times(c);
    read_splines(c);
    convert_joints(c);
    convert_forces(c);
    write_bodies(c);
    if (options.wheel.empty())
        write_probes(c);
    else
        write_wheel(c);
    write_drives(c);
    report_unread(c);
    if (!data.has_end)
        draft.notes.miss({data.last_line, "END"},
                         "the dataset does not end with END: it may be truncated");
    return draft;
}

}  // namespace elastocheck::importer
