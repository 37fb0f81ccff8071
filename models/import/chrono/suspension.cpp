#include "models/import/chrono/suspension.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::chrono {
namespace {

using reader::Cursor;

// Linear interpolation between the rows; constant beyond the ends.
double value_at(const Rows& rows, double x) {
    const auto above = std::ranges::find_if(rows, [&](const auto& row) { return row.first > x; });
    if (above == rows.begin()) return rows.front().second;
    if (above == rows.end()) return rows.back().second;
    const auto& [x_0, f_0] = *(above - 1);
    return f_0 + (x - x_0) / (above->first - x_0) * (above->second - f_0);
}

}  // namespace

const Rows stop_table{{0, 0},       {0.002, 200},  {0.004, 400},   {0.006, 600},
                      {0.008, 800}, {0.01, 1000},  {0.02, 2500},   {0.03, 4500},
                      {0.04, 7500}, {0.05, 12500}, {0.06, 125000}, {0.07, 125000}};

Matrix3d frame_along(const Vector3d& w, const Vector3d& towards) {
    Matrix3d A;
    A.col(2) = w.normalized();
    Vector3d v = w.cross(towards);
    if (!(v.norm() > 1e-9 * w.norm() * towards.norm())) v = A.col(2).unitOrthogonal();
    A.col(1) = v.normalized();
    A.col(0) = A.col(1).cross(A.col(2));
    return A;
}

// ---- Reading

Vector3d vector(const Cursor& at) {
    const auto items = at.list(3, "numbers");
    return {items[0].number(), items[1].number(), items[2].number()};
}

Matrix3d rotation(const Cursor& at) {
    const auto q = at.list(4, "numbers, a quaternion");
    const Eigen::Quaterniond p(q[0].number(), q[1].number(), q[2].number(), q[3].number());
    if (!(p.norm() > 1e-6)) at.fail("not a quaternion: all components are zero");
    return p.normalized().toRotationMatrix();
}

double number_or_zero(const Cursor& object, const std::string& key) {
    const auto field = object.optional(key);
    return field ? field->number() : 0;
}

std::optional<Cursor> Suspension::find(const std::string& path, bool required) const {
    std::optional<Cursor> found = file_;
    for (std::string_view rest(path);;) {
        const std::size_t end = std::min(rest.find('/'), rest.size());
        const std::string key(rest.substr(0, end));
        if (!required && found->value->kind != reader::Value::Kind::map) return std::nullopt;
        found = required ? found->require(key) : found->optional(key);
        if (!found || end == rest.size()) return found;
        rest.remove_prefix(end + 1);
    }
}

double Suspension::positive(const std::string& path) const {
    const double x = real(path);
    if (!(x > 0)) at(path).fail("not above zero");
    return x;
}

std::string Suspension::on_side(const std::string& name) {
    constexpr std::string_view beside = " beside ";
    if (name == "steering link") {
        is_steered = true;
        return steering_link;
    }
    if (name == "bar body") return on_side(antiroll_body);
    if (const auto at = name.find(beside); at != name.npos)
        return name.substr(0, at) +
               (point(name.substr(at + beside.size())).y() > 0 ? "_left" : "_right");
    return replaced(name, "*", side > 0 ? "_left" : "_right");
}

FilePoint Suspension::point(const std::string& words) const {
    if (words.starts_with("mean of ")) {
        const auto places = split(words.substr(8), " and ");
        Vector3d sum = Vector3d::Zero();
        for (const std::string& each : places) sum += point(each);
        const std::string first = point(places[0]).from.what;
        return {sum / static_cast<double>(places.size()),
                first.empty() ? SourceLocation{} : place(first.substr(0, first.find('/'))),
                fmt::format("midpoint of {}", fmt::join(places, " and "))};
    }
    if (words.starts_with('(')) {
        Vector3d p = Vector3d::Zero();
        std::string last;
        const auto cells = split(words.substr(1, words.size() - 2), ";");
        for (std::size_t k = 0; k < 3; ++k)
            if (cells[k] != "0") p[static_cast<Eigen::Index>(k)] = real(last = cells[k]);
        return {mirrored(origin + turn * p), last.empty() ? SourceLocation{} : place(last)};
    }
    for (const auto& [ending, factor] : {std::pair{" at y = 0", 0.0}, {" mirrored", -1.0}})
        if (words.ends_with(ending)) {
            FilePoint p = point(words.substr(0, words.rfind(ending)));
            p.y() *= factor;
            if (factor == 0) p.calculated = p.from.what + ", at y = 0";
            return p;
        }
    return {mirrored(origin + turn * vector(at(words))), place(words)};
}

Vector3d Suspension::vector_of(const std::string& words) const {
    for (const int axis : {0, 1, 2})
        if (words.back() == "xyz"[axis] && words.size() <= 2)
            return (words.front() == '-' ? -1.0 : 1.0) * turn.col(axis);
    if (const auto product = split(words, " cross "); product.size() == 2) {
        const Vector3d v = vector_of(product[0]).cross(vector_of(product[1]));
        if (!(v.norm() > 1e-12))
            at(split(product[0], " - ")[1]).fail("on one line with the other points of its part");
        return v;
    }
    if (const auto ends = split(words, " - "); ends.size() == 2)
        return point(ends[0]) - point(ends[1]);
    const Vector3d v = turn * vector(at(words));
    if (!(v.norm() > 1e-9)) at(words).fail("not a direction: all components are zero");
    return mirrored(v);
}

namespace {

// Calls visit(scalar) for every scalar of a value.
void visit_scalars(const reader::Value& value,
                   const std::function<void(const reader::Value&)>& visit) {
    if (value.items.empty()) return visit(value);
    for (const auto& item : value.items) visit_scalars(item, visit);
}

// A field of an object that was not read, reported at the outermost level at which nothing was read.
struct Unread {
    const reader::Value *object, *value;
    std::string path, key;
};
void find_unread(const reader::Accesses& accesses, const reader::Value& object,
                 const std::string& path, std::vector<Unread>& unread) {
    for (std::size_t k = 0; k < object.items.size(); ++k) {
        const auto& item = object.items[k];
        const bool has_key = object.kind == reader::Value::Kind::map;
        const std::string key = has_key ? object.keys[k] : reader::place_in(object, k);
        const std::string its_path = path.empty() ? key : path + "/" + key;
        int scalars = 0, read = 0;
        visit_scalars(item, [&](const reader::Value& scalar) {
            ++scalars;
            read += accesses.read.contains(&scalar) ? 1 : 0;
        });
        if (read == scalars) continue;
        if (read > 0 || accesses.looked_for.contains(&item))
            find_unread(accesses, item, its_path, unread);
        else
            unread.push_back({&object, &item, its_path, key});
    }
}

void mark_read(const Cursor& field) {
    visit_scalars(*field.value,
                  [&](const reader::Value& scalar) { field.accesses->read.insert(&scalar); });
}

}  // namespace

void Suspension::leave_out(const Cursor& field, const std::string& why) {
    mark_read(field);
    if (side > 0) draft_.notes.leave_out(why, {field.value->line, field.path});
}

void Suspension::ignore(const std::optional<Cursor>& field, const std::string& why) {
    if (!field) return;
    mark_read(*field);
    if (side > 0) draft_.notes.warn({field->value->line, field->path}, "not used: " + why);
}

void Suspension::report_unread() {
    Notes& notes = draft_.notes;
    if (has("Axle/Inertia")) leave_out(at("Axle/Inertia"), "without effect at rest");
    const reader::Value& without_influence = templates_section("without_influence");
    std::vector<Unread> unread;
    find_unread(*file_.accesses, *file_.value, "", unread);
    // (reason, key) -> " of part, part"
    std::map<std::pair<std::string_view, std::string>, std::string> omitted;
    for (const auto& [object, value, path, key] : unread) {
        if (const reader::Value* why = entry(without_influence, key)) {
            std::string& parts = omitted[{why->text, key}];
            if (path.size() > key.size())
                parts +=
                    (parts.empty() ? " of " : ", ") + path.substr(0, path.size() - key.size() - 1);
            continue;
        }
        const auto& looked_for = file_.accesses->looked_for[object];
        std::vector<std::string> allowed;
        for (const std::string& name : looked_for)
            if (std::ranges::find(object->keys, name) == object->keys.end())
                allowed.push_back(name);
        allowed.insert(allowed.end(), without_influence.keys.begin(), without_influence.keys.end());
        notes.miss({value->line, path}, looked_for.contains(key)
                                            ? "not used in combination with the other fields"
                                            : "not a field of this template" +
                                                  reader::did_you_mean(key, allowed, "not given"));
    }
    for (const auto& [reason, parts] : omitted)
        notes.leave_out(std::string(reason.first), {0, reason.second + parts});
}

// ---- Writing

std::string Suspension::hardpoint(const std::string& name, const FilePoint& p) {
    const SourceLocation from = p.calculated.empty() ? p.from : SourceLocation{0, p.calculated};
    return draft_.points.at(p, on_side(name), from);
}

void Suspension::body(const std::string& name, const std::string& part, const Vector3d& com,
                      const std::string& mass) {
    const std::string body_name = on_side(name);
    Fields fields;
    fields.add("origin", draft_.points.at(com, body_name + ".cm", {}));
    if (const auto given = optional(part + "/" + mass)) {
        const double m = given->number();
        if (!options_.drop_dynamics && m > 0) fields.add("mass", m);
    }
    draft_.bodies.push_back({body_names_.take(body_name), fields.braced(), place(part)});
    draft_.notes.count("body");
}

namespace {

// The names of the directions of each joint of a scene.
const std::map<std::string_view, std::vector<const char*>> directions_of{
    {"revolute", {"axis"}}, {"cylindrical", {"axis"}}, {"translational", {"axis"}},
    {"in_line", {"axis"}},  {"parallel", {"axis"}},    {"universal", {"axis_i", "axis_j"}},
    {"planar", {"normal"}}, {"in_plane", {"normal"}},  {"spherical", {}},
    {"fixed", {}}};

}  // namespace

void Suspension::joint(const std::string& type, const Between& part, const FilePoint& place,
                       const std::vector<Vector3d>& along, bool held) {
    Fields fields;
    fields.add("type", type).add("bodies", pair(part.i, part.j));
    if (type != "parallel") fields.add("at", hardpoint(part.name, place));
    std::vector<Vector3d> units;
    for (const Vector3d& v : along) units.push_back(v.normalized());
    if (units.size() == 2) {  // the second is made exactly perpendicular
        const double cosine = units[0].dot(units[1]);
        if (std::abs(cosine) > 1e-9)
            draft_.notes.warn(
                place.from,
                fmt::format("the axes of the universal joint deviate from the right angle by "
                            "{:.2g} deg; the scene has a corrected second axis",
                            std::asin(std::min(std::abs(cosine), 1.0)) * 180 / std::numbers::pi));
        units[1] = (along[1] - units[0].dot(along[1]) * units[0]).normalized();
    }
    for (std::size_t k = 0; k < units.size(); ++k)
        fields.add(directions_of.at(type).at(k), direction(units[k]));
    if (held) fields.add("held", "true");
    draft_.joints.push_back({joint_names_.take(on_side(part.name)), fields.braced(), place.from});
    draft_.notes.count("joint");
}

void Suspension::distance(const std::string& name, const std::string& i, const FilePoint& from,
                          const std::string& j, const FilePoint& to) {
    Fields fields;
    fields.add("type", "distance").add("bodies", pair(i, j));
    fields.add("from", hardpoint(name + ".inner", from)).add("to", hardpoint(name + ".outer", to));
    draft_.joints.push_back({joint_names_.take(on_side(name)), fields.braced(), to.from});
    draft_.notes.count("joint");
}

// A bushing with its frame fixed in body 2: F = K_lin δ, T = K_rot θ, θ the rotation vector, both
// along its axes. F is isotropic, so it acts along the line of both points. T has an energy if
// K_rot is isotropic. Otherwise, as in place of a revolute, it is not conjugate, as in Chrono.
void Suspension::joint_or_bushing(const std::string& type, const Between& part,
                                  const FilePoint& place, const Matrix3d& frame,
                                  const std::optional<Cursor>& data) {
    const bool revolves = type == "revolute", is_universal = type == "universal";
    if (!data) {
        std::vector<Vector3d> along;
        if (revolves) along = {frame.col(2)};
        if (is_universal) along = {frame.col(0), frame.col(1)};
        return joint(type, part, place, along);
    }
    const double linear = data->require("Stiffness Linear").number(),
                 rotational = data->require("Stiffness Rotational").number();
    double free = 0;
    if (const auto dof = data->optional("DOF")) {
        free = number_or_zero(*dof, "Stiffness Rotational");
        if (const auto unused = dof->optional("Stiffness Linear"))
            leave_out(*unused, "since Chrono reads it but does not use it");
    }
    const auto rate = [&](int axis) {
        const bool is_fixed = revolves ? axis != 2 : is_universal && axis == 2;
        return is_fixed ? rotational : free;
    };
    Fields fields;
    fields.add("bodies", pair(part.j, part.i)).add("at", hardpoint(part.name, place));
    const bool is_round = rate(0) == rate(1) && rate(1) == rate(2);
    if (!is_round)
        fields.add("frame", fmt::format("{{z: {}, x: {}}}", direction(frame.col(2)),
                                        direction(frame.col(0))));
    fields.add("rates", fmt::format("[{0}, {0}, {0}]", number(linear)))
        .add("rotational_rates",
             fmt::format("[{}, {}, {}]", number(rate(0)), number(rate(1)), number(rate(2))));
    if (!is_round) fields.add("formulation", "{conjugate: false}");
    draft_.bushings.push_back(
        {element_names_.take(on_side(part.name)), fields.braced(), place.from});
    draft_.notes.count("bushing");
}

// Selects the law of a translational or rotational spring-damper from its fields, in Chrono's
// order: a map, else a spring table, else a damper table (then there is no spring, even with a
// spring coefficient), else coefficients.
Suspension::Law Suspension::law_of(const Cursor& data) {
    const auto k = data.optional("Spring Coefficient"), curve = data.optional("Spring Curve Data"),
               map = data.optional("Map Data"), damper_curve = data.optional("Damping Curve Data");
    const Law law = map                                    ? Law::map
                    : curve                                ? Law::curve
                    : damper_curve                         ? Law::damper
                    : k                                    ? Law::linear
                    : data.optional("Damping Coefficient") ? Law::damper
                                                           : Law::none;
    const auto unused = [&](const char* field, const char* why) {
        ignore(data.optional(field), why);
    };
    if (law == Law::map) unused("Spring Curve Data", "Chrono uses the Map Data instead");
    if (law != Law::map) unused("Deformation", "Chrono uses it with Map Data only");
    if (law != Law::linear)
        unused("Spring Coefficient",
               law == Law::map     ? "Chrono uses the Map Data instead"
               : law == Law::curve ? "Chrono uses the Spring Curve Data instead"
                                   : "Chrono uses the Damping Curve Data instead: there is no "
                                     "spring");
    if (law == Law::damper)
        for (const char* field :
             {"Free Length", "Free Angle", "Preload", "Minimum Length", "Maximum Length"})
            unused(field, "Chrono does not use it for a damper");
    return law;
}

namespace {

void require_rising(const Cursor& at, const Rows& rows) {
    if (rows.size() < 2) at.fail("a curve needs at least two rows");
    for (std::size_t n = 1; n < rows.size(); ++n)
        if (!(rows[n].first > rows[n - 1].first) || rows[n].second < rows[n - 1].second)
            at.fail(
                fmt::format("row {}: the deflection does not increase, or the force decreases, "
                            "which a scene does not allow",
                            n + 1));
}

Rows rows_of(const Cursor& curve, double offset, double preload) {
    Rows rows;
    for (const Cursor& row : curve.items()) {
        const auto cells = row.list(2, "numbers, deflection and force");
        rows.emplace_back(cells[0].number() + offset, cells[1].number() - preload);
    }
    require_rising(curve, rows);
    return rows;
}

// Rows of the map over speed (rows) and deformation (columns) at speed zero, by linear
// interpolation between the neighbouring speeds, or extrapolation from the first or last two.
Rows map_at_rest(const Cursor& data, double offset, double preload) {
    const Cursor map = data.require("Map Data");
    const auto columns = data.require("Deformation").items();
    std::vector<std::vector<double>> lines;  // a speed and its forces
    for (const Cursor& line : map.items()) {
        lines.emplace_back();
        for (const Cursor& cell :
             line.list(columns.size() + 1, "numbers, a speed and a force for each deformation"))
            lines.back().push_back(cell.number());
        if (lines.size() > 1 && !(lines.back()[0] > lines[lines.size() - 2][0]))
            line.fail("its speed does not increase from row to row");
    }
    if (lines.size() < 2) map.fail("a map needs at least two speeds");
    std::size_t v = 1;
    while (v + 1 < lines.size() && lines[v][0] < 0) ++v;
    const auto &below = lines[v - 1], &above = lines[v];
    const double t = -below[0] / (above[0] - below[0]);
    Rows rows;
    for (std::size_t n = 0; n < columns.size(); ++n)
        rows.emplace_back(columns[n].number() + offset,
                          (1 - t) * below[n + 1] + t * above[n + 1] - preload);
    require_rising(map, rows);
    return rows;
}

// A table as in Chrono, with straight lines between the rows.
std::string linear(const Rows& rows, bool known_outside) {
    return curve_of_rows(rows, known_outside, true);
}

}  // namespace

// Adds the stops at the lengths of the file to `fields`, of a spring or, `alone`, of stops without one.
void Suspension::add_stops(const Cursor& data, double drawn, bool alone, Fields& fields) {
    const auto least = data.optional("Minimum Length"), most = data.optional("Maximum Length");
    if (!least || !most) return;
    const double shortest = least->number(), longest = most->number();
    const SourceLocation here{data.value->line, data.path};
    if (side > 0 && shortest > longest)
        draft_.notes.warn(here, fmt::format("its minimum length {} is above its maximum length "
                                            "{}: both stops are always closed",
                                            least->value->text, most->value->text));
    else if (side > 0 && (shortest > drawn || longest < drawn))
        draft_.notes.warn(here,
                          fmt::format("a stop is closed at the design length {:.4g} m", drawn));
    const std::string ending = alone ? "" : "_stop";
    for (const auto& [name, clearance] :
         {std::pair{"bump", drawn - shortest}, {"rebound", longest - drawn}})
        fields.add(name + ending, Fields{}
                                      .add("clearance", computed(clearance))
                                      .add("curve", linear(stop_table, true))
                                      .braced());
}

void Suspension::tsda(const std::string& name, const std::string& i, const Vector3d& from,
                      const std::string& j, const Vector3d& to, const Cursor& data) {
    const SourceLocation source{data.value->line, data.path};
    const double drawn = (to - from).norm();
    Fields ends, law_fields;
    ends.add("bodies", pair(i, j))
        .add("from", hardpoint(name + ".top", {from, source}))
        .add("to", hardpoint(name + ".seat", {to, source}));
    const auto append = [&](std::vector<Entry>& list) {
        list.push_back({element_names_.take(on_side(name)), ends.braced(), source});
    };
    const auto append_damper = [&] {
        if (options_.drop_dynamics)
            draft_.notes.leave_out("by --drop dynamics", source);
        else
            append(draft_.dampers);
    };
    const Law law = law_of(data);
    if (law == Law::none)
        return draft_.notes.miss(
            source, "neither a spring nor a damper: Chrono has no element of these fields");
    if (law == Law::damper) return append_damper();
    const double preload = number_or_zero(data, "Preload");
    const auto least = data.optional("Minimum Length"), most = data.optional("Maximum Length");
    const bool has_stops = least && most;
    if (!has_stops)
        ignore(least ? least : most,
               "Chrono has stops only if both lengths are given, so here it has none");
    double force = 0;  // at the design position, pushing apart [N]
    bool has_no_force = false;
    if (law == Law::linear) {
        const Cursor k = data.require("Spring Coefficient");
        const double rate = k.number(), free = data.require("Free Length").number();
        if (rate < 0) k.fail("negative, which a scene does not allow");
        force = preload - rate * (drawn - free);
        has_no_force = rate == 0 && preload == 0;
        const double length = preload == 0 ? free : free + preload / rate;
        if (rate == 0)
            law_fields.add("curve",
                           linear({{-0.5 * drawn, -preload}, {0.5 * drawn, -preload}}, true));
        else if (preload == 0 || length > 0)
            law_fields.add("rate", rate).add("free_length", length);
        else
            law_fields.add("rate", rate).add("preload", force);
    } else {
        // Beyond the ends Chrono keeps a table constant and extrapolates a map linearly. The
        // deformation of a map is the length itself.
        Rows rows;
        if (law == Law::curve) {
            rows = rows_of(data.require("Spring Curve Data"), 0, preload);
            const double free = data.require("Free Length").number();
            force = -value_at(rows, drawn - free);
            law_fields.add("curve", linear(rows, false)).add("free_length", free);
        } else {
            ignore(data.optional("Free Length"),
                   "Chrono counts the deformation of a map from length zero");
            rows = map_at_rest(data, -drawn, preload);
            force = -value_at(rows, 0);
            law_fields.add("curve", linear(rows, true));
        }
        has_no_force = std::ranges::all_of(rows, [](const auto& row) { return row.second == 0; });
    }
    if (has_no_force && !has_stops) return append_damper();
    if (side > 0 && force < 0 && !has_no_force)
        draft_.notes.warn(source,
                          fmt::format("in tension at the design position: {:.4g} N", -force));
    if (!has_no_force) ends.add(law_fields);
    if (has_stops) add_stops(data, drawn, has_no_force, ends);
    append(has_no_force ? draft_.stops : draft_.springs);
    draft_.notes.count("spring");
}

// Rotational spring of body 2 relative to body 1 about the axis: at rest the torque on body 2 is
// P - k (angle - free), and the angle is 0 at the design position.
void Suspension::rsda(const std::string& name, const std::string& i, const std::string& j,
                      const Vector3d& p, const Vector3d& axis, const Cursor& data) {
    const SourceLocation source{data.value->line, data.path};
    const Law law = law_of(data);
    if (law == Law::none || law == Law::map)
        return draft_.notes.miss(
            source, "neither a spring nor a damper: Chrono has no element of these fields");
    if (law == Law::damper) return draft_.notes.leave_out("without effect at rest", source);
    const double preload = number_or_zero(data, "Preload"),
                 free = number_or_zero(data, "Free Angle");
    if (side < 0 && (preload != 0 || free != 0))
        draft_.notes.warn(
            source,
            "on the right the y component of its axis is reversed, so that its torque at rest is "
            "not the mirror image of the left one's; the scene is the same as Chrono");
    Fields law_fields;
    if (law == Law::linear) {
        const double rate = data.require("Spring Coefficient").number();
        law_fields.add("rate", rate);
        if (const double moment = -rate * free - preload; moment != 0)
            law_fields.add("preload_moment", computed(moment));
    } else {
        law_fields.add("curve",
                       linear(rows_of(data.require("Spring Curve Data"), free, preload), false));
    }
    torsion({name, i, j}, {p, source}, axis, law_fields);
}

void Suspension::torsion(const Between& part, const FilePoint& at, const Vector3d& axis,
                         const Fields& law) {
    Fields fields;
    fields.add("bodies", pair(part.i, part.j))
        .add("at", hardpoint(part.name, at))
        .add("axis", direction(axis))
        .add(law);
    draft_.torsion_springs.push_back(
        {element_names_.take(on_side(part.name)), fields.braced(), at.from});
    draft_.notes.count("torsion spring");
}

void Suspension::torsion(const Between& part, const FilePoint& at, const Vector3d& axis,
                         double rate, double moment) {
    Fields law;
    law.add("rate", rate);
    if (moment != 0) law.add("preload_moment", computed(moment));
    torsion(part, at, axis, law);
}

// Spin axis Rz(-side · toe) Rx(-side · camber) y in the axes of the chassis, side +1 left, -1 right. The
// spindle is fixed to its carrier, since nothing resists its spin at rest.
void Suspension::spindle(const std::string& carrier) {
    const std::string name = on_side("spindle*");
    const FilePoint centre = point("Spindle/COM");
    body(name, "Spindle", centre);
    const std::string point = hardpoint(name, centre);
    joint("fixed", {"wheel_bearing*", name, carrier}, centre);
    const double toe = number_or_zero(file_, "Toe Angle (deg)") * std::numbers::pi / 180,
                 camber = number_or_zero(file_, "Camber Angle (deg)") * std::numbers::pi / 180;
    const Vector3d axis =
        Eigen::AngleAxisd(-side * toe, Vector3d::UnitZ()) *
        (Eigen::AngleAxisd(-side * camber, Vector3d::UnitX()) * Vector3d(Vector3d::UnitY()));
    const char* const called = side > 0 ? "left" : "right";
    draft_.wheels.push_back({called,
                             Fields{}
                                 .add("body", name)
                                 .add("centre", point)
                                 .add("spin_axis", direction(axis * static_cast<double>(side)))
                                 .add("side", called)
                                 .braced(),
                             place("Spindle")});
}

}  // namespace elastocheck::importer::chrono
