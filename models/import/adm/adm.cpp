// ADAMS datasets: what is said in adm/ put together.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "models/import/adm/conversion.hpp"
#include "models/reader/words.hpp"
#include "models/reader/yaml.hpp"

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
        if (m->floats) at.fail(fmt::format("MARKER/{} floats, and so is nowhere", m->statement->id));
    for (const Marker* m : {&I, &J})
        if (c.is_flexible(*m)) {
            c.draft.notes.miss(s.place(), "it is on a flexible body, which is missing");
            return false;
        }
    if (I.part != J.part) return true;
    c.draft.notes.leave_out("as both ends are on one part", s.place());
    return false;
}

std::string Conversion::name(Names& names, const Statement& statement) const {
    if (!statement.name.empty()) return names.take(statement.name);
    std::string word = statement.keyword;
    for (char& letter : word)
        letter = static_cast<char>(letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter);
    return names.take(fmt::format("{}_{}", word, statement.id));
}

std::string Conversion::point(const Marker& marker) {
    const Statement& s = *marker.statement;
    return draft.points.at(marker.pose.r, s.name.empty() ? fmt::format("marker_{}", s.id) : s.name,
                           s.place());
}

Value Conversion::function(const std::string& text, double time) {
    std::vector<int> open;  // VARIABLEs within VARIABLEs
    Context context;
    context.time = time;
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
        static const Shape shape{{}, {"IC", "ROUTINE", "AUTOSCALE"}, {"FUNCTION"}};
        const Arguments at(data.file, *found->second, shape);
        const std::string* function = at.expression("FUNCTION");
        if (!function || at.has("ROUTINE")) {
            unknown.unknown = fmt::format("VARVAL({}): a function of the user's", id);
            return unknown;
        }
        open.push_back(id);
        const Value value = evaluate(*function, context);
        open.pop_back();
        return value;
    };
    return evaluate(text, context);
}

namespace {

using Eigen::Vector3d;

constexpr std::string_view converted[] = {"JOINT",   "JPRIM",   "GCON",    "COUPLER",      "MOTION",
                                          "BUSHING", "FIELD",   "BEAM",    "SPRINGDAMPER", "SFORCE",
                                          "VFORCE",  "VTORQUE", "GFORCE",  "PART",         "POINT_MASS",
                                          "MARKER",  "UNITS",   "ACCGRAV", "SPLINE"};
// Pictures, results, settings of a solver, and what only a force or a motion that uses it gives a meaning.
constexpr std::string_view told_nothing[] = {
    "GRAPHICS",   "REQUEST", "OUTPUT", "RESULTS",  "PREFERENCES", "INTEGRATOR", "EQUILIBRIUM",
    "KINEMATICS", "DEBUG",   "STRING", "MATERIAL", "ADAMS",       "IC",         "LSSOLVER",
    "LIST",       "INFO",    "SOLVER", "LINEAR",   "EXECUTION"};
constexpr std::string_view used_or_not[] = {"VARIABLE", "ARRAY", "DIFF",    "LSE",    "GSE",    "TFSISO",
                                            "MATRIX",   "CURVE", "SURFACE", "SENSOR", "PINPUT", "POUTPUT",
                                            "CONTROL",  "COSIM", "SECTION", "FE_NODE"};
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> no_place{{
    {"CONTACT", "a contact between parts"},
    {"PTCV", "a point on a curve"},
    {"CVCV", "a curve on a curve"},
    {"PTSF", "a point on a surface"},
    {"UCON", "a constraint of the user's"},
    {"GEAR", "a gear"},
    {"FLEX_BODY", "a flexible body"},
    {"FE_PART", "a part of finite elements"},
    {"FE_LOAD", "a load on a part of finite elements"},
    {"NFORCE", "a force between many markers"},
    {"MFORCE", "a modal force"},
    {"TIRE", "a tyre of the user's"},
    {"WHEEL", "a wheel of the user's"},
    {"INCLUDE", "another file"},
    {"DEACTIVATE", "a statement that is switched off: leave out both"},
    {"MODE", "a switch"},
}};

template <class List>
bool is_in(const List& list, std::string_view word) {
    return std::ranges::find(list, word) != std::end(list);
}

// Everything that is not converted says so.
void sort_out(Conversion& c) {
    Notes& notes = c.draft.notes;
    for (const Statement& s : c.data.statements) {
        const std::string& word = s.keyword;
        if (is_in(converted, word)) continue;
        if (is_in(told_nothing, word)) {
            notes.left_out.try_emplace("saying nothing of the mechanism");
            auto& list = notes.left_out["saying nothing of the mechanism"];
            const auto same =
                std::ranges::find_if(list, [&](const Place& p) { return p.what.starts_with(word + " "); });
            if (same == list.end())
                list.push_back({0, word + " (lines " + std::to_string(s.line) + ")"});
            else if (same->what.size() < 60)
                same->what.insert(same->what.size() - 1, ", " + std::to_string(s.line));
            else if (!same->what.ends_with("...)"))
                same->what.insert(same->what.size() - 1, ", ...");
            continue;
        }
        if (is_in(used_or_not, word)) {
            notes.leave_out("having a meaning only where a force or a motion uses it", s.place());
            continue;
        }
        if (word == "FRICTION") {
            if (c.options.drop_dynamics)
                notes.leave_out("by --drop dynamics", s.place());
            else
                notes.miss(s.place(),
                           "friction holds, too, and a scene has none (--drop dynamics leaves it out)");
            continue;
        }
        const auto found =
            std::ranges::find(no_place, word, &std::pair<std::string_view, std::string_view>::first);
        notes.miss(s.place(), found == no_place.end()
                                  ? "it has no place in a scene"
                                  : fmt::format("{}, which has no place in a scene", found->second));
    }
}

// The end of the programme: of the latest STEP in TIME, else one second.
double last_event(const Conversion& c) {
    double last = 0;
    for (const Statement& s : c.data.statements) {
        if (s.keyword == "REQUEST" || s.keyword == "GRAPHICS") continue;
        std::string text;
        for (const char letter : capitals(s.rest))
            if (letter != ' ' && letter != '\n' && letter != '\t') text += letter;
        for (auto at = text.find("STEP(TIME,"); at != text.npos; at = text.find("STEP(TIME,", at + 1)) {
            std::string_view rest = std::string_view(text).substr(at + 10);
            std::array<double, 3> numbers{};  // x0, h0, x1
            bool fine = true;
            for (double& x : numbers) {
                bool degrees = false;
                const std::size_t n = number_at(rest, x, degrees);
                fine = fine && n > 0 && n < rest.size() && rest[n] == ',';
                if (!fine) break;
                rest.remove_prefix(n + 1);
            }
            if (fine) last = std::max(last, numbers[2]);
        }
    }
    return last > 0 ? last : 1 / c.geometry.units.second;
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
                c.draft.notes.miss(s.place(), "nothing in the scene holds it, and its weight pulls it away");
            else
                c.draft.notes.leave_out("as nothing is attached to them", s.place());
            continue;
        }
        c.draft.notes.count("PART");
        Fields fields;
        fields.add("origin", origin(c, s.id, part));
        const bool heavy = part.mass > 0 && (c.draft.gravity || !c.options.drop_dynamics);
        if (heavy) fields.add("mass", computed(part.mass));
        any_mass |= heavy;
        c.draft.bodies.push_back({c.body(s.id), "{" + fields.text() + "}", s.place()});
    }
    if (!any_mass) c.draft.gravity.reset();
    std::set<std::string> there{"ground"};
    for (const Entry& body : c.draft.bodies) there.insert(body.name);
    // A damper holds nothing, and is measured where both its parts are there.
    std::erase_if(c.draft.dampers, [&](const Entry& damper) {
        const auto begin = damper.fields.find('[') + 1, comma = damper.fields.find(", ", begin);
        const std::string names[] = {damper.fields.substr(begin, comma - begin),
                                     damper.fields.substr(comma + 2, damper.fields.find(']') - comma - 2)};
        if (there.contains(names[0]) && there.contains(names[1])) return false;
        c.draft.notes.leave_out("as nothing is attached to them", damper.from);
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
        c.draft.notes.count("ACCGRAV");
        if (!g.isZero(0)) c.draft.gravity = g;
    }
}

// ---- What is asked of the scene: outputs, and a branch.

bool is_called(const Statement& s, const std::string& wanted) {
    return s.name == wanted || fmt::format("{}", s.id) == wanted || capitals(s.name) == capitals(wanted);
}

// The wheel: a body, or a marker on it, whose axis nearest to y is the spin axis.
void write_wheel(Conversion& c) {
    const std::string& wanted = c.options.wheel;
    const Part* part = nullptr;
    const Marker* marker = nullptr;
    std::vector<std::string> known;
    for (const auto& [id, candidate] : c.geometry.parts) {
        if (candidate.is_ground) continue;
        known.push_back(c.body(id));
        if (c.body(id) == wanted || is_called(*candidate.statement, wanted)) {
            if (part)
                reader::fail(c.data.file, 0, "--wheel",
                             fmt::format("{} are several parts", reader::quote(wanted)));
            part = &candidate;
        }
    }
    if (!part)
        for (const auto& [id, candidate] : c.geometry.markers)
            if (!candidate.floats && is_called(*candidate.statement, wanted)) {
                if (marker)
                    reader::fail(
                        c.data.file, 0, "--wheel",
                        fmt::format("{} are several markers; name one by its id", reader::quote(wanted)));
                marker = &candidate;
            }
    if (!part && !marker)
        reader::fail(c.data.file, 0, "--wheel",
                     fmt::format("there is neither a part nor a marker called {}{}", reader::quote(wanted),
                                 reader::did_you_mean(wanted, known, "parts")));
    int body = 0;
    for (const auto& [id, candidate] : c.geometry.parts)
        if (&candidate == part) body = id;
    if (marker) body = marker->part;
    if (!c.geometry.parts.contains(body) || c.is_ground(body) || !c.held.contains(body))
        reader::fail(c.data.file, 0, "--wheel",
                     fmt::format("{} is not on a part that moves", reader::quote(wanted)));
    const Statement& s = marker ? *marker->statement : *part->statement;
    const std::string centre = marker ? c.point(*marker) : origin(c, body, *part);
    const Vector3d position = marker     ? marker->pose.r
                              : part->cm ? c.geometry.markers.at(part->cm).pose.r
                                         : part->pose.r;
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

// Where every part is. Where the file has no motion: what its weight does, or a push.
void write_probes(Conversion& c) {
    for (const Entry& body : c.draft.bodies) {
        const std::string_view fields = body.fields;
        const auto begin = std::string_view("{origin: ").size();
        c.draft.probes.push_back({body.name,
                                  fmt::format("{{on: {}, at: {}}}", body.name,
                                              fields.substr(begin, fields.find_first_of(",}") - begin)),
                                  {}});
    }
}

void write_drives(Conversion& c) {
    std::string rates, holds;
    double first = 0;
    for (const Drive& drive : c.drives) {
        if (drive.moves()) {
            if (drive.start != 0 && drive.end == 0) continue;
            const double change = drive.end - (std::abs(drive.start) > 0 ? 0 : drive.start);
            if (first == 0) first = change;
            rates +=
                fmt::format("{}{}: {}", rates.empty() ? "" : ", ", drive.quantity, computed(change / first));
        } else if (drive.start != 0) {
            holds +=
                fmt::format("{}{}: {}", holds.empty() ? "" : ", ", drive.quantity, computed(drive.start));
        }
    }
    if (!rates.empty())
        c.draft.branches.push_back(
            {"motion", fmt::format("{{drive: {{{}}}, to: {}, steps: 100", rates, computed(first)), {}});
    for (const Drive& drive : c.drives)
        if (drive.start != 0)
            c.draft.notes.warn(
                {0, drive.quantity},
                fmt::format("the file's motion starts {:.4g} from where the parts are drawn{}", drive.start,
                            drive.moves() ? "; the branch begins as drawn" : "; the branches hold it there"));
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
                "The file drives nothing: the branch begins at rest under gravity and goes on to a tenth "
                "more weight.");
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
                "The file drives nothing: the branch pushes its first part. Put your own in its place.");
        }
    }
    for (Entry& branch : c.draft.branches)
        branch.fields += holds.empty() ? "}" : fmt::format(", hold: {{{}}}}}", holds);
}

}  // namespace
}  // namespace elastocheck::importer::adm

namespace elastocheck::importer {

Draft import_adm(std::string_view text, const std::string& file, const Options& options) {
    using namespace adm;
    const Dataset data = read_statements(text, file);
    const Geometry geometry = read_geometry(data);
    Draft draft;
    // "Adams View model name: sla_front" is called sla_front.
    constexpr std::string_view before_name = "model name:";
    const auto name_at = data.title.find(before_name);
    draft.title = name_at == data.title.npos ? data.title : data.title.substr(name_at + before_name.size());
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
    c.end_time = last_event(c);
    read_gravity(c);
    sort_out(c);
    read_splines(c);
    convert_joints(c);
    convert_forces(c);
    write_bodies(c);
    if (options.wheel.empty())
        write_probes(c);
    else
        write_wheel(c);
    write_drives(c);
    return draft;
}

}  // namespace elastocheck::importer
